// The library in a page or in Node: two WebAssembly modules, the regular build and one that records
// its tests.
import engineBytes from "../../../../build/playground/engine/engine.wasm";
import observingBytes from "../../../../build/playground/engine/observing.wasm";

import type { Recorded } from "../scene/frames.ts";
import { EngineModule } from "./module.ts";
import type { Algorithm, Engine, Frame, Observation, Outline, Scene, Search, Statistics, Tracker } from "./types.ts";

export type { Engine } from "./types.ts";

/** The bytes of the two modules' files. */
export interface EngineBytes {
  engine: BufferSource;
  observing: BufferSource;
}

/** Creates an engine, without a request: by default, the bytes are in the bundle. */
export async function loadEngine(bytes: EngineBytes = { engine: engineBytes, observing: observingBytes }):
    Promise<Engine> {
  const [plain, observing] = await Promise.all([EngineModule.load(bytes.engine), EngineModule.load(bytes.observing)]);
  return new LoadedEngine(plain, observing);
}

function statisticsOf([tests = 0, references = 0, cells = 0, hits = 0]: number[]): Statistics {
  return { tests, references, cells, hits };
}

/** The tests are empty unless the module observes them. */
function search(module: EngineModule, spec: string, boxes: Float32Array, dimension: 2 | 3): Observation {
  module.putText(spec);
  const count = module.putBoxes(boxes, dimension);
  const milliseconds = module.call((exports) => exports.find_pairs(count, dimension));
  const [pairs, morePairs, statistics] = [module.pairs(), module.morePairs(), statisticsOf(module.numbers())];
  module.call((exports) => exports.explain(dimension));
  return { pairs, tests: morePairs, statistics, explanation: module.text(), milliseconds };
}

class LoadedEngine implements Engine {
  readonly #plain: EngineModule;
  readonly #observing: EngineModule;

  constructor(plain: EngineModule, observing: EngineModule) {
    this.#plain = plain;
    this.#observing = observing;
  }

  algorithms(): Algorithm[] {
    this.#plain.call((exports) => exports.list_algorithms());
    return JSON.parse(this.#plain.text()) as Algorithm[];
  }

  find(spec: string, boxes: Float32Array, dimension: 2 | 3): Search {
    return search(this.#plain, spec, boxes, dimension);
  }

  time(spec: string, boxes: Float32Array, dimension: 2 | 3, runs: number): number {
    this.#plain.putText(spec);
    const count = this.#plain.putBoxes(boxes, dimension);
    return this.#plain.call((exports) => exports.find_pairs(count, dimension), runs);
  }

  observe(spec: string, boxes: Float32Array, dimension: 2 | 3): Observation {
    return search(this.#observing, spec, boxes, dimension);
  }

  outline(spec: string, boxes: Float32Array, dimension: 2 | 3, follows = false): Outline {
    this.#plain.putText(spec);
    const count = this.#plain.putBoxes(boxes, dimension);
    this.#plain.call((exports) => exports.lay_out(count, dimension, Number(follows)));
    const [kind = "", caption = ""] = this.#plain.text().split("\n");
    const [sweptAxis = -1, ...sizes] = this.#plain.numbers();
    const all = this.#plain.boxes();
    let begin = 0;
    const levels = sizes.map((size) => all.slice(begin, begin += 2 * dimension * size));
    return { kind, caption, sweptAxis, levels };
  }

  tracker(spec: string, dimension: 2 | 3): Tracker {
    const module = this.#plain;
    module.putText(spec);
    module.call((exports) => exports.start_tracker(dimension));
    const tracker = module.numbers()[0]!;
    return {
      update(boxes: Float32Array): Frame {
        const count = module.putBoxes(boxes, dimension);
        const milliseconds = module.call((exports) => exports.update_tracker(tracker, count));
        const [bytes = 0, ...statistics] = module.numbers().reverse();
        return {
          begun: module.pairs(),
          ended: module.morePairs(),
          statistics: statisticsOf(statistics.reverse()),
          milliseconds,
          bytes,
        };
      },
      free: () => module.freeTracker(tracker),
    };
  }

  advise(boxes: Float32Array, dimension: 2 | 3): string {
    return this.find("auto", boxes, dimension).explanation;
  }

  scenes(): Scene[] {
    this.#plain.call((exports) => exports.list_scenes());
    const scenes = JSON.parse(this.#plain.text()) as { name: string; summary: string; dimensions: number[] }[];
    return scenes.flatMap(({ name, summary, dimensions }) =>
      dimensions.map((dimension) => ({ name, summary, dimension })));
  }

  read(name: string, bytes: Uint8Array, columns = ""): Recorded & { warning: string } {
    const lines = new TextEncoder().encode(`${name.replaceAll("\n", " ")}\n${columns}\n`);
    const text = new Uint8Array(lines.length + bytes.length);
    text.set(lines);
    text.set(bytes, lines.length);
    this.#plain.putBytes(text);
    this.#plain.call((exports) => exports.read_file());
    const [dimension = 2, ...counts] = this.#plain.numbers() as [2 | 3, ...number[]];
    const all = this.#plain.boxes();
    let begin = 0;
    const frames = counts.map((count) => all.slice(begin, begin += 2 * dimension * count));
    return { dimension, frames, warning: this.#plain.text() };
  }

  scene(spec: string, count: number, seed: number, dimension: 2 | 3 = 2): Float32Array<ArrayBuffer> {
    this.#plain.putText(spec);
    this.#plain.call((exports) => exports.make_boxes(count, seed, dimension));
    return this.#plain.boxes();
  }
}

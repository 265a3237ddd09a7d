// The face of the smaller module: pairs, trackers and worlds.
import type {
  BoxArray, Boxes, CountJoinOptions, CountOptions, Dimension, JoinOptions, PairFinding, PairsOptions, Tracker,
  TrackerOptions, World, WorldOptions,
} from "../types/types.d.ts";
import { type Given, KeptBoxes } from "./boxes.ts";
import { Core } from "./core.ts";
import { Pairs } from "./pairs.ts";
import { KeptTracker } from "./tracker.ts";
import { KeptWorld } from "./world.ts";

export class PairFindingFace implements PairFinding {
  protected readonly core: Core;
  readonly #pairs: Pairs;
  readonly version: string;
  readonly simd: boolean;

  constructor(core: Core) {
    this.core = core;
    this.#pairs = new Pairs(core);
    core.exports.version();
    this.version = core.text(0);
    this.simd = core.simd;
  }

  pairs(boxes: BoxArray, options?: PairsOptions): Uint32Array {
    return this.#pairs.pairs(boxes as Given, options);
  }

  join(left: BoxArray, right: BoxArray, options?: JoinOptions): Uint32Array {
    return this.#pairs.join(left as Given, right as Given, options);
  }

  count(boxes: BoxArray, options?: CountOptions): number {
    return this.#pairs.count(boxes as Given, options);
  }

  countJoin(left: BoxArray, right: BoxArray, options?: CountJoinOptions): number {
    return this.#pairs.countJoin(left as Given, right as Given, options);
  }

  boxes(count: number, dimension: Dimension = 2): Boxes {
    return new KeptBoxes(this.core, count, dimension);
  }

  tracker(options?: TrackerOptions): Tracker {
    return new KeptTracker(this.core, options);
  }

  world(options?: WorldOptions): World {
    return new KeptWorld(this.core, options);
  }

  algorithms(): string[] {
    return [...this.core.algorithms];
  }
}

export async function pairFindingOf(wasm: WebAssembly.Module): Promise<PairFinding> {
  return new PairFindingFace(await Core.make(wasm));
}

// The engine's contract in a few lines: brute force under every name. For tests of the page alone.
import type { Algorithm, Engine, Observation, Outline, Search, Tunable } from "../engine/types.ts";

function naive(boxes: Float32Array, dimension: number): Observation {
  const stride = 2 * dimension;
  const count = boxes.length / stride;
  const begin = performance.now();
  const pairs: number[] = [];
  const tests: number[] = [];
  for (let a = 0; a < count; ++a) {
    if (boxes[stride * a]! > boxes[stride * a + dimension]!) continue;
    for (let b = a + 1; b < count; ++b) {
      if (boxes[stride * b]! > boxes[stride * b + dimension]!) continue;
      tests.push(a, b);
      let hit = true;
      for (let axis = 0; axis < dimension && hit; ++axis) {
        hit = boxes[stride * a + axis]! <= boxes[stride * b + dimension + axis]! &&
          boxes[stride * b + axis]! <= boxes[stride * a + dimension + axis]!;
      }
      if (hit) pairs.push(a, b);
    }
  }
  return {
    pairs: Uint32Array.from(pairs), tests: Uint32Array.from(tests), explanation: "",
    statistics: { tests: tests.length / 2, references: count, cells: 0, hits: pairs.length / 2 },
    milliseconds: performance.now() - begin,
  };
}

// The tunables that lessons have sliders for.
const cell: Tunable = { name: "cell", summary: "size of a cell", default: "auto", type: "number", min: 0 };
const axis: Tunable = { name: "axis", summary: "along which", default: "auto", type: "choice", choices: ["auto", "x", "y"] };
const tunables: Readonly<Record<string, Tunable>> = { grid: cell, paper_grid: cell, sweep_and_prune: axis };

const names = ["auto", "brute_force", "grid", "sweep_and_prune", "quadtree", "bvh", "paper_grid"];
const algorithms = names.map((name): Algorithm => ({
  name, summary: `A stand-in for ${name}`, source: "", kind: "own", dimensions: [2, 3], tracks: true,
  tunables: tunables[name] === undefined ? [] : [tunables[name]],
}));

/** Frames of a table with the columns frame, box and bounds, in order; or of a GeoJSON point. */
function framesOf(name: string, text: string): Float32Array<ArrayBuffer>[] {
  if (text.startsWith("{")) {
    const [x, y] = (JSON.parse(text) as { coordinates: [number, number] }).coordinates;
    return [Float32Array.from([x, y, x, y])];
  }
  if (!text.startsWith("frame,box,")) throw new Error(`${name}:1: no such columns`);
  const frames: number[][] = [];
  for (const line of text.trim().split("\n").slice(1)) {
    const [frame = 0, box = 0, ...bounds] = line.split(",").map(Number);
    frames[frame] ??= [...frames[frame - 1] ?? []];
    frames[frame].splice(4 * box, 4, ...bounds);
  }
  return frames.map((frame) => Float32Array.from(frame));
}

export async function loadEngine(): Promise<Engine> {
  return {
    algorithms: () => algorithms,
    find: (_, boxes, dimension): Search => naive(boxes, dimension),
    time(_, boxes, dimension, runs) {
      const begin = performance.now();
      for (let run = 0; run < runs; ++run) naive(boxes, dimension);
      return performance.now() - begin;
    },
    observe: (_, boxes, dimension) => naive(boxes, dimension),
    outline: (): Outline => ({ kind: "", caption: "", sweptAxis: -1, levels: [] }),
    tracker: (_, dimension) => {
      let last = new Set<string>();
      return {
        update(boxes) {
          const { pairs, statistics, milliseconds } = naive(boxes, dimension);
          const now = new Set<string>();
          for (let at = 0; at < pairs.length; at += 2) now.add(`${pairs[at]} ${pairs[at + 1]}`);
          const packed = (keys: Iterable<string>): Uint32Array =>
            Uint32Array.from([...keys].flatMap((key) => key.split(" ").map(Number)));
          const frame = {
            begun: packed([...now].filter((key) => !last.has(key))),
            ended: packed([...last].filter((key) => !now.has(key))),
            statistics, milliseconds, bytes: 1,
          };
          last = now;
          return frame;
        },
        free() {},
      };
    },
    advise: () => "",
    scenes: () => [],
    scene: () => new Float32Array(),
    read: (name, bytes) => ({ dimension: 2, frames: framesOf(name, new TextDecoder().decode(bytes)), warning: "" }),
  };
}

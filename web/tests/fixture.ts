// A small comparison, as the program writes it.
import type { Comparison, Measurement } from "../charts/data.ts";

const blank: Measurement = {
  scene: "uniform", scene_parameters: {}, seeds: [1], dimension: 2, boxes: 1000, frames: 0, moving: 0, drift: null, teleport: null,
  algorithm: "grid", version: "0.1.0", kind: "own", mode: "find", threads: 1, target: "AVX2", pairs: 2000,
  pair_hash: "00000000000000ff", verified: true, verified_by: "the definition", skipped: null, median_ms: null, min_ms: null,
  p99_ms: null, max_ms: null, samples_ms: null, build_ms: null, ns_per_box: null, ns_per_mover: null, floor_ms: 0.01,
  tests: 5000, references: 1200, explanation: null, own_bytes: 4096, peak_bytes: 8192,
};

function timed(milliseconds: number, changes: Partial<Measurement>): Measurement {
  const samples = [milliseconds, milliseconds * 0.9, milliseconds * 1.1, milliseconds * 2];
  return {
    ...blank, median_ms: milliseconds, min_ms: milliseconds * 0.9, p99_ms: milliseconds * 2, max_ms: milliseconds * 2,
    samples_ms: samples, ns_per_box: milliseconds * 1e6 / (changes.boxes ?? blank.boxes), ...changes,
  };
}

const box2d = { algorithm: "box2d_tree", kind: "peer", version: "Box2D 2.4.1", target: null, tests: null } as const;
const large = { boxes: 10000 };
const moving = { scene: "churn", frames: 4, moving: 0.25, mode: "track" } as const;

export const comparison: Comparison = {
  schema: "broadside.results/1",
  machine: { cpu: "A processor", cores: 2, memory_bytes: 8 * 2 ** 30, os: "Debian" },
  build: { version: "0.1.0", revision: "abc1234", compiler: "GNU 12.2.0", type: "Release", flags: "-O3" },
  command: ["broadside", "compare"],
  stopped: false,
  measurements: [
    timed(0.2, {}), timed(0.1, { algorithm: "bvh" }), timed(0.4, box2d), timed(5, { algorithm: "brute_force" }),
    timed(1, large), timed(1.5, { ...large, algorithm: "bvh" }), timed(20, { ...large, ...box2d }),
    { ...blank, ...large, algorithm: "brute_force", verified: null, skipped: "would take some 3 s" },
    timed(0.05, moving), timed(0.06, { ...moving, algorithm: "bvh" }), timed(0.09, { ...moving, ...box2d }),
  ],
};

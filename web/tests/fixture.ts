// A small comparison, as the program writes it today and as it wrote it by the schema before.
import type { Comparison, Measurement, Ratio } from "../charts/data.ts";
import { inTodaysShape } from "../charts/old_results.ts";
import type { OldComparison } from "../charts/old_results.ts";

type OldMeasurement = OldComparison["measurements"][number];

const blank: OldMeasurement = {
  scene: "uniform", scene_parameters: {}, seeds: [1], dimension: 2, boxes: 1000, frames: 0, moving: 0, drift: null, teleport: null,
  algorithm: "grid", version: "0.1.0", kind: "own", mode: "find", threads: 1, target: "AVX2", pairs: 2000,
  pair_hash: "00000000000000ff", verified: true, verified_by: "the definition", skipped: null, median_ms: null, min_ms: null,
  p99_ms: null, max_ms: null, samples_ms: null, build_ms: null, ns_per_box: null, ns_per_mover: null, floor_ms: 0.01,
  unsteady: null, tests: 5000, references: 1200, explanation: null, own_bytes: 4096, peak_bytes: 8192,
};

function timed(milliseconds: number, changes: Partial<OldMeasurement>): OldMeasurement {
  const samples = [milliseconds, milliseconds * 0.9, milliseconds * 1.1, milliseconds * 2];
  return {
    ...blank, median_ms: milliseconds, min_ms: milliseconds * 0.9, p99_ms: milliseconds * 2, max_ms: milliseconds * 2,
    samples_ms: samples, unsteady: false, ns_per_box: milliseconds * 1e6 / (changes.boxes ?? blank.boxes), ...changes,
  };
}

const box2d = { algorithm: "box2d_tree", kind: "peer", version: "Box2D 2.4.1", target: null, tests: null } as const;
const large = { boxes: 10000 };
const moving = { scene: "churn", frames: 4, moving: 0.25, mode: "track" } as const;

export const oldComparison: OldComparison = {
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

/** With an interval of some per cent about it; of a factor to 1.25 it holds 1. */
function withInterval(ratio: Ratio | null): Ratio | null {
  if (ratio === null) return null;
  if (ratio.median === 1) return { ...ratio, low: 1, high: 1, rounds: 4 };
  const width = ratio.median > 0.8 && ratio.median <= 1.25 ? 1.3 : 1.06;
  return { ...ratio, low: ratio.median / width, high: ratio.median * width, rounds: 4 };
}

/** The same as measured in rounds. */
export function inRounds(old: OldComparison): Comparison {
  const measurements = inTodaysShape(old).measurements.map((measurement): Measurement => ({
    ...measurement,
    rounds: measurement.median_ms === null ? 0 : 4,
    ratio_to_fastest: withInterval(measurement.ratio_to_fastest),
    ratio_to_best_own: withInterval(measurement.ratio_to_best_own),
    ratio_to_fastest_peer: withInterval(measurement.ratio_to_fastest_peer),
  }));
  return { ...old, schema: "broadside.results/2", date: "2026-11-21", processor_share: 0.998, busy: false, measurements };
}

export const comparison = inRounds(oldComparison);

/** The same on a busy machine, with one measurement that is unsteady. */
export const doubtful: Comparison = {
  ...comparison, processor_share: 0.58, busy: true,
  measurements: comparison.measurements.map((measurement, i) => (i === 2 ? { ...measurement, unsteady: true } : measurement)),
};

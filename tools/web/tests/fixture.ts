// A small comparison, in the program's output format.
import { bestOwn, casesOf, ranking } from "../charts/comparison.ts";
import type { Comparison, Measurement, Ratio } from "../charts/data.ts";

const blank: Measurement = {
  scene: "uniform", scene_parameters: {}, seeds: [1], dimension: 2, boxes: 1000, frames: 0, moving: 0, drift: null, teleport: null,
  algorithm: "grid", version: "0.1.0", kind: "own", mode: "find", threads: 1, target: "AVX2", pairs: 2000,
  pair_hash: "00000000000000ff", verified: true, verified_by: "by definition", skipped: null, median_ms: null, min_ms: null,
  p99_ms: null, max_ms: null, samples_ms: null, build_ms: null, ns_per_box: null, ns_per_mover: null, floor_ms: 0.01,
  unsteady: null, tests: 5000, references: 1200, explanation: null, own_bytes: 4096, peak_bytes: 8192,
  rounds: 0, ratio_to_fastest: null, ratio_to_best_own: null, ratio_to_fastest_peer: null,
};

function timed(milliseconds: number, changes: Partial<Measurement>): Measurement {
  const samples = [milliseconds, milliseconds * 0.9, milliseconds * 1.1, milliseconds * 2];
  return {
    ...blank, median_ms: milliseconds, min_ms: milliseconds * 0.9, p99_ms: milliseconds * 2, max_ms: milliseconds * 2,
    samples_ms: samples, unsteady: false, ns_per_box: milliseconds * 1e6 / (changes.boxes ?? blank.boxes), ...changes,
  };
}

const box2d = { algorithm: "box2d_tree", kind: "peer", version: "Box2D 2.4.1", target: null, tests: null } as const;
const large = { boxes: 10000 };
const moving = { scene: "churn", frames: 4, moving: 0.25, mode: "track" } as const;

const measured: Comparison = {
  schema: "broadside.results/2", date: "2026-11-21", processor_share: 0.998, busy: false,
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

/**
 * The ratio to another's median, with an interval of a few per cent around it; for factors up to
 * 1.25 it contains 1.
 */
function ratioTo(other: Measurement | undefined, { median_ms }: Measurement): Ratio | null {
  if (other === undefined || other.median_ms === null || median_ms === null) return null;
  const median = median_ms / other.median_ms;
  const width = median === 1 ? 1 : median > 0.8 && median <= 1.25 ? 1.3 : 1.06;
  return { of: other.algorithm, median, low: median / width, high: median * width, rounds: 4 };
}

/** The same comparison with rounds, and ratios in each case. */
export function inRounds(comparison: Comparison): Comparison {
  const measurements = comparison.measurements.map((measurement): Measurement =>
    ({ ...measurement, rounds: measurement.median_ms === null ? 0 : 4 }));
  for (const of of casesOf(measurements)) {
    const [fastest] = ranking(of);
    const own = bestOwn(of);
    const peer = ranking(of).find(({ kind }) => kind === "peer");
    for (const measurement of of.measurements) {
      measurement.ratio_to_fastest = ratioTo(fastest, measurement);
      measurement.ratio_to_best_own = ratioTo(own, measurement);
      measurement.ratio_to_fastest_peer = ratioTo(peer, measurement);
    }
  }
  return { ...comparison, measurements };
}

export const comparison = inRounds(measured);

/** The same on a busy machine, with one unsteady measurement. */
export const doubtful: Comparison = {
  ...comparison, processor_share: 0.58, busy: true,
  measurements: comparison.measurements.map((measurement, i) => (i === 2 ? { ...measurement, unsteady: true } : measurement)),
};

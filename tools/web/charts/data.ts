// The program's output for a comparison ("broadside.results/2"). docs/schemas/ describes every
// field.

export interface Machine {
  cpu: string | null;
  cores: number | null;
  memory_bytes: number | null;
  os: string | null;
}

export interface Build {
  version: string;
  revision: string | null;
  compiler: string;
  type: string | null;
  flags: string | null;
}

/** One entry's time over another's. */
export interface Ratio {
  /** Spec of the other entry. */
  of: string;
  median: number;
  /** The 95 % interval; null if unknown. */
  low: number | null;
  high: number | null;
  /** Rounds in which both took part. */
  rounds: number;
}

/** One algorithm in one case. Skipped algorithms have no times. */
export interface Measurement {
  scene: string;
  scene_parameters: Record<string, string>;
  seeds: number[];
  dimension: number;
  boxes: number;
  frames: number;
  moving: number;
  /** In a join of two sets: the fraction of the boxes that is the left set. */
  left?: number;
  /** Whether boxes have filters. */
  filtered?: boolean;
  drift: number | null;
  teleport: number | null;
  algorithm: string;
  version: string;
  /**
   * Broadside's own, from the draft's listings, from the literature, another library's, or added by
   * a user.
   */
  kind: "own" | "paper" | "literature" | "peer" | "user";
  mode: "find" | "track";
  threads: number;
  target: string | null;
  pairs: number | null;
  pair_hash: string | null;
  verified: boolean | null;
  /** "by definition" or "cross-checked by 9 structures of 6 libraries". */
  verified_by: string | null;
  skipped: string | null;
  /** Number of rounds in which it was timed. */
  rounds: number;
  median_ms: number | null;
  min_ms: number | null;
  p99_ms: number | null;
  max_ms: number | null;
  samples_ms: number[] | null;
  /** Each is null if there is nothing to compare with. */
  ratio_to_fastest: Ratio | null;
  ratio_to_best_own: Ratio | null;
  ratio_to_fastest_peer: Ratio | null;
  /** Whether its samples vary too much to be trusted. */
  unsteady: boolean | null;
  build_ms: number | null;
  ns_per_box: number | null;
  ns_per_mover: number | null;
  floor_ms: number | null;
  tests: number | null;
  references: number | null;
  explanation: string | null;
  own_bytes: number | null;
  peak_bytes: number | null;
}

export type RatioName = "ratio_to_fastest" | "ratio_to_best_own" | "ratio_to_fastest_peer";

export interface Comparison {
  schema: "broadside.results/2";
  /** For example "2026-11-21". */
  date: string;
  machine: Machine;
  build: Build;
  command: string[];
  stopped: boolean;
  /** Processor time over wall-clock time of the run, about 1 for one thread. */
  processor_share: number;
  busy: boolean;
  measurements: Measurement[];
}

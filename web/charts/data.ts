// What the program writes: experiments ("broadside.experiments/2") and comparisons ("broadside.results/2").
// docs/schemas/ describes every field.

export type Cell = number | string | null;

export interface Column {
  name: string;
  unit: string;
}

/** How a chart shows a table, in names of its columns. */
export interface ChartSpec {
  title: string;
  kind: "lines" | "bars" | "map";
  x: string;
  y: string;
  series: string;
  value: string;
  log_x: boolean;
  log_y: boolean;
  where: [string, string][];
}

export interface Table {
  name: string;
  title: string;
  columns: Column[];
  charts: ChartSpec[];
  rows: Cell[][];
}

export type Verdict = "confirmed" | "holds within bounds" | "refuted" | "not testable";

/** One statement of a claim, and what became of it. */
export interface Statement {
  /** The claim's, with a letter behind it where the claim has several. */
  label: string;
  name: string;
  text: string;
  verdict: Verdict;
  /** Where it holds within bounds, or why it is not testable; else empty. */
  condition: string;
  /** What was asked of the figures; empty if it is not testable. Not in results of before it was noted. */
  threshold?: string;
  /** Names of figures. */
  evidence: string[];
}

/** What an experiment came to; without an interval if it was counted. */
export interface Figure {
  value: number;
  unit: string;
  low: number | null;
  high: number | null;
}

export interface Experiment {
  /** Of a claim of the draft its number; of our own with a B before it. */
  label: string;
  name: string;
  title: string;
  claim: string;
  section: string;
  measured: string;
  seconds: number;
  statements: Statement[];
  reason: string;
  figures: Record<string, Figure>;
  /** Not in results of before it was noted. */
  steadiness?: { measurements: number; unsteady: number };
  tables: Table[];
}

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

export interface Experiments {
  schema: "broadside.experiments/2";
  machine: Machine;
  build: Build;
  target: string;
  date: string;
  command: string[];
  quick: boolean;
  stopped: boolean;
  /** Processor time over wall time of the run; not in results of before it was noted. */
  processor_share?: number;
  busy?: boolean;
  experiments: Experiment[];
}

/** One entry's time over another's. */
export interface Ratio {
  /** The spec of the other. */
  of: string;
  median: number;
  /** The 95 % interval; null where it is not known. */
  low: number | null;
  high: number | null;
  /** Rounds in which both took part. */
  rounds: number;
}

/** One algorithm in one case. What was skipped has no times. */
export interface Measurement {
  scene: string;
  scene_parameters: Record<string, string>;
  seeds: number[];
  dimension: number;
  boxes: number;
  frames: number;
  moving: number;
  drift: number | null;
  teleport: number | null;
  algorithm: string;
  version: string;
  /** Broadside's own, the draft's listings, those of the literature, other libraries', or one that a user added. */
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
  /** In how many rounds it was timed. */
  rounds: number;
  median_ms: number | null;
  min_ms: number | null;
  p99_ms: number | null;
  max_ms: number | null;
  samples_ms: number[] | null;
  /** Each null where there is nothing to compare with. */
  ratio_to_fastest: Ratio | null;
  ratio_to_best_own: Ratio | null;
  ratio_to_fastest_peer: Ratio | null;
  /** Whether its samples lie too far apart to be trusted. */
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
  /** "2026-11-21". */
  date: string;
  machine: Machine;
  build: Build;
  command: string[];
  stopped: boolean;
  /** Processor time over wall time of the run, about 1 for one thread. */
  processor_share: number;
  busy: boolean;
  measurements: Measurement[];
}

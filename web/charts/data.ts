// What the program writes: experiments ("broadside.experiments/1") and comparisons ("broadside.results/2").
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

export interface Experiment {
  number: number;
  name: string;
  title: string;
  claim: string;
  section: string;
  measured: string;
  seconds: number;
  verdict: "holds" | "holds when" | "does not hold";
  condition: string;
  reason: string;
  figures: Record<string, { value: number; unit: string }>;
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
  schema: "broadside.experiments/1";
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
  /** Rounds in which both took part; null where it is not known. */
  rounds: number | null;
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
  kind: "own" | "paper" | "literature" | "peer" | "user";
  mode: "find" | "track";
  threads: number;
  target: string | null;
  pairs: number | null;
  pair_hash: string | null;
  verified: boolean | null;
  verified_by: string | null;
  skipped: string | null;
  /** In how many rounds it was timed; null where it is not known. */
  rounds: number | null;
  median_ms: number | null;
  min_ms: number | null;
  p99_ms: number | null;
  max_ms: number | null;
  samples_ms: number[] | null;
  /** Each null where there is nothing to compare with. */
  ratio_to_fastest: Ratio | null;
  ratio_to_best_own: Ratio | null;
  ratio_to_fastest_peer: Ratio | null;
  /** Whether its samples lie too far apart to be trusted; not in results of before it was noted. */
  unsteady?: boolean | null;
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
  /** "2026-11-21"; null where it is not known. */
  date: string | null;
  machine: Machine;
  build: Build;
  command: string[];
  stopped: boolean;
  /** Processor time over wall time of the run, about 1 for one thread; null where it is not known. */
  processor_share: number | null;
  busy: boolean | null;
  measurements: Measurement[];
}

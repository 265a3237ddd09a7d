// Messages between the page and its bench. The bench has the engine and runs in a worker if
// possible.
import type { Algorithm, Outline, Statistics } from "../engine/types.ts";
import type { SceneChoice } from "../scene/catalogue.ts";
import type { Edit } from "../scene/edits.ts";
import type { Bounds, Dimension } from "../scene/scene.ts";

export interface PanelChoice {
  spec: string;
  /** Whether a tracker follows the boxes; otherwise each frame is searched from scratch. */
  follow: boolean;
}

/** Everything that determines the picture, except for the time. */
export interface Setup {
  scene: SceneChoice;
  edits: readonly Edit[];
  panels: readonly PanelChoice[];
  structure: boolean;
  overlaps: boolean;
  /** The box to report tests of; -1: none. */
  selected: number;
}

/** The first message to the bench: the engine's modules, compressed by gzip, as base64. */
export interface Start {
  kind: "start";
  engine: string;
  observing: string;
}

export type Request =
  | { kind: "setup"; setup: Setup }
  /** `columns` says what a table's columns are, as the program's --columns does; empty: they say so themselves. */
  | { kind: "file"; name: string; bytes: Uint8Array<ArrayBuffer>; columns: string }
  | { kind: "frame"; time: number; held: Edit | null }
  | { kind: "measure"; counts: number[]; specs: string[] }
  | { kind: "duel" };

/** State of a box, as a number that the painter maps to a colour. */
export const Mark = { none: 0, lit: 1, tested: 2, testedLit: 3, selected: 4, faded: 5 } as const;

/** Some boxes that were not compared with the selected one, and the reason. */
export interface Untested {
  why: string;
  count: number;
}

/** Results for the selected box. */
export interface Selection {
  box: number;
  tested: Uint32Array;
  /** How many of the tested boxes overlap it. */
  hits: number;
  untested: Untested[];
  /** Tests of the whole observation: equal to the statistics' tests. */
  tests: number;
}

export interface PanelResult {
  spec: string;
  pairs: number;
  statistics: Statistics;
  explanation: string;
  milliseconds: number;
  /** The tracker's memory; 0 without a tracker. */
  bytes: number;
  begun: number;
  ended: number;
  outline?: Outline;
  selection?: Selection;
  /** Why no tests of the selected box are shown. */
  unobserved?: string;
  /** A mark for each box, if the panel has its own marks. */
  marks?: Uint8Array<ArrayBuffer>;
  /** Why it did not search. */
  error?: string;
  /** Its search takes long: these are results of an earlier frame. */
  late: boolean;
}

export interface Shown {
  scene: SceneChoice;
  time: number;
  dimension: Dimension;
  bounds: Bounds;
  duration: number;
  boxes: Float32Array<ArrayBuffer>;
  present: number;
  marks: Uint8Array<ArrayBuffer>;
  /** [a0, b0, ...] of this frame. */
  pairs: Uint32Array;
  /** Intersections of the pairs, as boxes. */
  overlaps: Float32Array<ArrayBuffer>;
  panels: PanelResult[];
}

export interface Measured {
  spec: string;
  count: number;
  milliseconds: number;
  /** Of the frames on screen; otherwise measured in batches, which is more precise. */
  ofFrames?: boolean;
}

export interface Duel {
  auto: number;
  /** The algorithm that it took, and why. */
  chosen: string;
  explanation: string;
  /** Whether rounds differ so much that small ratios say nothing: the machine is busy. */
  unsteady: boolean;
  /** The library's other algorithms, fastest first. */
  others: { spec: string; milliseconds: number }[];
}

/** A file that was read. */
export interface Opened {
  name: string;
  boxes: number;
  frames: number;
  /** How the file was interpreted, if that is uncertain. */
  warning: string;
}

export type Reply =
  | { kind: "ready"; algorithms: Algorithm[] }
  | { kind: "opened"; opened: Opened }
  | { kind: "shown"; shown: Shown }
  | { kind: "measured"; measured: Measured | null }
  | { kind: "duel"; duel: Duel }
  | { kind: "failed"; message: string; of: Request["kind"] | "start" };

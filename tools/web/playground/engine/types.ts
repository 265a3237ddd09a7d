// What the playground asks of the library, and the steps of the draft's algorithms.
//
// Boxes are packed: the minima of one box and then its maxima, so 4 numbers a box in 2D and 6 in 3D. An id is a box's
// place in the array, from 0.

import type { Recorded } from "../scene/frames.ts";

/** What a search counted. */
export interface Statistics {
  tests: number;       // pairs of boxes compared
  references: number;  // entries of boxes in cells, nodes or lists
  cells: number;       // cells or nodes that there are; 0 where an algorithm does not count them
  hits: number;        // of the tests, those of boxes that overlap; 0 unless they were observed
}

/** What an algorithm lays over the boxes. */
export interface Outline {
  kind: string;  // "cells", "stripes", "nodes" or "sweep"; empty where there is nothing to draw
  caption: string;
  sweptAxis: number;       // the axis along which boxes are sorted; -1: none
  levels: Float32Array[];  // boxes, from the coarsest level down
}

export interface Tunable {
  name: string;
  summary: string;
  default: string;  // "auto" where the algorithm chooses by itself
  type: "number" | "integer" | "choice";
  min?: number;  // of a number or an integer
  max?: number;
  choices?: string[];
}

export interface Algorithm {
  name: string;
  summary: string;
  source: string;
  kind: string;          // "own" or "paper"
  dimensions: number[];  // 2, 3 or both
  tracks: boolean;       // whether it has a tracker of its own
  tunables: Tunable[];
}

export interface Search {
  pairs: Uint32Array;  // [a0, b0, a1, b1, ...]
  statistics: Statistics;
  explanation: string;  // of auto: which algorithm it took, and why; of others empty
  milliseconds: number;
}

export interface Observation extends Search {
  /** [a0, b0, ...]: each pair of boxes that was compared, in order. tests.length / 2 === statistics.tests. */
  tests: Uint32Array;
}

/** What one update of a tracker told. */
export interface Frame {
  begun: Uint32Array;  // [a0, b0, ...]
  ended: Uint32Array;
  statistics: Statistics;
  milliseconds: number;
  bytes: number;  // the memory that the tracker holds
}

export interface Tracker {
  /** Box i of this frame is box i of the last one. A box whose minimum is above its maximum is absent. */
  update(boxes: Float32Array): Frame;
  /** Gives its memory back. Nothing may be called afterwards. */
  free(): void;
}

export interface Scene {
  name: string;
  summary: string;
  dimension: number;
}

/** The library in the page. What it refuses is thrown as an Error with the library's message. */
export interface Engine {
  algorithms(): Algorithm[];
  /** The library as it is. */
  find(spec: string, boxes: Float32Array, dimension: 2 | 3): Search;
  /** The observing build of the same templates; slower, so its milliseconds say nothing of the library. */
  observe(spec: string, boxes: Float32Array, dimension: 2 | 3): Observation;
  outline(spec: string, boxes: Float32Array, dimension: 2 | 3): Outline;
  tracker(spec: string, dimension: 2 | 3): Tracker;
  /** What `auto` takes for these boxes, and why. */
  advise(boxes: Float32Array, dimension: 2 | 3): string;
  /** The lab's generators; one with two dimensions is there twice. */
  scenes(): Scene[];
  scene(spec: string, count: number, seed: number, dimension?: 2 | 3): Float32Array<ArrayBuffer>;
  /** The boxes of a file, by the program's own readers (docs/formats.md); the warning says how it was read. */
  read(name: string, bytes: Uint8Array): Recorded & { warning: string };
}

/**
 * Where a search of the draft's algorithms stands. Arrays are shared between steps: do not change them. `cells` and
 * `nodes` are made when they are asked for, so ask once for what is drawn.
 */
export type StepState = BruteForceState | GridState | SweepState | QuadtreeState;

/** Algorithm 1: the two places of the loops; -1 before one has begun. */
export interface BruteForceState {
  kind: "brute_force";
  i: number;
  j: number;
}

export interface World {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** Algorithms 2 to 4. */
export interface GridState {
  kind: "grid";
  world: World;
  size: number;  // the side of a cell
  columns: number;
  rows: number;
  cells: readonly (readonly number[])[];  // ids by column * rows + row; empty before Algorithm 2 has ended
  current: number;                        // the cell that is filled or searched; -1: none
  /** While a box is inserted: the first and last column and row that it is in. */
  span?: readonly [firstColumn: number, lastColumn: number, firstRow: number, lastRow: number];
  /** Of two boxes that overlap: the greater minimum on each axis. The cell that holds it reports the pair. */
  point?: readonly [x: number, y: number];
}

/** Algorithms 5 and 6, along the x axis. */
export interface SweepState {
  kind: "sweep_and_prune";
  order: readonly number[];   // ids by their least x, once they are sorted
  next: number;               // the place in the order of the box that the sweep is at; -1 before
  position: number;           // where the sweep line stands: the least x of that box; NaN before
  active: readonly number[];  // F: the boxes that the line may still meet
}

export interface QuadtreeNode {
  depth: number;
  parent: number;  // a place in `nodes`; -1: none
  /** The world's part of the node; nodes at the border go on without end. */
  box: readonly [left: number, top: number, right: number, bottom: number];
  origin: readonly [x: number, y: number];
  children?: readonly [qi: number, qii: number, qiii: number, qiv: number];  // places in `nodes`; a leaf has none
  boxes: readonly number[];  // ids, in a leaf and in a node that is being split
  count: number;
}

/** Algorithms 7 to 10. */
export interface QuadtreeState {
  kind: "quadtree";
  world: World;
  capacity: number;
  nodes: readonly QuadtreeNode[];  // a node's children come after it
  current: number;                 // the node that is filled, split or searched; -1: none
  point?: readonly [x: number, y: number];  // as for the grid: the leaf that holds it reports the pair
}

export interface Step {
  line: number;  // the current line: an index into the listing
  text: string;  // what happens here, with the boxes named by id
  boxes: number[];  // the boxes it is about
  pair?: [number, number];  // that is tested
  /** test: it is about to be compared; hit and miss: what came out; reported: a hit that is written. */
  outcome?: "test" | "hit" | "miss" | "reported";
  state: StepState;
}

export type StepAlgorithm = StepState["kind"];

/** The tunables of the mended listings; what is left out is chosen as paper_grid and paper_quadtree choose it. */
export interface StepOptions {
  cell?: number;      // grid: the side of a cell
  capacity?: number;  // quadtree: boxes that a leaf holds before it splits; 8 if left out
}

export interface Steps {
  listing: string[];
  steps: Step[];                 // an array, so one can step back
  pairs: [number, number][];     // those reported, in order
  tests: number;
}

// The playground's interface to the library, and the steps of the draft's algorithms.
//
// Boxes are packed: the minima of one box and then its maxima, so 4 numbers per box in 2D and 6 in
// 3D. An id is a box's index in the array, from 0.

import type { Recorded } from "../scene/frames.ts";

/** Counts of a search. */
export interface Statistics {
  tests: number;       // pairs of boxes compared
  references: number;  // entries of boxes in cells, nodes or lists
  cells: number;       // cells or nodes; 0 if an algorithm does not count them
  hits: number;        // tests that found an overlap; 0 unless the search was observed
}

/** The structure of an algorithm over the boxes. */
export interface Outline {
  kind: string;  // "cells", "stripes", "nodes" or "sweep"; empty if there is nothing to draw
  caption: string;
  sweptAxis: number;       // the axis along which boxes are sorted; -1: none
  levels: Float32Array[];  // boxes, from the coarsest level down
}

export interface Tunable {
  name: string;
  summary: string;
  default: string;  // "auto" if the algorithm chooses the value
  type: "number" | "integer" | "choice";
  min?: number;  // for a number or an integer
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
  explanation: string;  // for auto, the chosen algorithm and the reason; otherwise empty
  milliseconds: number;
}

export interface Observation extends Search {
  /**
   * [a0, b0, ...]: each compared pair of boxes, in order. tests.length / 2 === statistics.tests.
   */
  tests: Uint32Array;
}

/** Events of one update of a tracker. */
export interface Frame {
  begun: Uint32Array;  // [a0, b0, ...]
  ended: Uint32Array;
  statistics: Statistics;
  milliseconds: number;
  bytes: number;  // the memory that the tracker holds
}

export interface Tracker {
  /**
   * Box i of this frame is box i of the last one. A box whose minimum is above its maximum is
   * absent.
   */
  update(boxes: Float32Array): Frame;
  /** Frees its memory. No method may be called afterwards. */
  free(): void;
}

export interface Scene {
  name: string;
  summary: string;
  dimension: number;
}

/**
 * The library in the page. Input that it refuses is thrown as an Error with the library's message.
 */
export interface Engine {
  algorithms(): Algorithm[];
  /** The regular build of the library. */
  find(spec: string, boxes: Float32Array, dimension: 2 | 3): Search;
  /**
   * The observing build of the same templates. It is slower, so its times say nothing about the
   * library.
   */
  observe(spec: string, boxes: Float32Array, dimension: 2 | 3): Observation;
  /** The milliseconds of `runs` searches together. */
  time(spec: string, boxes: Float32Array, dimension: 2 | 3, runs: number): number;
  /** What a search lays over the boxes; if `follows`, the cells that a tracker with `grid` keeps. */
  outline(spec: string, boxes: Float32Array, dimension: 2 | 3, follows?: boolean): Outline;
  tracker(spec: string, dimension: 2 | 3): Tracker;
  /** The algorithm that `auto` chooses for these boxes, and the reason. */
  advise(boxes: Float32Array, dimension: 2 | 3): string;
  /** The lab's generators; one for 2D and 3D is listed twice. */
  scenes(): Scene[];
  scene(spec: string, count: number, seed: number, dimension?: 2 | 3): Float32Array<ArrayBuffer>;
  /**
   * The boxes of a file, by the program's own readers (docs/formats.md); the warning says how it
   * was interpreted. `columns` names a table's columns, as the program's --columns does.
   */
  read(name: string, bytes: Uint8Array, columns?: string): Recorded & { warning: string };
}

/**
 * State of a search by one of the paper's algorithms. Arrays are shared between steps: do not
 * change them. `cells` and `nodes` are computed on access, so read them once.
 */
export type StepState = BruteForceState | GridState | SweepState | QuadtreeState | BvhState;

/** Algorithm 1: the indices of the two loops; -1 before a loop has begun. */
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
  cells: readonly (readonly number[])[];  // ids by column * rows + row; empty until Algorithm 2 has ended
  current: number;                        // the cell being filled or searched; -1: none
  /** While a box is inserted: the first and last column and row that it covers. */
  span?: readonly [firstColumn: number, lastColumn: number, firstRow: number, lastRow: number];
  /**
   * For two overlapping boxes: the greater minimum on each axis. The cell that contains this point
   * reports the pair.
   */
  point?: readonly [x: number, y: number];
}

/** Algorithms 5 and 6, along the x axis. */
export interface SweepState {
  kind: "sweep_and_prune";
  order: readonly number[];   // ids by their minimum x, once they are sorted
  next: number;               // index in the order of the current box of the sweep; -1 before
  position: number;           // position of the sweep line: that box's minimum x; NaN before
  active: readonly number[];  // F: the boxes that the line may still meet
}

export interface QuadtreeNode {
  depth: number;
  parent: number;  // index in `nodes`; -1: none
  /** The node's part of the world; nodes at the border are unbounded. */
  box: readonly [left: number, top: number, right: number, bottom: number];
  origin: readonly [x: number, y: number];
  children?: readonly [qi: number, qii: number, qiii: number, qiv: number];  // indices in `nodes`; a leaf has none
  boxes: readonly number[];  // ids, in a leaf and in a node that is being split
  count: number;
}

/** Algorithms 7 to 10. */
export interface QuadtreeState {
  kind: "quadtree";
  world: World;
  capacity: number;
  nodes: readonly QuadtreeNode[];  // a node's children come after it
  current: number;                 // the node being filled, split or searched; -1: none
  point?: readonly [x: number, y: number];  // as for the grid: the leaf that contains it reports the pair
}

export interface BvhNode {
  /** The bounds of all boxes below it. */
  box: readonly [left: number, top: number, right: number, bottom: number];
  children: readonly number[];  // indices in `nodes`; a leaf has none
  boxes: readonly number[];     // ids, in a leaf
}

/** Algorithm 12, with small leaves, and with pairs of nodes instead of lists of them. */
export interface BvhState {
  kind: "bvh";
  size: number;                  // maximum number of boxes of a leaf, and of children of a node
  order: readonly number[];      // ids, leaf by leaf; empty until they are sorted
  nodes: readonly BvhNode[];     // a node's children come before it
  current: readonly number[];    // the node being made, or the two being compared
}

export interface Step {
  line: number;  // the current line: an index into the listing
  text: string;  // what happens in this step, with the boxes named by id
  boxes: number[];  // the boxes involved
  pair?: [number, number];  // the pair being tested
  /** test: about to be compared; hit and miss: the result; reported: a hit that is written. */
  outcome?: "test" | "hit" | "miss" | "reported";
  state: StepState;
}

export type StepAlgorithm = StepState["kind"];

/**
 * Tunables of the mended listings; omitted ones are chosen as paper_grid and paper_quadtree choose
 * them.
 */
export interface StepOptions {
  cell?: number;      // grid: the side of a cell
  capacity?: number;  // quadtree: maximum number of boxes of a leaf before it splits; default 8
                      // bvh: of boxes of a leaf and of children of a node; default 16
}

export interface Steps {
  listing: string[];
  steps: Step[];                 // an array, so that the player can step back
  pairs: [number, number][];     // the reported pairs, in order
  tests: number;
}

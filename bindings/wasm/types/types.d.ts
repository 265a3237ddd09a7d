// The types that all entries of the package share.
/// <reference lib="esnext.disposable" />

// The arrays of results, over an `ArrayBuffer`: `slice()` says so in every version of TypeScript.
export type Uint32s = ReturnType<Uint32Array["slice"]>;
export type Float32s = ReturnType<Float32Array["slice"]>;
export type Float64s = ReturnType<Float64Array["slice"]>;

/** The dimension of boxes. */
export type Dimension = 2 | 3;

/**
 * An algorithm, perhaps with tunables: `"auto"`, `"grid"`, `"grid:cell=2.5"`. In `broadside/pairs`, `"auto"` chooses
 * `brute_force` or `grid` by the number of boxes.
 */
export type AlgorithmSpec =
  | "auto" | "brute_force" | "grid" | (string & {});

/**
 * Boxes one after the other, each with its minima and then its maxima: `minX, minY, maxX, maxY` in 2D, six numbers in
 * 3D. Numbers are rounded to floats. Boxes are closed: boxes that touch overlap. A box with `+Infinity` minima and
 * `-Infinity` maxima is absent: there is no box at its place.
 */
export type BoxArray = Float32Array | ArrayLike<number> | Boxes;

/** Which overlapping boxes count as pairs: an array for each property, with one element per box. */
export interface Filters {
  /** Bits: what the box is. 1 if left out. */
  readonly category?: ArrayLike<number>;
  /** Bits: the categories that it collides with. All if left out. */
  readonly mask?: ArrayLike<number>;
  /** Boxes of the same group other than 0 collide, whatever their bits, if it is positive; never if it is negative. */
  readonly group?: ArrayLike<number>;
  /** Two static boxes never collide. */
  readonly isStatic?: ArrayLike<number | boolean>;
}

/** The filter of one box. */
export interface Filter {
  readonly category?: number;
  readonly mask?: number;
  readonly group?: number;
  readonly isStatic?: boolean;
}

/** A key for each box, such as its image, class or layer: whole numbers or texts. */
export type Keys = ArrayLike<number | string>;

export interface CountOptions {
  /** If left out, the dimension that was loaded alone, or 2. */
  readonly dimension?: Dimension;
  /** If left out, `"auto"`. */
  readonly algorithm?: AlgorithmSpec;
  readonly filters?: Filters;
  /** Only boxes with the same key pair. Instead of filters. */
  readonly same?: Keys;
  /** Only boxes with different keys pair. Instead of filters. With `same` as well, both must hold. */
  readonly different?: Keys;
  /**
   * Whether boxes that only touch overlap: true by default. If false, boxes are half-open (min <= p < max), except
   * on an axis where minimum and maximum are equal.
   */
  readonly touching?: boolean;
  /**
   * A number finds the boxes whose Euclidean distance is at most that, instead of those that overlap. An array has a
   * radius for each box: two boxes pair if their distance is at most the sum of their radii. Points are boxes of equal minima and maxima.
   */
  readonly within?: number | ArrayLike<number>;
  /**
   * Space repeats: the length after which it does on each axis, Infinity on an axis on which it does not, such as
   * `[360, Infinity]` for longitude and latitude. Boxes then also pair around the edge.
   */
  readonly period?: ArrayLike<number>;
}

export interface ResultOptions {
  /**
   * Whether the returned arrays are views of the module's memory. A view saves the copy, but the next such call changes
   * it, and it becomes empty when the memory grows. By default arrays are copies, which no later call changes.
   */
  readonly view?: boolean;
}

export interface PairsOptions extends CountOptions, ResultOptions {
  /** Whether pairs are sorted. Otherwise their order depends only on the algorithm and the boxes. */
  readonly sorted?: boolean;
}

export interface ComponentsOptions extends CountOptions, ResultOptions {}

export interface CountJoinOptions extends CountOptions {
  readonly rightFilters?: Filters;
  /** The right set's keys, with `same`. */
  readonly rightSame?: Keys;
  /** The right set's keys, with `different`. */
  readonly rightDifferent?: Keys;
  /** The right set's radii, if `within` is an array of radii. */
  readonly rightWithin?: ArrayLike<number>;
}

export interface JoinOptions extends CountJoinOptions, PairsOptions {}

export interface NeighboursOptions {
  /**
   * Whether each box of a pair has the other one as a neighbour: true by default. If false, the first box has the
   * second, so that each pair is listed once; also for pairs of two sets.
   */
  readonly full?: boolean;
}

/** The neighbours of box i, ascending, are `ids.subarray(offsets[i], offsets[i + 1])`. */
export interface NeighbourLists {
  readonly offsets: Uint32s;
  readonly ids: Uint32s;
}

export interface TrackerOptions {
  readonly dimension?: Dimension;
  readonly algorithm?: AlgorithmSpec;
  /** As in `CountOptions`. If false, a world stores the next lower float of each maximum, and returns it as such. */
  readonly touching?: boolean;
}

export interface WorldOptions extends TrackerOptions {
  /** How far a box is enlarged on every side, so that small moves cost next to nothing. */
  readonly margin?: number;
  /** The same as a share of the box's longest side. If both are given, the smaller counts. */
  readonly relativeMargin?: number;
  /** How many frames of motion an enlarged box covers, if `move` is given velocities. */
  readonly predictedFrames?: number;
  /** Which boxes make the pairs: the boxes themselves (`"exact"`), or the enlarged ones. */
  readonly events?: "exact" | "enlarged";
  /** Whether current pairs are kept, for `pairs()`: true by default. */
  readonly keepPairs?: boolean;
  /** Whether invalid boxes count as absent instead of being refused. */
  readonly quarantine?: boolean;
  /** The most boxes that the world may hold. */
  readonly maxBoxes?: number;
  /** Whether each update is checked by brute force, for debugging. */
  readonly shadow?: boolean;
}

/** An object with memory in the module. `free` releases it; so does the garbage collector, but later. */
export interface Freeable {
  /** Afterwards, every call except `free` throws. */
  free(): void;
  [Symbol.dispose](): void;
}

/** Boxes in the module's memory: searches take them without a copy. */
export interface Boxes extends Freeable {
  readonly dimension: Dimension;
  /** How many boxes there are. */
  readonly count: number;
  /** The coordinates, to be read and written. Get it again after other calls: they may move the module's memory. */
  readonly data: Float32s;
}

/** The events of one update, sorted: two numbers per pair. */
export interface Events<Numbers> {
  readonly begun: Numbers;
  readonly ended: Numbers;
}

/** Follows an array of boxes from frame to frame. */
export interface Tracker extends Freeable {
  readonly dimension: Dimension;
  /**
   * Takes the boxes of the next frame, and returns the pairs that began and ended, as places in the array.
   *
   * It compares the boxes with those of the frame before. If you know which ones differ, list them: a change that is
   * not listed is not seen.
   */
  update(boxes: BoxArray, options?: TrackerUpdateOptions): Events<Uint32s>;
}

export interface FrameOptions {
  readonly changed?: ArrayLike<number>;
  readonly filters?: Filters;
}

export interface TrackerUpdateOptions extends FrameOptions, ResultOptions {}

/** A whole number that names one box of a world for ever, and can be the key of a `Map`. */
export type Handle = number;

/** One handle, or many. */
export type Handles = Handle | ArrayLike<Handle>;

/** Boxes that come, move and go under handles, and the pairs that begin and end. */
export interface World extends Freeable {
  readonly dimension: Dimension;
  /** How many boxes there are. */
  readonly size: number;
  /** Adds boxes, and returns a handle for each. */
  add(boxes: BoxArray, options?: { readonly filters?: Filters }): Float64s;
  /** Adds one box, and returns its handle. */
  addOne(box: BoxArray, options?: { readonly filter?: Filter }): Handle;
  /** Replaces boxes: all of them or, if one is invalid, none. */
  move(handles: Handles, boxes: BoxArray, options?: { readonly velocities?: ArrayLike<number> }): void;
  /** Takes boxes out. Their pairs end at the next update. */
  remove(handles: Handles): void;
  /** Brings the pairs up to date. Each pair is two handles. */
  update(options?: ResultOptions): Events<Float64s>;
  /** The pairs of the last update, sorted, each as two handles. */
  pairs(options?: ResultOptions): Float64s;
  has(handle: Handle): boolean;
  /** The box's coordinates. */
  box(handle: Handle): Float32s;
  /** A small whole number that no other box of the world has: an index into arrays of your own. */
  slot(handle: Handle): number;
  setFilter(handle: Handle, filter: Filter): void;
  /** Makes two boxes never count as a pair, such as bodies that a joint connects. */
  ignore(a: Handle, b: Handle): void;
  /** Lets them count again. */
  unignore(a: Handle, b: Handle): void;
}

export interface QueryOptions {
  /** Only boxes that this filter accepts are found. */
  readonly filter?: Filter;
  /** A box to leave out, such as the one that a ray starts from: a place, or a world's handle. */
  readonly except?: number;
}

export interface OverlappingOptions extends QueryOptions, ResultOptions {}

export interface NearestOptions extends OverlappingOptions {
  /** Boxes farther away are not found. */
  readonly maxDistance?: number;
}

export interface NearestOfEachOptions extends ResultOptions {
  /** Boxes farther away are not found. */
  readonly maxDistance?: number;
  /** For each query the id of a box that it does not find: to leave out the box itself, its place. */
  readonly except?: ArrayLike<number>;
  /** A filter for each query. The query finds only boxes whose filters accept it. */
  readonly filters?: Filters;
}

export interface RayOptions extends QueryOptions {
  /** The ray ends at `origin + tMax * direction`. If left out, it does not end. */
  readonly tMax?: number;
  /** Half the extent, on each axis, of a box that is moved instead of the point. */
  readonly halfExtent?: ArrayLike<number>;
  /** Whether to leave out boxes that the ray, or the moving box, is in or rests on at its start and does not enter. */
  readonly entering?: boolean;
}

/** A box that a ray hits, at `origin + t * direction`. */
export interface Hit {
  readonly id: number;
  readonly t: number;
}

/** Boxes by distance, the nearest first. */
export interface Neighbours<Numbers> {
  readonly ids: Numbers;
  /** Euclidean distances, not squared. */
  readonly distances: Float64s;
}

/** Queries about boxes. The order of results has no meaning unless a query states one. */
export interface Queries<Numbers> {
  /** The boxes that overlap a box. For the boxes that contain a point, give it as minima and as maxima. */
  overlapping(box: ArrayLike<number>, options?: OverlappingOptions): Numbers;
  /** The `k` boxes nearest to a point or a box: by distance, then by id. */
  nearest(from: ArrayLike<number>, k: number, options?: NearestOptions): Neighbours<Numbers>;
  /** The first box that a ray hits. */
  firstHit(origin: ArrayLike<number>, direction: ArrayLike<number>, options?: RayOptions): Hit | undefined;
}

/** An index of boxes, for queries. */
export interface Index extends Queries<Uint32s>, Freeable {
  readonly dimension: Dimension;
  /** Replaces the boxes. If you know which ones differ, list them: a change that is not listed is not seen. */
  update(boxes: BoxArray, options?: FrameOptions): void;
  /**
   * The `k` boxes nearest to each of `boxes`: `k` ids and distances for each in turn, by distance, then by id. A row
   * with fewer boxes ends with ids 4294967295 at `Infinity`.
   */
  nearestOfEach(boxes: BoxArray, k: number, options?: NearestOfEachOptions): Neighbours<Uint32s>;
}

/** A world with queries. */
export interface QueriedWorld extends World, Queries<Float64s> {}

/** Pairs, trackers and worlds. */
export interface PairFinding {
  /**
   * Every pair of overlapping boxes, once, as places in the array: `a0, b0, a1, b1, ...` with `a < b`.
   */
  pairs(boxes: BoxArray, options?: PairsOptions): Uint32s;
  /** Every pair of a box of `left` and an overlapping one of `right`, likewise. */
  join(left: BoxArray, right: BoxArray, options?: JoinOptions): Uint32s;
  count(boxes: BoxArray, options?: CountOptions): number;
  /**
   * The connected components of the pairs, such as clusters of touching things: for each box, the least place of a box
   * in its component. No pairs are kept.
   */
  components(boxes: BoxArray, options?: ComponentsOptions): Uint32s;
  /** The neighbours of each of `count` boxes, of pairs in any order. */
  neighbours(pairs: ArrayLike<number>, count: number, options?: NeighboursOptions): NeighbourLists;
  countJoin(left: BoxArray, right: BoxArray, options?: CountJoinOptions): number;
  /** Room for `count` boxes in the module's memory, absent until you set them. */
  boxes(count: number, dimension?: Dimension): Boxes;
  tracker(options?: TrackerOptions): Tracker;
  world(options?: WorldOptions): World;
  /** The names of the algorithms. */
  algorithms(): string[];
  readonly version: string;
}

/** Pairs, trackers, worlds and queries. */
export interface Broadside extends PairFinding {
  world(options?: WorldOptions): QueriedWorld;
  /** An index of boxes, for queries. */
  index(boxes: BoxArray, options?: { readonly dimension?: Dimension; readonly filters?: Filters }): Index;
}

/** An error of the library. The call that threw it has changed nothing. */
export declare class BroadsideError extends Error {
  readonly name: "BroadsideError";
  readonly code: BroadsideErrorCode;
  /** For `INVALID_INPUT`: the place of the first invalid box. */
  readonly index: number | undefined;
}

export type BroadsideErrorCode =
  /** A box with a NaN, or with min > max. */
  | "INVALID_INPUT"
  /** Arrays that do not fit together, or more boxes than `maxBoxes`. */
  | "INVALID_FRAME"
  /** A query with a NaN, or with an infinity where none is allowed. */
  | "INVALID_QUERY"
  /** An unknown algorithm, or a tunable out of its range. */
  | "INVALID_SPEC"
  /** A handle that names no box of this world. */
  | "INVALID_HANDLE"
  /** Another invalid argument. */
  | "INVALID_ARGUMENT"
  | "OUT_OF_MEMORY"
  | "FAILED";

export interface LoadOptions {
  /**
   * The only dimension of boxes that you need, which halves the download. It is then the default of all calls. If left
   * out, both dimensions are loaded, and the default is 2.
   */
  readonly dimension?: Dimension;
}

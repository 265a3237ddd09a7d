// Queries: indexes of arrays of boxes, and worlds that are asked as well.
import type {
  BoxArray, Dimension, Filters, Float64s, FrameOptions, Hit, Index, NearestOfEachOptions, NearestOptions,
  Neighbours, OverlappingOptions, QueriedWorld, Queries, QueryOptions, RayOptions, Uint32s, WorldOptions,
} from "../types/types.d.ts";
import { type Given, bytesOfFilter, countIn, countOf, putFilter } from "./boxes.ts";
import type { Core, Cores, Exports } from "./core.ts";
import { asksForView, checkOptions, checkSwitch, refuse } from "./error.ts";
import { Kept } from "./kept.ts";
import { frameOptions, idsOf, putFrame } from "./tracker.ts";
import { KeptWorld, handlesOf } from "./world.ts";

/** What the module with queries exports besides: module/queries.cpp. */
export interface QueryExports extends Exports {
  index_make(): number;
  index_free(index: number): void;
  index_update(
    index: number, boxes: number, count: number, changed: number, changedCount: number, filters: number,
  ): number;
  query_overlapping(isWorld: number, asked: number, filter: number, except: number): number;
  query_nearest(
    isWorld: number, asked: number, filter: number, except: number, k: number, maxDistance: number,
  ): number;
  query_nearest_of_each(
    index: number, boxes: number, count: number, except: number, exceptCount: number, filters: number, k: number,
    maxDistance: number,
  ): number;
  query_first_hit(isWorld: number, asked: number, filter: number, except: number, entering: number): number;
}

const queryOptions = ["filter", "except"];
const foundOptions = [...queryOptions, "view"];
const nearestOptions = [...foundOptions, "maxDistance"];
const rayOptions = [...queryOptions, "tMax", "halfExtent", "entering"];
const noExtent = [0, 0, 0];
const nothing = -1;  // the `except` of a query that leaves none out

function checkK(k: unknown, least: number): void {
  if (!Number.isInteger(k) || (k as number) < least || (k as number) >= 2 ** 32)
    refuse("k", k, `a whole number of at least ${least}`);
}

function maxDistanceOf({ maxDistance = Infinity }: { readonly maxDistance?: number }): number {
  if (!(typeof maxDistance === "number" && maxDistance >= 0))
    refuse("maxDistance", maxDistance, "at least 0, or Infinity");
  return maxDistance;
}

/** Asks an index or a world. `Numbers` are ids or handles. */
class Asker<Numbers extends Uint32Array | Float64Array> implements Queries<Numbers> {
  readonly #core: Core;
  readonly #exports: QueryExports;
  readonly #dimension: Dimension;
  readonly #isWorld: number;
  readonly #address: () => number;
  readonly #found: (view: boolean) => Numbers;

  constructor(core: Core, isWorld: boolean, address: () => number, found: (view: boolean) => Numbers) {
    this.#core = core;
    this.#exports = core.exports as QueryExports;
    this.#dimension = core.dimension;
    this.#isWorld = isWorld ? 1 : 0;
    this.#address = address;
    this.#found = found;
  }

  /** Puts numbers of a question into the module, and returns where the next ones go. */
  #ask(at: number, numbers: ArrayLike<number>, count: number, name: string): number {
    if (countIn(numbers, 1, name) !== count) {
      const expected = name === "box" ? `${count}, with a point given as minima and as maxima` : String(count);
      refuse(`the length of ${name}`, numbers.length, expected);
    }
    const core = this.#core;
    core.refresh();
    // For so few numbers, set() takes longer.
    for (let i = 0; i < count; ++i) core.f32[core.question + at + i] = numbers[i] as number;
    return at + count;
  }

  /** Where the module finds the filter. */
  #filter({ filter, except }: QueryOptions): number {
    if (except !== undefined && typeof except !== "number") refuse("except", except, "a number");
    if (filter === undefined) return 0;
    this.#core.stage(bytesOfFilter);
    return putFilter(this.#core, filter);
  }

  overlapping(box: ArrayLike<number>, options: OverlappingOptions = {}): Numbers {
    const address = this.#address();
    this.#ask(0, box, 2 * this.#dimension, "box");
    checkOptions(options, foundOptions);
    const view = asksForView(options);
    this.#core.check(this.#exports.query_overlapping(this.#isWorld, address, this.#filter(options),
      options.except ?? nothing));
    return this.#found(view);
  }

  nearest(from: ArrayLike<number>, k: number, options: NearestOptions = {}): Neighbours<Numbers> {
    const address = this.#address();
    const core = this.#core;
    const dimension = this.#dimension;
    if (countIn(from, 1, "point") === 2 * dimension) {
      this.#ask(0, from, 2 * dimension, "box");
    } else {
      this.#ask(0, from, dimension, "point");
      this.#ask(dimension, from, dimension, "point");
    }
    checkK(k, 0);
    checkOptions(options, nearestOptions);
    const maxDistance = maxDistanceOf(options);
    const view = asksForView(options);
    core.check(this.#exports.query_nearest(this.#isWorld, address, this.#filter(options), options.except ?? nothing, k,
      maxDistance));
    return { ids: this.#found(view), distances: handlesOf(core, 1, 1, view) };
  }

  firstHit(origin: ArrayLike<number>, direction: ArrayLike<number>, options: RayOptions = {}): Hit | undefined {
    const address = this.#address();
    const core = this.#core;
    const dimension = this.#dimension;
    let at = this.#ask(0, origin, dimension, "origin");
    at = this.#ask(at, direction, dimension, "direction");
    checkOptions(options, rayOptions);
    const { tMax = Infinity, halfExtent, entering = false } = options;
    if (typeof tMax !== "number") refuse("tMax", tMax, "a number");
    checkSwitch("entering", entering);
    core.f32[core.question + at++] = tMax;
    this.#ask(at, halfExtent ?? noExtent.slice(0, dimension), dimension, "halfExtent");
    core.check(this.#exports.query_first_hit(this.#isWorld, address, this.#filter(options), options.except ?? nothing,
      entering ? 1 : 0));
    const found = this.#found(true);
    return found.length === 0 ? undefined : { id: found[0] as number, t: core.f32[core.question] as number };
  }
}

export class KeptIndex extends Kept implements Index {
  readonly #core: Core;
  readonly #asker: Asker<Uint32s>;
  readonly dimension: Dimension;

  constructor(cores: Cores, boxes: BoxArray,
    options: { readonly dimension?: Dimension; readonly filters?: Filters } = {}) {
    const core = cores.of(options?.dimension);
    countOf(core, boxes);
    checkOptions(options, ["dimension", "filters"]);
    const { dimension: _, ...rest } = options;
    const exports = core.exports as QueryExports;
    core.check(exports.index_make());
    super(core.u32[core.reply] as number, (address) => exports.index_free(address));
    this.#core = core;
    this.dimension = core.dimension;
    this.#asker = new Asker(core, false, () => this.address, (view) => idsOf(core, 0, 1, view));
    try {
      this.update(boxes, rest);
    } catch (error) {
      this.free();
      throw error;
    }
  }

  update(boxes: BoxArray, options: FrameOptions = {}): void {
    const core = this.#core;
    const index = this.address;
    countOf(core, boxes);
    checkOptions(options, frameOptions);
    const frame = putFrame(core, boxes as Given, options);
    core.check((core.exports as QueryExports).index_update(index, frame.at, frame.count, frame.changed,
      frame.changedCount, frame.filters));
  }

  overlapping(box: ArrayLike<number>, options?: OverlappingOptions): Uint32s {
    return this.#asker.overlapping(box, options);
  }

  nearest(from: ArrayLike<number>, k: number, options?: NearestOptions): Neighbours<Uint32s> {
    return this.#asker.nearest(from, k, options);
  }

  nearestOfEach(boxes: BoxArray, k: number, options: NearestOfEachOptions = {}): Neighbours<Uint32s> {
    const core = this.#core;
    const index = this.address;
    countOf(core, boxes);
    checkK(k, 1);
    checkOptions(options, ["except", "filters", "maxDistance", "view"]);
    const maxDistance = maxDistanceOf(options);
    const view = asksForView(options);
    const { except: changed, filters } = options;
    const given = putFrame(core, boxes as Given, { ...(changed && { changed }), ...(filters && { filters }) }, "except");
    core.check((core.exports as QueryExports).query_nearest_of_each(index, given.at, given.count, given.changed,
      given.changedCount, given.filters, k, maxDistance));
    return { ids: idsOf(core, 0, 1, view), distances: handlesOf(core, 1, 1, view) };
  }

  firstHit(origin: ArrayLike<number>, direction: ArrayLike<number>, options?: RayOptions): Hit | undefined {
    return this.#asker.firstHit(origin, direction, options);
  }
}

export class AskedWorld extends KeptWorld implements QueriedWorld {
  readonly #asker: Asker<Float64s>;

  constructor(cores: Cores, options?: WorldOptions) {
    super(cores, options);
    const { core } = this;
    this.#asker = new Asker(core, true, () => this.address, (view) => handlesOf(core, 0, 1, view));
  }

  overlapping(box: ArrayLike<number>, options?: OverlappingOptions): Float64s {
    return this.#asker.overlapping(box, options);
  }

  nearest(from: ArrayLike<number>, k: number, options?: NearestOptions): Neighbours<Float64s> {
    return this.#asker.nearest(from, k, options);
  }

  firstHit(origin: ArrayLike<number>, direction: ArrayLike<number>, options?: RayOptions): Hit | undefined {
    return this.#asker.firstHit(origin, direction, options);
  }
}

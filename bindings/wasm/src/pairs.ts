// All pairs of boxes of one dimension: by finders that stay in the module, one for each algorithm, so that calls ask for no memory.
import type {
  ComponentsOptions, CountJoinOptions, CountOptions, Filters, JoinOptions, NeighbourLists,
  NeighboursOptions, PairsOptions, Uint32s,
} from "../types/types.d.ts";
import {
  type Given, bytesOf, bytesOfFilter, checkFilters, copyOf, countIn, countOf, put, putDoubles, putFilters,
} from "./boxes.ts";
import type { Core } from "./core.ts";
import { asksForView, checkOptions, checkSwitch, refuse } from "./error.ts";
import { fewPairs2, fewPairs3, maxFew } from "./few.ts";

/** As in module/pairs.cpp. */
const enum Mode { counts = 1, sorts = 2, joins = 4, leavesOutTouching = 8, labels = 16, hasDistance = 32, hasRadii = 64, isPeriodic = 128 }

const countOptions = ["dimension", "algorithm", "filters", "same", "different", "touching", "within", "period"];
const pairsOptions = [...countOptions, "sorted", "view"];
const componentsOptions = [...countOptions, "view"];
const rightOptions = ["rightFilters", "rightSame", "rightDifferent", "rightWithin"];
const countJoinOptions = [...countOptions, ...rightOptions];
const joinOptions = [...pairsOptions, ...rightOptions];

/** Views of fewer ids than this are kept: making one costs as much as comparing ten boxes. */
const maxKept = 256;

/** Finders of so many kinds are kept; those of a program that makes up more go. */
const maxFinders = 16;

export class Pairs {
  readonly #core: Core;
  readonly #finders = new Map<string, number>();
  #lastAlgorithm = "";
  #lastFinder = 0;
  #lastChecked: object | undefined;  // options that were looked through for unknown ones
  #lastView: Uint32s = new Uint32Array(0);

  readonly #isFlat: boolean;
  readonly #maxOfFew: number;  // numbers in an array of few boxes
  readonly #maxFewIds: number;
  #fewPairs: Uint32s;  // room for all pairs of few boxes
  readonly #views: Uint32s[] = [];  // of its first ids, by their number
  readonly #forFew: string;  // the algorithm that few boxes get where none is named

  constructor(core: Core) {
    this.#core = core;
    this.#isFlat = core.dimension === 2;
    const max = maxFew(core.dimension);
    this.#maxOfFew = 2 * core.dimension * max;
    this.#maxFewIds = max * (max - 1);
    this.#fewPairs = new Uint32Array(this.#maxFewIds);
    this.#forFew = core.algorithmFor(0);
  }

  pairs(boxes: Given, options?: PairsOptions): Uint32s {
    // Short, so that engines compile it and the loops that it calls as one function. What #meansFew() says of usual
    // options is looked at here, for calling it would take as long as comparing two boxes.
    if (boxes instanceof Float32Array && boxes.length <= this.#maxOfFew && (options === undefined ||
        options === this.#lastChecked && options.filters === undefined && options.same === undefined &&
        options.different === undefined && options.algorithm === undefined && options.touching !== false &&
        options.within === undefined && options.period === undefined ||
        this.#meansFew(options))) {
      if (this.#fewPairs.length === 0) this.#renewFew();
      const found = this.#isFlat ? fewPairs2(boxes, this.#fewPairs) : fewPairs3(boxes, this.#fewPairs);
      if (found >= 0) return options?.view === true ? this.#viewOfFew(found) : this.#copyOfFew(found);
    }
    return this.#pairsByModule(boxes, options);
  }

  #pairsByModule(boxes: Given, options: PairsOptions | undefined): Uint32s {
    if (options === undefined) return this.#find(boxes, undefined, {}, 0);
    if (options !== this.#lastChecked) this.#check(options, pairsOptions);
    return this.#find(boxes, undefined, options, options.sorted === true ? Mode.sorts : 0);
  }

  /** Makes the room again: a view of it was transferred, and the room went with it. */
  #renewFew(): void {
    this.#fewPairs = new Uint32Array(this.#maxFewIds);
    this.#views.length = 0;
  }

  #viewOfFew(ids: number): Uint32s {
    const kept = this.#views[ids];
    if (kept !== undefined) return kept;
    const view = this.#fewPairs.subarray(0, ids);
    if (ids < maxKept) this.#views[ids] = view;
    return view;
  }

  #copyOfFew(ids: number): Uint32s {
    return copyOf(this.#fewPairs, 0, ids, Uint32Array);
  }

  /** Whether few boxes may be compared in JavaScript. */
  #meansFew(options: PairsOptions): boolean {
    if (options !== this.#lastChecked) this.#check(options, pairsOptions);
    const { algorithm } = options;
    return options.filters === undefined && options.same === undefined && options.different === undefined &&
      options.touching !== false && options.within === undefined && options.period === undefined &&
      (algorithm === undefined || algorithm === "brute_force" || algorithm === this.#forFew);
  }

  join(left: Given, right: Given, options: JoinOptions = {}): Uint32s {
    this.#check(options, joinOptions);
    return this.#find(left, right, options, Mode.joins | (options.sorted === true ? Mode.sorts : 0));
  }

  components(boxes: Given, options: ComponentsOptions = {}): Uint32s {
    this.#check(options, componentsOptions);
    return this.#find(boxes, undefined, options, Mode.labels);
  }

  count(boxes: Given, options: CountOptions = {}): number {
    this.#check(options, countOptions);
    this.#search(boxes, undefined, options, Mode.counts);
    return this.#counted();
  }

  countJoin(left: Given, right: Given, options: CountJoinOptions = {}): number {
    this.#check(options, countJoinOptions);
    this.#search(left, right, options, Mode.counts | Mode.joins);
    return this.#counted();
  }

  #check(options: JoinOptions, known: readonly string[]): void {
    checkOptions(options, known);
    checkSwitch("touching", options.touching);
    checkSwitch("sorted", options.sorted);
    asksForView(options);
    this.#lastChecked = known === pairsOptions ? options : undefined;
  }

  #find(boxes: Given, right: Given | undefined, options: JoinOptions, mode: number): Uint32s {
    this.#search(boxes, right, options, mode);
    const { u32, reply } = this.#core;
    const address = u32[reply] as number;
    const length = (mode & Mode.labels ? 1 : 2) * (u32[reply + 1] as number);
    if (options.view !== true) return u32.slice(address / 4, address / 4 + length);
    const last = this.#lastView;
    // The same view again where it would be no other: making one is not cheap.
    if (last.length === length && last.byteOffset === address && last.buffer === u32.buffer) return last;
    return (this.#lastView = new Uint32Array(u32.buffer, address, length));
  }

  #counted(): number {
    const { u32, reply } = this.#core;
    return (u32[reply] as number) + 2 ** 32 * (u32[reply + 1] as number);
  }

  #search(boxes: Given, right: Given | undefined, options: JoinOptions, mode: number): void {
    const core = this.#core;
    let { filters, rightFilters } = options;
    let different = noNumbers;
    const count = countOf(core, boxes, right === undefined ? "boxes" : "left");
    const rightCount = right === undefined ? 0 : countOf(core, right, "right");
    if (options.same !== undefined || options.different !== undefined || options.rightSame !== undefined ||
        options.rightDifferent !== undefined)
      [filters, rightFilters, different] = filtersOfKeys(options, count, right === undefined ? undefined : rightCount);
    if (filters !== undefined) checkFilters(filters, count);
    if (rightFilters !== undefined) checkFilters(rightFilters, rightCount, "rightFilters");
    const [reach, within, rightWithin] = periodicReachOf(options, core.dimension, count, right === undefined ? undefined : rightCount);
    const finder = this.#finder(core.algorithmFor(Math.max(count, rightCount), options.algorithm));
    core.stage(bytesOf(boxes) + (right === undefined ? 0 : bytesOf(right)) +
      (filters === undefined && rightFilters === undefined ? 0 : bytesOfFilter * (count + rightCount + 2)) +
      8 * (within.length + rightWithin.length + different.length));
    const at = put(core, boxes);
    const rightAt = right === undefined ? 0 : put(core, right);
    core.check(core.exports.finder_find(finder, at, count, rightAt, rightCount,
      putFilters(core, some(filters), count), putFilters(core, some(rightFilters), rightCount, "rightFilters"),
      reach | (options.touching === false ? mode | Mode.leavesOutTouching : mode), putDoubles(core, within),
      putDoubles(core, rightWithin), putDoubles(core, different)));
  }

  #finder(algorithm: string): number {
    if (algorithm === this.#lastAlgorithm) return this.#lastFinder;
    if (typeof algorithm !== "string") refuse("algorithm", algorithm, "a text such as 'auto'");
    const { exports } = this.#core;
    let finder = this.#finders.get(algorithm);
    if (finder === undefined) {
      finder = this.#core.make(algorithm, (spec, size) => exports.finder_make(spec, size));
      if (this.#finders.size >= maxFinders) {
        this.#finders.forEach((old) => exports.finder_free(old));
        this.#finders.clear();
      }
      this.#finders.set(algorithm, finder);
    }
    this.#lastAlgorithm = algorithm;
    return (this.#lastFinder = finder);
  }
}

type KeysOption = "same" | "different" | "rightSame" | "rightDifferent";

/** A number from 1 on for each box's key, the same for equal ones. `numbers` has those so far. */
function numbersOfKeys(
  options: JoinOptions, name: KeysOption, boxes: number, numbers: Map<number | string, number>,
): number[] {
  const keys = options[name];
  if (keys === undefined || countIn(keys, 1, name) !== boxes)
    refuse(`the length of ${name}`, keys?.length, `${boxes}, one for each box`);
  return Array.from(keys, (key, i) => {
    if (typeof key !== "string" && !Number.isInteger(key)) refuse(`${name}[${i}]`, key, "a whole number or a text");
    let number = numbers.get(key);
    if (number === undefined) numbers.set(key, number = numbers.size + 1);
    return number;
  });
}

/**
 * Filters by which only boxes with the same key pair, or only boxes with different ones: each key is a group. With both
 * kinds of keys, those are of the same ones, and the numbers of the different ones of both sets follow.
 */
function filtersOfKeys(
  options: JoinOptions, count: number, rightCount: number | undefined,
): [Filters, Filters | undefined, ArrayLike<number>] {
  const isSame = options.same !== undefined || options.rightSame !== undefined;
  const isDifferent = options.different !== undefined || options.rightDifferent !== undefined;
  const numbers = new Map<number | string, number>();
  const made = (name: KeysOption, filters: "filters" | "rightFilters", boxes: number): Filters => {
    if (options[filters] !== undefined) refuse(filters, options[filters], `nothing, as ${name} is given`);
    const group = numbersOfKeys(options, name, boxes, numbers);
    if (!isSame) return { group: group.map((number) => -number) };
    const none = new Uint32Array(boxes);
    return { category: none, mask: none, group };
  };
  const filters = made(isSame ? "same" : "different", "filters", count);
  const right = rightCount === undefined ? undefined :
    made(isSame ? "rightSame" : "rightDifferent", "rightFilters", rightCount);
  if (!(isSame && isDifferent)) return [filters, right, noNumbers];
  const ofDifferent = new Map<number | string, number>();
  const different = numbersOfKeys(options, "different", count, ofDifferent);
  if (rightCount === undefined) return [filters, right, different];
  return [filters, right, [...different, ...numbersOfKeys(options, "rightDifferent", rightCount, ofDifferent)]];
}

type Reach = readonly [mode: number, within: ArrayLike<number>, rightWithin: ArrayLike<number>];

const noNumbers: ArrayLike<number> = [];
const noReach: Reach = [0, noNumbers, noNumbers];

/** The mode of `within`, and its distance or its radii of both sets. */
function reachOf(options: JoinOptions, count: number, rightCount: number | undefined): Reach {
  const { within, rightWithin } = options;
  if (within === undefined || typeof within === "number") {
    if (rightWithin !== undefined) refuse("rightWithin", rightWithin, "nothing, as within is no array of radii");
    return within === undefined ? noReach : [Mode.hasDistance, [within], noNumbers];
  }
  const checked = (radii: ArrayLike<number> | undefined, name: string, boxes: number) => {
    if (radii === undefined || countIn(radii, 1, name) !== boxes)
      refuse(`the length of ${name}`, radii?.length, `${boxes}, one for each box`);
    return radii;
  };
  return [Mode.hasRadii, checked(within, "within", count),
    rightCount === undefined ? noNumbers : checked(rightWithin, "rightWithin", rightCount)];
}

/** The same with the periods after the distance or the left radii. */
function periodicReachOf(
  options: JoinOptions, dimension: number, count: number, rightCount: number | undefined,
): Reach {
  const { period } = options;
  const [mode, within, rightWithin] = reachOf(options, count, rightCount);
  if (period === undefined) return [mode, within, rightWithin];
  if (countIn(period, 1, "period") !== dimension)
    refuse("the length of period", period.length, `${dimension}, one for each axis, Infinity for one that does not repeat`);
  return [Mode.isPeriodic | (mode === 0 ? Mode.hasDistance : mode),
    [...Array.from(mode === 0 ? [0] : within), ...Array.from(period)], rightWithin];
}

/** The neighbours of each of `count` boxes. */
export function neighboursOf(pairs: ArrayLike<number>, count: number, options: NeighboursOptions = {}): NeighbourLists {
  checkOptions(options, ["full"]);
  checkSwitch("full", options.full);
  const full = options.full !== false;
  if (!(Number.isInteger(count) && count >= 0)) refuse("count", count, "a whole number of 0 or more");
  const all = 2 * countIn(pairs, 2, "pairs");
  const offsets = new Uint32Array(count + 1);
  for (let i = 0; i < all; ++i) {
    const box = pairs[i] as number;
    if (full || i % 2 === 0) {
      if (!(Number.isInteger(box) && box >= 0 && box < count)) refuse(`pairs[${i}]`, box, `an id below ${count}`);
      offsets[box] = (offsets[box] as number) + 1;
    }
  }
  for (let i = 1; i <= count; ++i) offsets[i] = (offsets[i] as number) + (offsets[i - 1] as number);
  // Each offset is now the end of its box's neighbours, and becomes their begin as they are written.
  const ids = new Uint32Array(full ? all : all / 2);
  const write = (box: number, neighbour: number) => {
    ids[offsets[box] = (offsets[box] as number) - 1] = neighbour;
  };
  for (let i = 0; i < all; i += 2) {
    write(pairs[i] as number, pairs[i + 1] as number);
    if (full) write(pairs[i + 1] as number, pairs[i] as number);
  }
  for (let i = 0; i < count; ++i) ids.subarray(offsets[i], offsets[i + 1]).sort();
  return { offsets, ids };
}

/** Filters that say anything. */
function some(filters: Filters | undefined): Filters | undefined {
  return filters !== undefined && Object.keys(filters).length > 0 ? filters : undefined;
}

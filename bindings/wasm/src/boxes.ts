// Boxes in the module's memory, and boxes and filters as a call takes them.
import type { Boxes, Dimension, Filter, Filters, Float32s, Float64s, Uint32s } from "../types/types.d.ts";
import type { Core } from "./core.ts";
import { checkOptions, refuse } from "./error.ts";
import { Kept } from "./kept.ts";

export class KeptBoxes extends Kept implements Boxes {
  readonly #core: Core;
  readonly count: number;
  readonly dimension: Dimension;
  #data: Float32s;

  constructor(core: Core, count: number) {
    const { exports, dimension } = core;
    if (!Number.isInteger(count) || count < 0 || count >= 2 ** 32)
      refuse("the number of boxes", count, "a whole number of at least 0");
    super(core.reserve(Math.max(8 * dimension * count, 1)), (address) => exports.release(address));
    this.#core = core;
    this.count = count;
    this.dimension = dimension;
    this.#data = this.#view();
    for (let box = 0; box < count; ++box) {
      this.#data.fill(Infinity, 2 * dimension * box, dimension * (2 * box + 1));
      this.#data.fill(-Infinity, dimension * (2 * box + 1), 2 * dimension * (box + 1));
    }
  }

  #view(): Float32s {
    return new Float32Array(this.#core.exports.memory.buffer, this.address, 2 * this.dimension * this.count);
  }

  get data(): Float32s {
    // Memory that has grown has taken the view's.
    if (this.#data.length === 0 || this.address === 0) this.#data = this.#view();
    return this.#data;
  }

  isOf(core: Core): boolean {
    return this.#core === core;
  }
}

/** Boxes that a call is given, before they are where the module finds them. */
export type Given = KeptBoxes | ArrayLike<number>;

/** How many boxes these are. Throws if they are none. */
export function countOf(core: Core, boxes: unknown, name = "boxes"): number {
  const { dimension } = core;
  if (boxes instanceof KeptBoxes) {
    if (boxes.dimension !== dimension) refuse(`the dimension of ${name}`, boxes.dimension, String(dimension));
    if (!boxes.isOf(core)) refuse(name, boxes, "boxes of this module; these are another one's");
    return boxes.count;
  }
  const row = dimension === 2 ? "minX, minY, maxX, maxY" : "minX, minY, minZ, maxX, maxY, maxZ";
  const first = (boxes as ArrayLike<unknown> | undefined)?.[0];
  if (typeof first === "object") refuse(`${name}[0]`, first, `a number: one array has all boxes, ${row} of each`);
  if (typeof boxes === "object" && boxes !== null && !("length" in boxes))
    refuse(name, boxes, `an array of numbers: ${row} of each box`);
  return countOfNumbers(boxes, 2 * dimension, name);
}

/** As countIn(). Throws if the first is not a number: it tells an array of texts or booleans from one of numbers. */
export function countOfNumbers(numbers: unknown, each: number, name: string): number {
  const count = countIn(numbers, each, name);
  const first: unknown = (numbers as ArrayLike<unknown>)[0];
  if (count > 0 && typeof first !== "number") refuse(`${name}[0]`, first, "a number");
  return count;
}

/** How many groups of `each` numbers an array has. */
export function countIn(numbers: unknown, each: number, name: string): number {
  if (typeof numbers !== "object" || numbers === null) refuse(name, numbers, "an array of numbers");
  const { length } = numbers as ArrayLike<number>;
  if (typeof length !== "number" || numbers instanceof DataView) refuse(name, numbers, "an array of numbers");
  if (length % each !== 0) refuse(`the length of ${name}`, length, `a multiple of ${each}`);
  return length / each;
}

/** Bytes that the boxes take of a call's room. */
export function bytesOf(boxes: Given): number {
  return boxes instanceof KeptBoxes ? 0 : 4 * boxes.length;
}

/** Where the module finds the boxes. */
export function put(core: Core, boxes: Given): number {
  return boxes instanceof KeptBoxes ? boxes.address : putFloats(core, boxes);
}

/** Up to this number of numbers, a loop copies faster than slice(). */
const maxLoop = 16;

/** A copy of `count` numbers of an array from `begin` on. */
export function copyOf<Numbers extends Uint32s | Float64s>(
  from: ArrayLike<number> & { slice(begin: number, end: number): Numbers }, begin: number, count: number,
  Made: new (length: number) => Numbers,
): Numbers {
  if (count > maxLoop) return from.slice(begin, begin + count);
  const copy = new Made(count);
  for (let i = 0; i < count; ++i) copy[i] = from[begin + i] as number;
  return copy;
}

export function putFloats(core: Core, numbers: ArrayLike<number>): number {
  const address = core.take(4 * numbers.length);
  core.f32.set(numbers, address / 4);
  return address;
}

export function putWords(core: Core, numbers: ArrayLike<number>): number {
  const address = core.take(4 * numbers.length);
  core.u32.set(numbers, address / 4);
  return address;
}

export function putDoubles(core: Core, numbers: ArrayLike<number>): number {
  if (numbers.length === 0) return 0;
  const address = core.take(8 * numbers.length);
  core.f64.set(numbers, address / 8);
  return address;
}

// ---- Filters: six words each, as the module has them ----

export const bytesOfFilter = 24;
const allBits = 0xffffffff;
const properties = ["category", "mask", "group", "isStatic"] as const;

export function checkFilters(filters: Filters, count: number, name = "filters"): void {
  checkOptions(filters, properties, name);
  for (const property of properties) {
    const values = filters[property];
    if (values === undefined) continue;
    if (countIn(values, 1, `${name}.${property}`) !== count)
      refuse(`the length of ${name}.${property}`, values.length, `${count}, one for each box`);
  }
}

/** A whole number of 32 bits, which may also be below 0, as JavaScript's bit operations give it. */
function whole(value: number, name: string, property: string, box: number | undefined): number {
  if (typeof value === "number" && (value >>> 0 === value || (value | 0) === value)) return value;
  return refuse(`${name}.${property}${box === undefined ? "" : `[${box}]`}`, value, "a whole number of at most 32 bits");
}

function writeFilter(words: Uint32Array, at: number, category: number, mask: number | undefined, group: number,
  isStatic: number | boolean, name: string, box?: number): void {
  words[at] = whole(category, name, "category", box);
  words[at + 1] = 0;
  words[at + 2] = mask === undefined ? allBits : whole(mask, name, "mask", box);
  words[at + 3] = mask === undefined ? allBits : 0;
  words[at + 4] = whole(group, name, "group", box);
  words[at + 5] = isStatic ? 1 : 0;
}

export function putFilters(core: Core, filters: Filters | undefined, count: number, name = "filters"): number {
  if (filters === undefined) return 0;
  const address = core.take(bytesOfFilter * Math.max(count, 1));
  const { category, mask, group, isStatic } = filters;
  for (let i = 0, at = address / 4; i < count; ++i, at += bytesOfFilter / 4)
    writeFilter(core.u32, at, category?.[i] ?? 1, mask?.[i], group?.[i] ?? 0, isStatic?.[i] ?? false, name, i);
  return address;
}

/** Checks the filter of one box. */
export function checkFilter(filter: Filter): void {
  checkOptions(filter, properties, "filter");
  for (const property of ["category", "mask", "group"] as const) {
    const value = filter[property];
    if (value !== undefined) whole(value, "filter", property, undefined);
  }
}

export function putFilter(core: Core, filter: Filter, name = "filter"): number {
  checkOptions(filter, properties, name);
  const address = core.take(bytesOfFilter);
  writeFilter(core.u32, address / 4, filter.category ?? 1, filter.mask, filter.group ?? 0, filter.isStatic ?? false,
    name);
  return address;
}

// Worlds.
import type {
  BoxArray, Dimension, Events, Filter, Filters, Float32s, Float64s, Handle, Handles, ResultOptions,
  TrackerOptions, World, WorldOptions,
} from "../types/types.d.ts";
import {
  type Given, bytesOf, bytesOfFilter, checkFilter, checkFilters, copyOf, countIn, countOf, countOfNumbers, put, putFilter,
  putFilters, putFloats,
} from "./boxes.ts";
import type { Core, Cores } from "./core.ts";
import { asksForView, checkOptions, refuse } from "./error.ts";
import { Kept } from "./kept.ts";
import { specOf } from "./tracker.ts";

/** A handle's lowest bits are its slot: module/handles.hpp. */
const maxSlots = 2 ** 24;

/** The handles, or other doubles, in the `number`-th array of the module's reply: a copy, or a view of its memory. */
export function handlesOf(core: Core, number: number, each: number, view: boolean): Float64s {
  const { u32, f64, reply } = core;
  const address = u32[reply + 2 * number] as number;
  const count = each * (u32[reply + 2 * number + 1] as number);
  return view ? new Float64Array(u32.buffer, address, count) : copyOf(f64, address / 8, count, Float64Array);
}

function countOfHandles(handles: Handles): number {
  if (typeof handles === "number") return 1;
  if (handles === undefined) refuse("handles", handles, "a handle, or an array of them");
  return countOfNumbers(handles, 1, "handles");
}

function putHandles(core: Core, handles: Handles, count: number): number {
  const address = core.take(8 * count);
  if (typeof handles === "number") core.f64[address / 8] = handles;
  else core.f64.set(handles, address / 8);
  return address;
}

/** The options as the library reads them, such as "world:relative_margin=0.1"; it has their table. */
function settingsOf(options: Readonly<Record<string, unknown>>): string {
  const settings = ["world"];
  for (const [name, value] of Object.entries(options)) {
    if (value === undefined) continue;
    if (!["number", "string", "boolean"].includes(typeof value)) refuse(name, value, "a number, a text, true or false");
    // The module gives each world handles that no other one takes.
    if (name === "firstGeneration") refuse(name, value, "none, as worlds choose it themselves");
    const text = typeof value === "boolean" ? (value ? "yes" : "no") : String(value);
    if (/[:=\n]/.test(text)) refuse(name, value, "a text without ':', '=' and line breaks");
    settings.push(`${name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`)}=${text}`);
  }
  return settings.join(":");
}

function make(cores: Cores, options: WorldOptions): { core: Core; address: number } {
  if (typeof options !== "object" || options === null) refuse("options", options, "an object");
  const { dimension, algorithm, ...others } = options;
  const { core, algorithm: spec } = specOf(cores, { dimension, algorithm } as TrackerOptions);
  const address = core.make(`${spec}\n${settingsOf(others)}`, core.exports.world_make);
  return { core, address };
}

export class KeptWorld extends Kept implements World {
  protected readonly core: Core;
  readonly dimension: Dimension;

  constructor(cores: Cores, options: WorldOptions = {}) {
    const { core, address } = make(cores, options);
    const { exports } = core;
    super(address, (world) => exports.world_free(world));
    this.core = core;
    this.dimension = core.dimension;
  }

  get size(): number {
    return this.core.exports.world_size(this.address) >>> 0;
  }

  add(boxes: BoxArray, options: { readonly filters?: Filters } = {}): Float64s {
    const { core } = this;
    const world = this.address;
    const count = countOf(core, boxes);
    checkOptions(options, ["filters"]);
    const { filters } = options;
    if (filters !== undefined) checkFilters(filters, count);
    core.stage(bytesOf(boxes as Given) + 8 * count + (filters === undefined ? 0 : bytesOfFilter * (count + 1)));
    const at = put(core, boxes as Given);
    const handles = core.take(8 * count);
    core.check(core.exports.world_add(world, at, count, putFilters(core, filters, count), handles));
    return core.f64.slice(handles / 8, handles / 8 + count);
  }

  addOne(box: BoxArray, options: { readonly filter?: Filter } = {}): Handle {
    const count = countOf(this.core, box, "box");
    if (count !== 1) refuse("the number of boxes", count, "1; add() takes several");
    checkOptions(options, ["filter"]);
    const { filter } = options;
    if (filter === undefined) return this.add(box)[0] as number;
    checkFilter(filter);
    const filters = Object.fromEntries(Object.entries(filter).map(([name, value]) => [name, [value]]));
    return this.add(box, { filters })[0] as number;
  }

  move(handles: Handles, boxes: BoxArray, options: { readonly velocities?: ArrayLike<number> } = {}): void {
    const { core } = this;
    const world = this.address;
    const given = countOfHandles(handles);
    const count = countOf(core, boxes);
    checkOptions(options, ["velocities"]);
    if (given !== count) refuse("the number of handles", given, `${count}, one for each box`);
    const { velocities } = options;
    if (velocities !== undefined && countIn(velocities, this.dimension, "velocities") !== count)
      refuse("the length of velocities", velocities.length, `${this.dimension * count}, ${this.dimension} for each box`);
    core.stage(bytesOf(boxes as Given) + 8 * count + (velocities === undefined ? 0 : 4 * velocities.length));
    core.check(core.exports.world_move(world, putHandles(core, handles, count), put(core, boxes as Given), count,
      velocities === undefined ? 0 : putFloats(core, velocities)));
  }

  remove(handles: Handles): void {
    const { core } = this;
    const world = this.address;
    const count = countOfHandles(handles);
    core.stage(8 * count);
    core.check(core.exports.world_remove(world, putHandles(core, handles, count), count));
  }

  update(options: ResultOptions = {}): Events<Float64s> {
    const { core } = this;
    const world = this.address;
    if (ArrayBuffer.isView(options) || Array.isArray(options) || options instanceof Kept)
      refuse("options", options, "an object: a world takes boxes by add() and move()");
    const view = viewAlone(options);
    core.check(core.exports.world_update(world));
    return { begun: handlesOf(core, 0, 1, view), ended: handlesOf(core, 1, 1, view) };
  }

  pairs(options: ResultOptions = {}): Float64s {
    const { core } = this;
    const world = this.address;
    const view = viewAlone(options);
    core.check(core.exports.world_pairs(world));
    return handlesOf(core, 0, 1, view);
  }

  has(handle: Handle): boolean {
    return this.core.exports.world_contains(this.address, checked(handle)) !== 0;
  }

  box(handle: Handle): Float32s {
    const { core } = this;
    core.check(core.exports.world_box(this.address, checked(handle)));
    return core.f32.slice(core.question, core.question + 2 * this.dimension);
  }

  slot(handle: Handle): number {
    return checked(handle) % maxSlots;
  }

  setFilter(handle: Handle, filter: Filter): void {
    const { core } = this;
    const world = this.address;
    core.stage(bytesOfFilter);
    core.check(core.exports.world_set_filter(world, checked(handle), putFilter(core, filter)));
  }

  ignore(a: Handle, b: Handle): void {
    this.core.check(this.core.exports.world_ignore(this.address, checked(a), checked(b), 1));
  }

  unignore(a: Handle, b: Handle): void {
    this.core.check(this.core.exports.world_ignore(this.address, checked(a), checked(b), 0));
  }
}

function viewAlone(options: ResultOptions): boolean {
  checkOptions(options, ["view"]);
  return asksForView(options);
}

function checked(handle: unknown): number {
  return typeof handle === "number" ? handle : refuse("a handle", handle, "a number that add() returned");
}

// Core: an instance of a module, its memory as arrays, and room in it for what a call takes. Cores: one a dimension.
import type { Dimension, Float32s, Float64s, Uint32s } from "../types/types.d.ts";
import { BroadsideError, checkDimension, errorOf, refuse } from "./error.ts";
import { importsOf } from "./imports.ts";

/** What the module exports: module/*.cpp. Pointers and sizes are numbers. */
export interface Exports {
  readonly memory: WebAssembly.Memory;
  _initialize(): void;
  reply(): number;
  question(): number;
  reserve(bytes: number): number;
  release(address: number): void;
  algorithm_name(number: number): void;
  version(): void;
  dimension(): Dimension;
  finder_make(spec: number, size: number): number;
  finder_free(finder: number): void;
  finder_find(
    finder: number, boxes: number, count: number, right: number, rightCount: number, filters: number,
    rightFilters: number, mode: number, within: number, rightWithin: number, different: number,
  ): number;
  tracker_make(spec: number, size: number, touching: boolean): number;
  tracker_free(tracker: number): void;
  tracker_update(
    tracker: number, boxes: number, count: number, changed: number, changedCount: number, filters: number,
  ): number;
  world_make(texts: number, size: number): number;
  world_free(world: number): void;
  world_add(world: number, boxes: number, count: number, filters: number, handles: number): number;
  world_move(world: number, handles: number, boxes: number, count: number, velocities: number): number;
  world_remove(world: number, handles: number, count: number): number;
  world_update(world: number): number;
  world_pairs(world: number): number;
  world_box(world: number, handle: number): number;
  world_size(world: number): number;
  world_contains(world: number, handle: number): number;
  world_set_filter(world: number, handle: number, filter: number): number;
  world_ignore(world: number, a: number, b: number, ignores: number): number;
}

/** How an array of numbers begins that the module is to read: aligned for all of them. */
const alignment = 16;

/** Without bit operations, which know no numbers from 2^31 on. */
const aligned = (bytes: number) => Math.ceil(bytes / alignment) * alignment;

export class Core {
  readonly exports: Exports;
  f32!: Float32s;
  f64!: Float64s;
  u32!: Uint32s;
  readonly reply: number;     // in elements of u32
  readonly question: number;  // in elements of f32
  readonly algorithms: readonly string[];
  readonly dimension: Dimension;
  #staging = 0;
  #room = 0;
  #used = 0;

  static async make(wasm: WebAssembly.Module): Promise<Core> {
    const instance = await WebAssembly.instantiate(wasm, importsOf(wasm));
    const exports = instance.exports as unknown as Exports;
    exports._initialize();
    return new Core(exports);
  }

  private constructor(exports: Exports) {
    this.exports = exports;
    this.lookAgain();
    this.reply = exports.reply() >> 2;
    this.question = exports.question() >> 2;
    this.dimension = exports.dimension();
    this.algorithms = [...this.#algorithms()];
  }

  *#algorithms(): Generator<string> {
    for (let number = 0; ; ++number) {
      this.exports.algorithm_name(number);
      const name = this.text(0);
      if (name === "") return;
      yield name;
    }
  }

  /**
   * The algorithm for this many boxes. The smaller module has no `auto`, and chooses by this rule: comparing all of few
   * boxes costs less than sorting them into cells.
   */
  algorithmFor(count: number, named = "auto"): string {
    if (named !== "auto" || this.algorithms.includes("auto")) return named;
    return count <= 64 ? "brute_force" : "grid";
  }

  /** To be called before memory is read or written: where it has grown, the arrays have lost it. */
  refresh(): void {
    if (this.u32.length === 0) this.lookAgain();
  }

  lookAgain(): void {
    const { buffer } = this.exports.memory;
    this.f32 = new Float32Array(buffer);
    this.f64 = new Float64Array(buffer);
    this.u32 = new Uint32Array(buffer);
  }

  /** Gives `bytes` of memory until released. */
  reserve(bytes: number): number {
    const address = bytes < 2 ** 32 ? this.exports.reserve(bytes) >>> 0 : 0;
    if (address === 0) throw new BroadsideError("OUT_OF_MEMORY", `no memory for ${bytes} bytes`);
    this.refresh();
    return address;
  }

  /**
   * Begins the arguments of a call, which take up to `bytes`. Each further `take` gives the address of an array of
   * them.
   */
  stage(bytes: number): void {
    this.#used = 0;
    const needed = bytes + 8 * alignment;
    if (needed > this.#room) {
      // What there was is given back first, so that memory grows by the difference.
      const room = aligned(Math.max(needed, 1.5 * this.#room, 4096));
      this.exports.release(this.#staging);
      this.#staging = this.#room = 0;
      this.#staging = this.reserve(room);
      this.#room = room;
    }
    this.refresh();
  }

  take(bytes: number): number {
    const address = this.#staging + this.#used;
    this.#used += aligned(bytes);
    return address;
  }

  /** Throws what a call has failed with. */
  check(status: number): void {
    this.refresh();
    if (status !== 0) throw this.#error(status);
  }

  #error(status: number): BroadsideError {
    const { u32, reply } = this;
    return errorOf(status, this.text(1), u32[reply] as number);
  }

  /** A text of the reply: the `number`-th array of it. */
  text(number: number): string {
    this.refresh();
    const { u32, reply } = this;
    const begin = u32[reply + 2 * number] as number;
    return new TextDecoder().decode(new Uint8Array(u32.buffer, begin, u32[reply + 2 * number + 1]));
  }

  /** Makes an object by a call that takes a spec. Returns its address. */
  make(spec: string, call: (spec: number, size: number) => number): number {
    const bytes = new TextEncoder().encode(spec);
    this.stage(bytes.length);
    const address = this.take(bytes.length);
    new Uint8Array(this.u32.buffer).set(bytes, address);
    this.check(call(address, bytes.length));
    return this.u32[this.reply] as number;
  }
}

/** The modules that were loaded: of 2D, of 3D, or one of each. */
export class Cores {
  /** The one that calls mean which name no dimension: that of 2D, where it is there. */
  readonly main: Core;
  readonly plane: Core | undefined;
  readonly space: Core | undefined;

  static async make(wasms: readonly WebAssembly.Module[]): Promise<Cores> {
    return new Cores(await Promise.all(wasms.map((wasm) => Core.make(wasm))));
  }

  private constructor(cores: readonly Core[]) {
    for (const core of cores) {
      if (this.#ofDimension(core.dimension) !== undefined)
        refuse(`the number of modules of ${core.dimension}D`, 2, "1");
      if (core.dimension === 2) this.plane = core;
      else this.space = core;
    }
    this.main = this.plane ?? this.space ?? refuse("the number of modules", 0, "1 for each dimension");
  }

  #ofDimension(dimension: Dimension): Core | undefined {
    return dimension === 2 ? this.plane : this.space;
  }

  of(dimension: Dimension | undefined): Core {
    if (dimension === undefined) return this.main;
    checkDimension(dimension);
    return this.#ofDimension(dimension) ??
      refuse("dimension", dimension, `${this.main.dimension}, the one that was loaded`);
  }
}

// A module of the engine (engine.cpp): its memory, its texts and its functions' errors.
import { compile } from "../../../../bindings/wasm/src/compile.ts";
import { importsOf } from "../../../../bindings/wasm/src/imports.ts";

/** The exports of engine.cpp. */
interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  input_boxes(count: number): number;
  input_text(size: number): number;
  answer_text(): number;
  answer_text_size(): number;
  answer_pairs(): number;
  answer_pair_count(): number;
  answer_more_pairs(): number;
  answer_more_pair_count(): number;
  answer_boxes_begin(): number;
  answer_boxes_size(): number;
  answer_numbers(): number;
  answer_number_count(): number;
  list_algorithms(): number;
  find_pairs(count: number, dimension: number): number;
  explain(dimension: number): number;
  lay_out(count: number, dimension: number, follows: number): number;
  start_tracker(dimension: number): number;
  update_tracker(tracker: number, count: number): number;
  free_tracker(tracker: number): void;
  list_scenes(): number;
  make_boxes(count: number, seed: number, dimension: number): number;
  /** Missing in the observing module. */
  read_file(): number;
}

export class EngineModule {
  readonly #exports: Exports;

  private constructor(exports: Exports) {
    this.#exports = exports;
    exports._initialize();
  }

  static async load(bytes: BufferSource): Promise<EngineModule> {
    const module = await compile(bytes);
    const instance = await WebAssembly.instantiate(module, importsOf(module));
    return new EngineModule(instance.exports as unknown as Exports);
  }

  putText(text: string): void {
    this.putBytes(new TextEncoder().encode(text));
  }

  putBytes(bytes: Uint8Array): void {
    const at = this.#exports.input_text(bytes.length);
    new Uint8Array(this.#exports.memory.buffer, at, bytes.length).set(bytes);
  }

  /** Returns the number of boxes. */
  putBoxes(boxes: Float32Array, dimension: 2 | 3): number {
    if (dimension !== 2 && dimension !== 3) throw new Error(`dimension ${dimension}; expected 2 or 3`);
    if (boxes.length % (2 * dimension) !== 0)
      throw new Error(`${boxes.length} numbers of boxes; expected a multiple of ${2 * dimension}, in ${dimension}D`);
    const at = this.#exports.input_boxes(boxes.length);
    new Float32Array(this.#exports.memory.buffer, at, boxes.length).set(boxes);
    return boxes.length / (2 * dimension);
  }

  /**
   * Calls a function. Returns the milliseconds that all runs took, by one reading of the clock
   * before and one after; throws the library's message if it fails.
   */
  call(body: (exports: Exports) => number, runs = 1): number {
    let failed = 0;
    const begin = performance.now();
    for (let run = 0; run < runs && failed === 0; ++run) failed = body(this.#exports);
    const milliseconds = performance.now() - begin;
    if (failed !== 0) throw new Error(this.text());
    return milliseconds;
  }

  freeTracker(tracker: number): void {
    this.#exports.free_tracker(tracker);
  }

  // Copies the answers: the next call overwrites them, and growing memory detaches views of it.

  text(): string {
    const { memory, answer_text, answer_text_size } = this.#exports;
    return new TextDecoder().decode(new Uint8Array(memory.buffer, answer_text(), answer_text_size()));
  }

  pairs(): Uint32Array<ArrayBuffer> {
    const { memory, answer_pairs, answer_pair_count } = this.#exports;
    return new Uint32Array(memory.buffer, answer_pairs(), 2 * answer_pair_count()).slice();
  }

  /** Tests of an observed search; pairs that ended with a frame. */
  morePairs(): Uint32Array<ArrayBuffer> {
    const { memory, answer_more_pairs, answer_more_pair_count } = this.#exports;
    return new Uint32Array(memory.buffer, answer_more_pairs(), 2 * answer_more_pair_count()).slice();
  }

  boxes(): Float32Array<ArrayBuffer> {
    const { memory, answer_boxes_begin, answer_boxes_size } = this.#exports;
    return new Float32Array(memory.buffer, answer_boxes_begin(), answer_boxes_size()).slice();
  }

  numbers(): number[] {
    const { memory, answer_numbers, answer_number_count } = this.#exports;
    return [...new Float64Array(memory.buffer, answer_numbers(), answer_number_count())];
  }
}

import type { Broadside } from "./types.js";

export * from "./types.js";

/** The module of one of the package's `.wasm` files, which you bring along. */
export declare function load(options: ExternalOptions): Promise<Broadside>;

export interface ExternalOptions {
  /**
   * `broadside/broadside.wasm`, or `broadside/broadside-scalar.wasm` where there is no SIMD: compiled, as bytes, as
   * what `fetch` gives, or as the address to fetch.
   */
  readonly wasm: WebAssembly.Module | BufferSource | Response | PromiseLike<Response> | URL | string;
}

/** Whether WebAssembly has SIMD here. */
export declare function supportsSimd(): boolean;

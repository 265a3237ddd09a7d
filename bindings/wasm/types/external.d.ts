import type { Broadside } from "./types.js";

export * from "./types.js";

/** Makes the library from the package's `.wasm` files, which you provide. */
export declare function load(options: ExternalOptions): Promise<Broadside>;

/** A module: compiled, as bytes, as the result of `fetch`, or as an address to fetch. */
export type ModuleSource =
  WebAssembly.Module | BufferSource | Response | PromiseLike<WebAssembly.Module | BufferSource | Response> | URL | string;

export interface ExternalOptions {
  /** `broadside/broadside-2d.wasm`, `broadside/broadside-3d.wasm`, or an array of both. */
  readonly wasm: ModuleSource | readonly ModuleSource[];
}

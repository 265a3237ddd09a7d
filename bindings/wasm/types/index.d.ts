import type { Broadside, LoadOptions } from "./types.js";

export * from "./types.js";

/** Loads the module with everything. Each call makes a new instance, with memory of its own. */
export declare function load(options?: LoadOptions): Promise<Broadside>;

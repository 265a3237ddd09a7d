import type { Broadside, LoadOptions } from "./types.js";

export * from "./types.js";

/** The module with everything. Each call makes a new one, with memory of its own. */
export declare function load(options?: LoadOptions): Promise<Broadside>;

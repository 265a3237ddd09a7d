import type { LoadOptions, PairFinding } from "./types.js";

export * from "./types.js";

/** Loads the smaller module: pairs, trackers and worlds, without queries. */
export declare function load(options?: LoadOptions): Promise<PairFinding>;

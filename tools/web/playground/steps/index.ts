// The draft's four algorithms step by step, mended as in paper/listings (a test verifies that they
// agree), and a join of a bounding volume hierarchy.
import type { StepAlgorithm, StepOptions, Steps } from "../engine/types.ts";
import { unpack } from "./boxes.ts";
import { bruteForceSteps } from "./brute_force.ts";
import { bvhSteps } from "./bvh.ts";
import { gridSteps } from "./grid.ts";
import { quadtreeSteps } from "./quadtree.ts";
import { sweepSteps } from "./sweep_and_prune.ts";

export type { Step, StepAlgorithm, StepOptions, Steps, StepState } from "../engine/types.ts";

/**
 * Every step of a search of these boxes, in 2D. Throws if there are too many boxes to step through.
 */
export function steps(algorithm: StepAlgorithm, boxes: Float32Array, options: StepOptions = {}): Steps {
  const unpacked = unpack(boxes);
  switch (algorithm) {
    case "brute_force": return bruteForceSteps(unpacked);
    case "grid": return gridSteps(unpacked, options);
    case "sweep_and_prune": return sweepSteps(unpacked);
    case "quadtree": return quadtreeSteps(unpacked, options);
    case "bvh": return bvhSteps(unpacked, options);
  }
}

// Boxes for the tests, and their overlaps by definition.
import { randomAt } from "../scene/random.ts";

export interface BoxKind {
  dimension: 2 | 3;
  places: number;      // minima are whole numbers below this one, so that boxes touch and coincide
  maxExtent: number;  // in whole numbers; 0: points
}

export function randomBoxes(seed: number, count: number, { dimension, places, maxExtent }: BoxKind):
    Float32Array<ArrayBuffer> {
  const boxes = new Float32Array(2 * dimension * count);
  for (let box = 0; box < count; ++box) {
    for (let axis = 0; axis < dimension; ++axis) {
      const at = 2 * dimension * box + axis;
      boxes[at] = Math.floor(places * randomAt(seed, box, axis));
      boxes[at + dimension] = boxes[at]! + Math.floor((maxExtent + 1) * randomAt(seed, box, 3 + axis));
    }
  }
  return boxes;
}

/** Every pair of overlapping boxes, sorted. */
export function overlappingPairs(boxes: Float32Array, dimension: 2 | 3): string[] {
  const pairs: string[] = [];
  const stride = 2 * dimension;
  const count = boxes.length / stride;
  for (let a = 0; a < count; ++a) {
    for (let b = a + 1; b < count; ++b) {
      let overlap = true;
      for (let axis = 0; axis < dimension && overlap; ++axis) {
        overlap = boxes[stride * a + axis]! <= boxes[stride * b + dimension + axis]! &&
          boxes[stride * b + axis]! <= boxes[stride * a + dimension + axis]!;
      }
      if (overlap) pairs.push(`${a}-${b}`);
    }
  }
  return pairs.sort();
}

/** Pairs as [a0, b0, ...], each with its lower id first. */
export function named(pairs: Uint32Array): string[] {
  const names: string[] = [];
  for (let at = 0; at < pairs.length; at += 2)
    names.push(`${Math.min(pairs[at]!, pairs[at + 1]!)}-${Math.max(pairs[at]!, pairs[at + 1]!)}`);
  return names;
}

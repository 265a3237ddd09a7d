// Few boxes, compared in JavaScript: a call of the module would cost more than all of their comparisons.
//
// The pairs, and their order, are those of the module's brute force. Where a box is invalid or absent, or there are
// numbers left over, the module is to look at them: this is told by -1, else how many ids were written. Functions, for
// they are called for one box as well: a method of an object with state of its own costs as much as a comparison.
import type { Dimension } from "../types/types.d.ts";

/** Up to how many boxes this is the faster way; measured by tools/bench/web/compare.mjs. */
export function maxFew(dimension: Dimension): number {
  return dimension === 2 ? 44 : 42;
}

export function fewPairs2(boxes: Float32Array, pairs: Uint32Array): number {
  const { length } = boxes;
  let found = 0;
  for (let a = 0; a < length; a += 4) {
    const minX = boxes[a] as number, minY = boxes[a + 1] as number;
    const maxX = boxes[a + 2] as number, maxY = boxes[a + 3] as number;
    if (!(minX <= maxX && minY <= maxY)) return -1;
    for (let b = a + 4; b < length; b += 4) {
      if ((boxes[b] as number) <= maxX && minX <= (boxes[b + 2] as number) &&
          (boxes[b + 1] as number) <= maxY && minY <= (boxes[b + 3] as number)) {
        pairs[found++] = a >> 2;
        pairs[found++] = b >> 2;
      }
    }
  }
  return found;
}

export function fewPairs3(boxes: Float32Array, pairs: Uint32Array): number {
  const { length } = boxes;
  let found = 0;
  for (let a = 0, first = 0; a < length; a += 6, ++first) {
    const minX = boxes[a] as number, minY = boxes[a + 1] as number, minZ = boxes[a + 2] as number;
    const maxX = boxes[a + 3] as number, maxY = boxes[a + 4] as number, maxZ = boxes[a + 5] as number;
    if (!(minX <= maxX && minY <= maxY && minZ <= maxZ)) return -1;
    for (let b = a + 6, second = first + 1; b < length; b += 6, ++second) {
      if ((boxes[b] as number) <= maxX && minX <= (boxes[b + 3] as number) &&
          (boxes[b + 1] as number) <= maxY && minY <= (boxes[b + 4] as number) &&
          (boxes[b + 2] as number) <= maxZ && minZ <= (boxes[b + 5] as number)) {
        pairs[found++] = first;
        pairs[found++] = second;
      }
    }
  }
  return found;
}

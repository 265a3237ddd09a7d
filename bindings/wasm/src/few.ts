// Few boxes, compared in JavaScript: a call of the module would cost more than all of their comparisons.
//
// The pairs, and their order, are those of the module's brute force. Where a box is invalid or absent, the module is
// to look at it.

/** Up to how many boxes this is the faster way; measured by bench/web/compare.mjs. */
export const few2 = 24;
export const few3 = 20;

const most = Math.max(few2, few3);
const pairs = new Uint32Array(most * (most - 1));
/** By the number of ids in it. Views are made once: making one costs as much as comparing ten boxes. */
const views: Uint32Array[] = [];

function firstOf(count: number): Uint32Array {
  return (views[count] ??= pairs.subarray(0, count));
}

/** The pairs of up to `few2` boxes, or undefined if one is not as it should be. */
export function fewPairs2(boxes: Float32Array): Uint32Array | undefined {
  const { length } = boxes;
  let found = 0;
  for (let a = 0; a < length; a += 4) {
    const minX = boxes[a] as number, minY = boxes[a + 1] as number;
    const maxX = boxes[a + 2] as number, maxY = boxes[a + 3] as number;
    if (!(minX <= maxX && minY <= maxY)) return undefined;
    for (let b = a + 4; b < length; b += 4) {
      if ((boxes[b] as number) <= maxX && minX <= (boxes[b + 2] as number) &&
          (boxes[b + 1] as number) <= maxY && minY <= (boxes[b + 3] as number)) {
        pairs[found++] = a >> 2;
        pairs[found++] = b >> 2;
      }
    }
  }
  return firstOf(found);
}

/** The same for up to `few3` boxes of space. */
export function fewPairs3(boxes: Float32Array): Uint32Array | undefined {
  const { length } = boxes;
  let found = 0;
  for (let a = 0, first = 0; a < length; a += 6, ++first) {
    const minX = boxes[a] as number, minY = boxes[a + 1] as number, minZ = boxes[a + 2] as number;
    const maxX = boxes[a + 3] as number, maxY = boxes[a + 4] as number, maxZ = boxes[a + 5] as number;
    if (!(minX <= maxX && minY <= maxY && minZ <= maxZ)) return undefined;
    for (let b = a + 6, second = first + 1; b < length; b += 6, ++second) {
      if ((boxes[b] as number) <= maxX && minX <= (boxes[b + 3] as number) &&
          (boxes[b + 1] as number) <= maxY && minY <= (boxes[b + 4] as number) &&
          (boxes[b + 2] as number) <= maxZ && minZ <= (boxes[b + 5] as number)) {
        pairs[found++] = first;
        pairs[found++] = second;
      }
    }
  }
  return firstOf(found);
}

// Few boxes, compared in JavaScript: a call of the module would cost more than all of their comparisons.
//
// The pairs, and their order, are those of the module's brute force. Where a box is invalid or absent, the module is
// to look at it.
import type { Dimension } from "../types/types.d.ts";

/** Views of up to so many ids are kept: making one costs as much as comparing ten boxes. */
const mostKept = 256;

export class Few {
  /** Up to how many boxes this is the faster way; measured by bench/web/compare.mjs. */
  readonly most: number;
  readonly #dimension: Dimension;
  #pairs: Uint32Array = new Uint32Array(2256);  // enough for 48 boxes
  readonly #views: Uint32Array[] = [];

  constructor(simd: boolean, dimension: Dimension) {
    this.most = simd ? (dimension === 2 ? 44 : 42) : 300;
    this.#dimension = dimension;
  }

  /** The pairs of up to `most` boxes, or undefined if these are not as they should be. */
  pairs(boxes: Float32Array): Uint32Array | undefined {
    if (this.#dimension === 2) return boxes.length % 4 === 0 ? this.#pairs2(boxes) : undefined;
    return boxes.length % 6 === 0 ? this.#pairs3(boxes) : undefined;
  }

  #pairs2(boxes: Float32Array): Uint32Array | undefined {
    const { length } = boxes;
    const pairs = this.#room(length / 4);
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
    return this.#first(found);
  }

  #pairs3(boxes: Float32Array): Uint32Array | undefined {
    const { length } = boxes;
    const pairs = this.#room(length / 6);
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
    return this.#first(found);
  }

  /** Room for all pairs of the largest number of boxes that is handled here. */
  #room(boxes: number): Uint32Array {
    const ids = boxes * (boxes - 1);
    if (ids > this.#pairs.length) {
      this.#pairs = new Uint32Array(ids);
      this.#views.length = 0;
    }
    return this.#pairs;
  }

  #first(count: number): Uint32Array {
    if (count >= mostKept) return this.#pairs.subarray(0, count);
    return (this.#views[count] ??= this.#pairs.subarray(0, count));
  }
}

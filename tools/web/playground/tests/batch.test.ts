// Which boxes are drawn as points, which as shapes, and which are left out.
import assert from "node:assert/strict";
import { describe, test } from "node:test";

import { Batch, rowTexels, type Lens } from "../draw/batch.ts";
import { flatCamera, flatMatrix, solidMatrix, defaultView, type View } from "../draw/camera.ts";

const size = { width: 400, height: 300 };
const pixels = [200, 150] as const;

function flatLens(bounds: number[], view: View = defaultView): Lens {
  return { matrix: flatMatrix(flatCamera(bounds, size, view), size), pixels, maxPoint: 8, bounds };
}

function solidLens(bounds: number[], view: View = defaultView): Lens {
  return { matrix: solidMatrix(bounds, size, view), pixels, maxPoint: 8, bounds };
}

function seen(dimension: 2 | 3, boxes: number[][], lens: Lens): { points: number[]; shapes: number[] } {
  const batch = new Batch(dimension);
  // Marks identify the boxes.
  batch.set(Float32Array.from(boxes.flat()), Uint8Array.from(boxes.keys()), lens);
  for (let at = 0; at < batch.count; ++at) {
    const copy = [...batch.boxes.subarray(2 * dimension * at, 2 * dimension * (at + 1))];
    boxes[batch.marks[at]!]!.map(Math.fround).forEach((one, side) => {
      // What is cut stays beyond the picture, on its side of it.
      const axis = side % dimension;
      const [size, middle] = [lens.bounds[axis + dimension]! - lens.bounds[axis]!, (lens.bounds[axis + dimension]! + lens.bounds[axis]!) / 2];
      const cut = Math.sign(one - middle) * (copy[side]! - middle);
      assert.ok(copy[side] === one || (cut > size && Number.isFinite(cut) && cut < Math.abs(one - middle)),
        `${copy.join()} of ${boxes[batch.marks[at]!]!.join()}`);
    });
  }
  return {
    points: [...batch.marks.subarray(0, batch.points)],
    shapes: [...batch.marks.subarray(batch.points, batch.count)],
  };
}

describe("a batch", () => {
  // 400 by 300 pixels show 100 by 75, at 3.84 pixels each.
  const flat = [0, 0, 100, 75];

  test("draws boxes of a few pixels as points, others as shapes, in their order", () => {
    assert.deepEqual(seen(2, [[1, 1, 3, 3], [10, 10, 30, 11], [5, 5, 5, 5], [20, 10, 21, 30], [6, 6, 8, 8]], flatLens(flat)),
      { points: [0, 2, 4], shapes: [1, 3] });
  });

  test("draws more as shapes where the visitor comes nearer", () => {
    const boxes = [[48, 35, 50, 37], [52, 35, 54, 37]];
    assert.deepEqual(seen(2, boxes, flatLens(flat)), { points: [0, 1], shapes: [] });
    assert.deepEqual(seen(2, boxes, flatLens(flat, { ...defaultView, zoom: 4 })), { points: [], shapes: [0, 1] });
  });

  test("leaves out what is absent and what is out of sight, and keeps what reaches into the picture", () => {
    const boxes = [
      [Infinity, Infinity, -Infinity, -Infinity], [-90, 10, -80, 20], [10, 400, 20, 410], [-1000, 10, 0, 11],
      [-Infinity, 10, Infinity, 20], [300, 0, 301, 1], [0, 0, Infinity, 1], [0, 0, Infinity, Infinity],
    ];
    for (const up of [false, true])
      assert.deepEqual(seen(2, boxes, flatLens(flat, { ...defaultView, up })), { points: [], shapes: [3, 4, 6, 7] });
  });

  test("does so in 3D", () => {
    const boxes = [
      [50, 50, 50, 50.5, 50.5, 50.5], [0, 0, 0, 90, 90, 90], [5000, 0, 0, 5001, 1, 1],
      [-Infinity, 0, 0, Infinity, 1, 1], [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity],
      [-1e7, -1e7, -1e7, 1e7, 1e7, 1e7],
    ];
    assert.deepEqual(seen(3, boxes, solidLens([0, 0, 0, 100, 100, 100])), { points: [0], shapes: [1, 3, 5] });
  });

  test("has whole rows of texels for any number of boxes, and forgets what it had", () => {
    const batch = new Batch(2);
    for (const count of [0, 1, rowTexels, 3 * rowTexels + 1, 2]) {
      batch.set(new Float32Array(4 * count).fill(1), undefined, flatLens(flat));
      assert.equal(batch.count, count);
      assert.equal(batch.marks.length % rowTexels, 0);
      assert.equal(batch.boxes.length, 4 * batch.marks.length);
      assert.ok(batch.marks.length >= count);
    }
  });
});

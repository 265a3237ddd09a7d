// Queries equal the definition, of an index and of a world.
import assert from "node:assert/strict";
import { test } from "node:test";

import { type Dimension, type Index, load } from "broadside";

import { at, overlap, random, scenes } from "./support.ts";

const broadside = await load();

/** The square of a box's distance, as the library defines it: sums of doubles. */
function distanceSquared(point: ArrayLike<number>, boxes: Float32Array, i: number, dimension: Dimension): number {
  let sum = 0;
  for (let axis = 0; axis < dimension; ++axis) {
    const min = at(boxes, 2 * dimension * i + axis);
    const max = at(boxes, 2 * dimension * i + dimension + axis);
    const outside = Math.max(min - at(point, axis), at(point, axis) - max, 0);
    sum += outside * outside;
  }
  return sum;
}

/** The parameter at which a ray enters a box, or undefined. */
function enters(origin: ArrayLike<number>, direction: ArrayLike<number>, boxes: Float32Array, i: number,
  dimension: Dimension): number | undefined {
  let enter = 0;
  let leave = Infinity;
  for (let axis = 0; axis < dimension; ++axis) {
    const before = Math.fround(at(boxes, 2 * dimension * i + axis) - at(origin, axis));
    const behind = Math.fround(at(boxes, 2 * dimension * i + dimension + axis) - at(origin, axis));
    const along = at(direction, axis);
    if (along === 0) {
      if (before > 0 || behind < 0) return undefined;
      continue;
    }
    enter = Math.max(enter, Math.fround((along > 0 ? before : behind) / along));
    leave = Math.min(leave, Math.fround((along > 0 ? behind : before) / along));
  }
  return enter <= leave ? enter : undefined;
}

for (const dimension of [2, 3] as const) {
  for (const scene of scenes.slice(0, 4)) {
    test(`queries of boxes ${scene.name}, ${dimension}D`, () => {
      const rng = random(4);
      const count = 700;
      const boxes = scene.boxes(count, dimension, 2);
      const index = broadside.index(boxes, { dimension });
      const world = broadside.world({ dimension });
      const handles = world.add(boxes);
      const places = Array.from({ length: count }, (_, i) => i);
      for (let question = 0; question < 40; ++question) {
        const point = Float32Array.from({ length: dimension }, () => 100 * rng());
        const box = Float32Array.from([...point, ...point.map((x) => x + 10 * rng())]);
        const overlapping = places.filter((i) => overlap(boxes, i, box, 0, dimension));
        assert.deepEqual([...index.overlapping(box)].sort((a, b) => a - b), overlapping);
        assert.deepEqual(new Set(world.overlapping(box)), new Set(overlapping.map((i) => at(handles, i))));

        const distances = places.map((i) => distanceSquared(point, boxes, i, dimension));
        const nearest = [...places].sort((a, b) => at(distances, a) - at(distances, b) || a - b).slice(0, 5);
        const neighbours = index.nearest(point, 5);
        assert.deepEqual([...neighbours.ids], nearest);
        assert.deepEqual([...neighbours.distances], nearest.map((i) => Math.sqrt(at(distances, i))));
        assert.deepEqual([...world.nearest(point, 5).ids], nearest.map((i) => at(handles, i)));

        const rows = index.nearestOfEach([...point, ...point, ...point, ...point], 5, { except: [at(nearest, 0), 99999] });
        assert.deepEqual([...rows.ids.subarray(0, 4)], nearest.slice(1));
        assert.deepEqual([...rows.ids.subarray(5)], nearest);
        assert.deepEqual(rows.distances.slice(5), neighbours.distances);

        const direction = Float32Array.from({ length: dimension }, () => 2 * rng() - 1);
        let first: { id: number; t: number } | undefined;
        for (const i of places) {
          const t = enters(point, direction, boxes, i, dimension);
          if (t !== undefined && (first === undefined || t < first.t)) first = { id: i, t };
        }
        assert.deepEqual(index.firstHit(point, direction), first);
        assert.deepEqual(world.firstHit(point, direction), first && { ...first, id: at(handles, first.id) });
      }
      index.free();
      world.free();
    });
  }
}

test("options of queries", async () => {
  const broadside = await load();
  const boxes = [0, 0, 1, 1, 2, 0, 3, 1, 4, 0, 5, 1];
  const index: Index = broadside.index(boxes, { filters: { category: [1, 2, 4] } });
  const all = [-10, -10, 10, 10];
  assert.deepEqual([...index.overlapping(all, { except: 1 })].sort(), [0, 2]);
  assert.deepEqual([...index.overlapping(all, { filter: { mask: 6 } })].sort(), [1, 2]);
  assert.deepEqual([...index.nearest([-1, 0], 3, { maxDistance: 3 }).ids], [0, 1]);
  assert.deepEqual([...index.nearest([-1, 0], 0).ids], []);
  assert.deepEqual([...index.nearest([3, 3, 4, 5], 3).distances], [2, 2, Math.sqrt(8)]);
  const rows = index.nearestOfEach(boxes, 1, { except: [0, 1, 2], maxDistance: 1 });
  assert.deepEqual([[...rows.ids], [...rows.distances]], [[1, 0, 1], [1, 1, 1]]);
  assert.deepEqual([...index.nearestOfEach(boxes, 2, { maxDistance: 0 }).ids], [0, 2 ** 32 - 1, 1, 2 ** 32 - 1, 2, 2 ** 32 - 1]);
  assert.deepEqual([...index.nearestOfEach([-1, 0, -1, 0], 1, { filters: { mask: [4] } }).ids], [2]);
  assert.equal(index.firstHit([-1, 0], [1, 0], { tMax: 0.5 }), undefined);
  assert.deepEqual(index.firstHit([-1, 0], [1, 0], { except: 0 }), { id: 1, t: 3 });
  assert.deepEqual(index.firstHit([-1, 1.5], [1, 0], { halfExtent: [0.5, 0.5] }), { id: 0, t: 0.5 });
  assert.deepEqual(index.firstHit([-1, 1.5], [1, 0], { halfExtent: [1, 0.5] }), { id: 0, t: 0 });
  assert.deepEqual(index.firstHit([-1, 1.5], [1, 0], { halfExtent: [1, 0.5], entering: true }), { id: 0, t: 0 });
  assert.equal(index.firstHit([-1, 1.5], [-1, 0], { halfExtent: [1, 0.5], entering: true }), undefined);
  assert.throws(() => index.firstHit([0, 0], [1, 0], { entering: 1 } as object),
    { code: "INVALID_ARGUMENT", message: "entering is 1; expected true or false" });
  index.update([9, 9, 9, 9]);
  assert.deepEqual([...index.overlapping(all)], [0]);
  index.update([8, 8, 8, 8, 7, 7, 7, 7], { changed: [0] });
  assert.deepEqual([...index.nearest([0, 0], 5).ids], [1, 0]);

  const world = broadside.world();
  const handles = world.add(boxes);
  assert.deepEqual([...world.overlapping(all, { except: at(handles, 0) })].sort(), [...handles.subarray(1)].sort());
  world.move(at(handles, 1), [20, 0, 21, 1]);
  assert.deepEqual(world.firstHit([1.5, 0.5], [1, 0]), { id: at(handles, 2), t: 2.5 });
});

test("questions that cannot be", async () => {
  const index = (await load()).index([0, 0, 1, 1]);
  assert.throws(() => index.overlapping([0, 0, NaN, 1]), { code: "INVALID_QUERY" });
  assert.throws(() => index.nearest([NaN, 0], 1), { code: "INVALID_QUERY" });
  assert.throws(() => index.firstHit([0, 0], [Infinity, 0]),
    { code: "INVALID_QUERY", message: "a cast's direction is inf, 0; expected finite numbers" });
  assert.throws(() => index.overlapping([0, 0, 1]),
    { code: "INVALID_ARGUMENT", message: "the length of box is 3; expected 4, with a point given as minima and as maxima" });
  assert.throws(() => index.nearest([0, 0], -1), { code: "INVALID_ARGUMENT" });
  assert.throws(() => index.nearest([0, 0], 1, { maxDistance: -1 }), { code: "INVALID_ARGUMENT" });
  assert.throws(() => index.nearest([0, 0, 1], 1), { code: "INVALID_ARGUMENT", message: "the length of point is 3; expected 2" });
  assert.throws(() => index.nearestOfEach([0, 0, 1, 1], 0),
    { code: "INVALID_ARGUMENT", message: "k is 0; expected a whole number of at least 1" });
  assert.throws(() => index.nearestOfEach([0, 0, 1, NaN], 1), { code: "INVALID_QUERY" });
  assert.throws(() => index.nearestOfEach([0, 0, 1, 1], 1, { except: [1, 2] }), { code: "INVALID_QUERY" });
  assert.throws(() => index.nearest([0, 0], 1, { tMax: 1 } as object), { code: "INVALID_ARGUMENT" });
});

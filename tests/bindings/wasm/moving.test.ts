// Trackers and worlds tell which pairs begin and end, against a model that finds all pairs in each frame.
import assert from "node:assert/strict";
import { test } from "node:test";

import { type Dimension, type Handle, load } from "broadside";

import { at, pairsByDefinition, random, scenes, without } from "./support.ts";

const broadside = await load();
const uniform = scenes[0] as (typeof scenes)[0];

/** Moves a share of the boxes, and returns which. */
function move(boxes: Float32Array, dimension: Dimension, share: number, rng: () => number): number[] {
  const moved: number[] = [];
  for (let i = 0; i < boxes.length / (2 * dimension); ++i) {
    if (rng() >= share) continue;
    moved.push(i);
    for (let axis = 0; axis < dimension; ++axis) {
      const distance = 4 * rng() - 2;
      const first = 2 * dimension * i + axis;
      boxes[first] = at(boxes, first) + distance;
      boxes[first + dimension] = at(boxes, first + dimension) + distance;
    }
  }
  return moved;
}

for (const dimension of [2, 3] as const) {
  for (const algorithm of broadside.algorithms()) {
    test(`a tracker by ${algorithm}, ${dimension}D`, () => {
      const rng = random(dimension);
      for (const count of [5, 200]) {
        const boxes = uniform.boxes(count, dimension, 5).map((x) => x / 4);
        const tracker = broadside.tracker({ dimension, algorithm });
        let before: number[] = [];
        for (let frame = 0; frame < 12; ++frame) {
          const moved = frame === 0 ? [] : move(boxes, dimension, frame % 3 === 0 ? 1 : 0.1, rng);
          const { begun, ended } = tracker.update(boxes, frame % 2 === 0 ? {} : { changed: moved });
          const now = pairsByDefinition(boxes, dimension);
          assert.deepEqual([...begun], without(now, before), `begun in frame ${frame}`);
          assert.deepEqual([...ended], without(before, now), `ended in frame ${frame}`);
          before = now;
        }
        tracker.free();
      }
    });
  }
}

test("a tracker sees boxes that come and go, and filters that change", () => {
  const tracker = broadside.tracker();
  assert.deepEqual([...tracker.update([0, 0, 2, 2]).begun], []);
  assert.deepEqual([...tracker.update([0, 0, 2, 2, 1, 1, 3, 3]).begun], [0, 1]);
  assert.deepEqual([...tracker.update([0, 0, 2, 2, 1, 1, 3, 3], { filters: { category: [1, 2], mask: [1, 2] } }).ended],
    [0, 1]);
  assert.deepEqual([...tracker.update([0, 0, 2, 2, 1, 1, 3, 3], { filters: { category: [1, 2], mask: [3, 3] } }).begun],
    [0, 1]);
  const { begun, ended } = tracker.update([]);
  assert.deepEqual([[...begun], [...ended]], [[], [0, 1]]);
});

for (const dimension of [2, 3] as const) {
  for (const options of [{}, { margin: 0.5 }, { margin: 1, predictedFrames: 3 }, { algorithm: "grid" }]) {
    test(`a world, ${dimension}D, ${JSON.stringify(options)}`, () => {
      const rng = random(11);
      const world = broadside.world({ dimension, ...options });
      const boxes = uniform.boxes(300, dimension, 9).map((x) => x / 4);
      const size = 2 * dimension;
      // By handle: its box and its place in the model's array.
      const live = new Map<Handle, Float32Array>();
      let before: number[] = [];
      for (let frame = 0; frame < 12; ++frame) {
        for (const [handle, box] of live) {
          if (rng() < 0.1) {
            world.remove(handle);
            live.delete(handle);
          } else if (rng() < 0.2) {
            move(box, dimension, 1, rng);
            world.move(handle, box);
          }
        }
        const from = size * Math.floor(rng() * 280);
        const added = boxes.slice(from, from + size * 20);
        world.add(added).forEach((handle, i) => live.set(handle, added.slice(size * i, size * (i + 1))));
        assert.equal(world.size, live.size);

        const { begun, ended } = world.update();
        // The model's pairs as handles, in the order of slots.
        const handles = [...live.keys()].sort((a, b) => world.slot(a) - world.slot(b));
        const all = Float32Array.from(handles.flatMap((handle) => [...(live.get(handle) as Float32Array)]));
        const now = pairsByDefinition(all, dimension).map((i) => handles[i] as Handle);
        assert.deepEqual([...begun], without(now, before), `begun in frame ${frame}`);
        assert.deepEqual(new Set(byPairs(ended)), new Set(byPairs(without(before, now))), `ended in frame ${frame}`);
        assert.deepEqual([...world.pairs()], now);
        before = now;
      }
      for (const [handle, box] of live) assert.deepEqual(world.box(handle), box);
      world.free();
    });
  }
}

function byPairs(numbers: ArrayLike<number>): string[] {
  return Array.from({ length: numbers.length / 2 }, (_, k) => `${at(numbers, 2 * k)},${at(numbers, 2 * k + 1)}`);
}

test("many handles at once, all or none", () => {
  const world = broadside.world();
  const handles = world.add([0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]);
  world.move(handles.subarray(1), [0, 0, 1, 1, 0, 0, 1, 1]);
  assert.deepEqual(world.update().begun.length, 2 * 3);
  world.remove(handles.subarray(0, 2));
  assert.throws(() => world.remove(handles), { code: "INVALID_HANDLE" });
  assert.equal(world.size, 1);
  assert.equal(world.has(at(handles, 0)), false);
  assert.equal(world.has(at(handles, 2)), true);
  assert.equal(world.update().ended.length, 2 * 3);
});

test("a slot is used again, its handle never", () => {
  const world = broadside.world();
  const seen = new Set<Handle>();
  for (let i = 0; i < 1000; ++i) {
    const handle = at(world.add([0, 0, 1, 1]), 0);
    assert.ok(!seen.has(handle) && Number.isSafeInteger(handle));
    seen.add(handle);
    world.remove(handle);
    world.update();
  }
  assert.ok(Math.max(...[...seen].map((handle) => world.slot(handle))) < 4);
});

test("one box alone", () => {
  const world = broadside.world();
  const ball = world.addOne([0, 0, 1, 1], { filter: { category: 2, isStatic: true } });
  const wall = world.addOne([1, 1, 2, 2], { filter: { mask: 2 } });
  world.addOne([1, 1, 2, 2], { filter: { mask: 4 } });
  assert.deepEqual([...world.update().begun], [ball, wall]);
});

test("filters, and pairs that are ignored", () => {
  const world = broadside.world();
  const [a, b, c] = [...world.add([0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1], { filters: { isStatic: [1, 1, 0] } })] as
    [Handle, Handle, Handle];
  assert.deepEqual([...world.update().begun], [a, c, b, c]);
  world.ignore(c, a);
  assert.deepEqual([...world.update().ended], [a, c]);
  world.unignore(a, c);
  world.setFilter(b, { mask: 2 });
  const { begun, ended } = world.update();
  assert.deepEqual([[...begun], [...ended]], [[a, c], [b, c]]);
});

test("a world that tells of enlarged boxes", () => {
  const world = broadside.world({ margin: 1, events: "enlarged" });
  world.add([0, 0, 1, 1, 2, 2, 3, 3]);
  assert.equal(world.update().begun.length, 2);
});

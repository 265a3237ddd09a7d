// Memory: views hold as long as they are said to, memory grows, and none is lost.
import assert from "node:assert/strict";
import { test } from "node:test";

import { type Broadside, type Dimension, load } from "broadside";

import { at, pairsByDefinition, scenes } from "./support.ts";

const uniform = scenes[0] as (typeof scenes)[0];

/** How much memory the module has: the length of what any view into it is of. */
function bytesOf(broadside: Broadside): number {
  const boxes = broadside.boxes(1);
  const { byteLength } = boxes.data.buffer;
  boxes.free();
  return byteLength;
}

test("memory grows under boxes that are kept, and their data is read anew", async () => {
  const broadside = await load();
  const kept = broadside.boxes(3);
  kept.data.set([0, 0, 2, 2, 1, 1, 3, 3, 5, 5, 6, 6]);
  const before = bytesOf(broadside);
  const many = uniform.boxes(300_000, 2, 1).map((x) => x * 100);
  const count = broadside.count(many);
  assert.ok(bytesOf(broadside) > before);
  assert.deepEqual([...kept.data], [0, 0, 2, 2, 1, 1, 3, 3, 5, 5, 6, 6]);
  assert.deepEqual([...broadside.pairs(kept)], [0, 1]);
  assert.equal(broadside.pairs(many).length / 2, count);
});

test("memory grows under the results of a world", async () => {
  const broadside = await load();
  const world = broadside.world();
  const handles = world.add(uniform.boxes(20_000, 2, 1).map((x) => x * 10));
  const { begun } = world.update();
  assert.equal(begun.length, broadside.pairs(uniform.boxes(20_000, 2, 1).map((x) => x * 10)).length);
  assert.equal(handles.length, 20_000);
});

test("a view holds until the next call", async () => {
  const broadside = await load();
  const boxes = uniform.boxes(200, 2, 3);
  const pairs = broadside.pairs(boxes, { sorted: true });
  const kept = pairs.slice();
  assert.deepEqual([...pairs], pairsByDefinition(boxes, 2));
  broadside.pairs(uniform.boxes(100, 2, 4));
  assert.deepEqual([...kept], pairsByDefinition(boxes, 2));
});

/** Everything that takes memory, and gives it back. */
function useEverything(broadside: Broadside, dimension: Dimension, boxes: Float32Array): void {
  const kept = broadside.boxes(boxes.length / (2 * dimension), dimension);
  kept.data.set(boxes);
  const filters = { category: new Uint32Array(kept.count).fill(1) };
  for (const algorithm of broadside.algorithms()) {
    broadside.pairs(kept, { dimension, algorithm });
    broadside.join(kept, boxes, { dimension, algorithm, filters });
    const tracker = broadside.tracker({ dimension, algorithm });
    tracker.update(kept);
    tracker.update(boxes.map((x) => x + 1), { filters });
    tracker.free();
    const world = broadside.world({ dimension, algorithm, margin: 0.1 });
    const handles = world.add(kept, { filters });
    world.update();
    world.move(handles, boxes.map((x) => x + 1));
    world.ignore(at(handles, 0), at(handles, 1));
    world.update();
    world.pairs();
    world.nearest(boxes.subarray(0, dimension), 3);
    world.free();
  }
  const index = broadside.index(kept, { dimension });
  index.overlapping(boxes.subarray(0, 2 * dimension), { filter: { mask: 1 } });
  index.free();
  kept.free();
}

function failInEverything(broadside: Broadside): void {
  const invalid = new Float32Array(4000).fill(NaN);
  const world = broadside.world();
  const tracker = broadside.tracker();
  for (const call of [
    () => broadside.pairs(invalid), () => broadside.pairs(invalid, { algorithm: "none" }), () => world.add(invalid),
    () => tracker.update(invalid), () => broadside.index(invalid), () => broadside.world({ algorithm: "none" }),
    () => broadside.tracker({ algorithm: "grid:cell=x" }), () => world.remove(1),
  ])
    assert.throws(call, { name: "BroadsideError" });
  world.free();
  tracker.free();
}

test("no memory is lost, neither by calls that succeed nor by calls that fail", async () => {
  const broadside = await load();
  const boxes = uniform.boxes(2000, 2, 1);
  const round = () => {
    useEverything(broadside, 2, boxes);
    useEverything(broadside, 3, uniform.boxes(500, 3, 1));
    failInEverything(broadside);
  };
  for (let i = 0; i < 3; ++i) round();
  const before = bytesOf(broadside);
  for (let i = 0; i < 30; ++i) round();
  assert.equal(bytesOf(broadside), before);
});

test("finders of many kinds do not pile up", async () => {
  const broadside = await load();
  const boxes = uniform.boxes(3000, 2, 1);
  const search = (i: number) => broadside.pairs(boxes, { algorithm: `grid:cell=${i % 100 + 1}` });
  for (let i = 0; i < 100; ++i) search(i);
  const before = bytesOf(broadside);
  for (let i = 0; i < 300; ++i) search(i);
  assert.equal(bytesOf(broadside), before);
});

test("more memory than there is", async () => {
  const broadside = await load();
  assert.throws(() => broadside.boxes(2 ** 28), { code: "OUT_OF_MEMORY" });
  assert.deepEqual([...broadside.pairs([0, 0, 2, 2, 1, 1, 3, 3])], [0, 1]);
});

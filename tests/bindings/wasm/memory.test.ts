// Memory: views hold as long as they are said to, memory grows, and none is lost.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { type Broadside, type Dimension, load } from "broadside";

import type { Exports } from "../../../bindings/wasm/src/core.ts";
import { importsOf } from "../../../bindings/wasm/src/imports.ts";
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

test("memory that runs out within a call", async () => {
  const wasm = await WebAssembly.compile(readFileSync(join(process.env["BROADSIDE_PACKAGE"] as string, "broadside-2d.wasm")));
  let memory: WebAssembly.Memory;
  const { exports } = await WebAssembly.instantiate(wasm, importsOf(() => memory.buffer));
  const core = exports as unknown as Exports;
  ({ memory } = core);
  core._initialize();
  const reply = () => new Uint32Array(memory.buffer, core.reply(), 4);
  const count = 3000;
  const boxes = core.reserve(16 * count);
  assert.equal(core.finder_make(boxes, new TextEncoder().encodeInto("grid", new Uint8Array(memory.buffer, boxes)).written), 0);
  const finder = reply()[0] as number;
  new Float32Array(memory.buffer, boxes, 4 * count).fill(1);
  const find = () => core.finder_find(finder, boxes, count, 0, 0, 0, 0, 0);
  const taken: number[] = [];
  for (let bytes = 2 ** 31; bytes >= 1; bytes /= 2) {
    for (let address; (address = core.reserve(bytes)) !== 0;) taken.push(address);
  }
  const outOfMemory = 7;
  for (let i = 0; i < 3; ++i) {
    assert.equal(find(), outOfMemory);
    assert.equal(Buffer.from(memory.buffer, reply()[2], reply()[3]).toString(), "out of memory");
  }
  for (const address of taken) core.release(address);
  assert.equal(find(), 0, "and then all is well");
  assert.equal(reply()[1], count * (count - 1) / 2);
});

test("more memory than there is", async () => {
  const broadside = await load();
  assert.throws(() => broadside.boxes(2 ** 28), { code: "OUT_OF_MEMORY" });
  assert.deepEqual([...broadside.pairs([0, 0, 2, 2, 1, 1, 3, 3])], [0, 1]);
});

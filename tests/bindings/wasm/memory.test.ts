// Memory: views hold as long as they are said to, memory grows, and none is lost.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { type Broadside, type Dimension, load } from "broadside";

import type { Exports } from "../../../bindings/wasm/src/core.ts";
import { importsOf } from "../../../bindings/wasm/src/imports.ts";
import { at, scenes } from "./support.ts";

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

/** Every call that returns arrays, on few boxes (compared in JavaScript) and on many. */
function resultsOf(broadside: Broadside, boxes: Float32Array, view?: boolean): (() => ArrayLike<number>[])[] {
  const options = view === undefined ? {} : { view };
  const tracker = broadside.tracker();
  const world = broadside.world();
  const handles = world.add(boxes);
  const index = broadside.index(boxes);
  const point = boxes.subarray(0, 2);
  const box = [...point, ...point.map((x) => x + 20)];
  const events = ({ begun, ended }: { begun: ArrayLike<number>; ended: ArrayLike<number> }) => [begun, ended];
  const neighbours = ({ ids, distances }: { ids: ArrayLike<number>; distances: ArrayLike<number> }) => [ids, distances];
  return [
    () => [broadside.pairs(boxes.subarray(0, 120), options)],
    () => [broadside.pairs(boxes, options)],
    () => [broadside.join(boxes, boxes.subarray(0, 400), options)],
    () => events(tracker.update(boxes, options)),
    () => [world.add(boxes.subarray(0, 4)), world.box(at(handles, 0))],
    () => events(world.update(options)),
    () => [world.pairs(options)],
    () => [index.overlapping(box, options)],
    () => neighbours(index.nearest(point, 3, options)),
    () => [world.overlapping(box, options)],
    () => neighbours(world.nearest(point, 3, options)),
  ];
}

test("results are copies: no later call changes them, and no memory that grows takes them", async () => {
  const broadside = await load();
  const boxes = uniform.boxes(2000, 2, 3);
  const found = resultsOf(broadside, boxes).flatMap((call) => call());
  const copies = found.map((result) => Array.from(result));
  assert.ok(copies.filter((copy) => copy.length > 0).length >= 11, "nearly all found something");
  const shifted = boxes.map((x) => x * 0.9);
  for (let i = 0; i < 2; ++i) for (const call of resultsOf(broadside, shifted)) call();
  broadside.boxes(4_000_000);
  assert.deepEqual(found.map((result) => Array.from(result)), copies);
  // Whoever gets an array may hand its memory over to a worker.
  for (const result of found as Float64Array[]) structuredClone(result, { transfer: [result.buffer as ArrayBuffer] });
  assert.deepEqual([...broadside.pairs([0, 0, 1, 1])], []);

  const index = broadside.index([0, 0, 1, 1, 9, 9, 10, 10]);
  const queries = [[0, 0], [9, 9]];
  assert.deepEqual(queries.map((q) => [...index.nearest(q, 1).ids]), [[0], [1]]);
  const [first, second] = queries.map((q) => index.nearest(q, 1).ids);
  assert.deepEqual([[...first as Uint32Array], [...second as Uint32Array]], [[0], [1]]);
});

test("views equal copies, share memory with the next call, and are refused where they mean nothing", async () => {
  const broadside = await load();
  const boxes = uniform.boxes(2000, 2, 3);
  const copies = resultsOf(broadside, boxes).map((call) => call().map((result) => Array.from(result)));
  const views = resultsOf(broadside, boxes, true).map((call) => call().map((result) => Array.from(result)));
  // The handles differ: each world has its own.
  assert.deepEqual(views.slice(0, 4), copies.slice(0, 4));
  assert.deepEqual(views.map((call) => call.map((one) => one.length)), copies.map((call) => call.map((one) => one.length)));

  for (const some of [boxes.subarray(0, 120), boxes]) {
    const one = broadside.pairs(some, { view: true });
    assert.equal(broadside.pairs(some, { view: true }).buffer, one.buffer);
    assert.notEqual(broadside.pairs(some).buffer, broadside.pairs(some).buffer);
  }
  // A view that is transferred takes nothing with it that later calls need.
  const two = new Float32Array([0, 0, 1, 1, 1, 1, 2, 2]);
  for (const options of [{ view: true }, {}, { view: true }]) {
    const view = broadside.pairs(two, { view: true });
    structuredClone(view, { transfer: [view.buffer as ArrayBuffer] });
    assert.deepEqual([...broadside.pairs(two, options)], [0, 1]);
  }
  const index = broadside.index(boxes);
  const world = broadside.world();
  for (const call of [
    () => broadside.pairs(boxes, { view: 1 } as object), () => broadside.pairs(boxes.subarray(0, 8), { view: "yes" } as object),
    () => broadside.count(boxes, { view: true } as object), () => index.update(boxes, { view: true } as object),
    () => index.firstHit([0, 0], [1, 0], { view: true } as object), () => index.overlapping([0, 0, 1, 1], { view: 0 } as object),
    () => world.update({ view: null } as object), () => world.pairs({ copy: true } as object),
    () => broadside.tracker().update(boxes, { view: "no" } as object),
  ])
    assert.throws(call, { code: "INVALID_ARGUMENT" });
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
  const { exports } = await WebAssembly.instantiate(wasm, importsOf(wasm));
  const core = exports as unknown as Exports;
  const { memory } = core;
  core._initialize();
  const reply = () => new Uint32Array(memory.buffer, core.reply(), 4);
  const count = 3000;
  const boxes = core.reserve(16 * count);
  assert.equal(core.finder_make(boxes, new TextEncoder().encodeInto("grid", new Uint8Array(memory.buffer, boxes)).written), 0);
  const finder = reply()[0] as number;
  new Float32Array(memory.buffer, boxes, 4 * count).fill(1);
  const find = () => core.finder_find(finder, boxes, count, 0, 0, 0, 0, 0, 0, 0, 0);
  const taken: number[] = [];
  for (let bytes = 2 ** 31; bytes >= 1; bytes /= 2) {
    for (let address; (address = core.reserve(bytes)) !== 0;) taken.push(address);
  }
  const outOfMemory = 10;
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

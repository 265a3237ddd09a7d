// What cannot be is refused by an error that names the thing, what was found and what was expected; afterwards
// everything is as before.
import assert from "node:assert/strict";
import { test } from "node:test";

import { type BoxArray, BroadsideError, type Handle, type WorldOptions, load } from "broadside";
import { load as loadExternal } from "broadside/external";
import { load as loadPairs } from "broadside/pairs";

import { at } from "./support.ts";

const broadside = await load();
const overlapping = [0, 0, 2, 2, 1, 1, 3, 3];

/** The error that a call throws. */
function errorOf(call: () => unknown): BroadsideError {
  try {
    call();
  } catch (error) {
    assert.ok(error instanceof BroadsideError && error instanceof Error, String(error));
    assert.deepEqual([...broadside.pairs(overlapping)], [0, 1], "and then all is well");
    return error;
  }
  return assert.fail("nothing was thrown");
}

test("invalid boxes are named, in the library's words", () => {
  for (const count of [2, 100]) {
    const boxes = new Float32Array(4 * count).fill(1);
    boxes[4 * count - 3] = NaN;
    const error = errorOf(() => broadside.pairs(boxes));
    assert.equal(error.name, "BroadsideError");
    assert.equal(error.code, "INVALID_INPUT");
    assert.equal(error.index, count - 1);
    assert.equal(error.message, `box ${count - 1} has min (1, nan) and max (1, 1); expected numbers with min <= max ` +
      "on every axis, or the absent box (min = +inf, max = -inf)");
  }
  const size = errorOf(() => broadside.pairs([20, 20, 10, 10]));
  assert.equal(size.index, 0);
  assert.match(size.message, /; a box is its minima and then its maxima, not its size$/);
  assert.equal(errorOf(() => broadside.pairs([0, 0, 0, 0, 0, -1], { dimension: 3 })).code, "INVALID_INPUT");
  assert.match(errorOf(() => broadside.join([0, 0, 1, 1], [0, NaN, 1, 1])).message, /^right box 0 has/);
  assert.match(errorOf(() => broadside.pairs([0.1, 0, -1e-30, 1])).message,
    /^box 0 has min \(0\.100000001, 0\) and max \(-1e-30, 1\);/);
});

test("numbers that are none, before they are read as others", () => {
  const isRefused = (call: () => unknown, message: string) => assert.equal(errorOf(call).message, message);
  const filters = (filter: object) => () => broadside.pairs(overlapping, { filters: filter });
  isRefused(filters({ category: ["a", 1] }), "filters.category[0] is 'a'; expected a whole number of at most 32 bits");
  isRefused(filters({ category: [1n, 1] }), "filters.category[0] is 1; expected a whole number of at most 32 bits");
  isRefused(filters({ mask: [1, NaN] }), "filters.mask[1] is NaN; expected a whole number of at most 32 bits");
  isRefused(filters({ group: [1.5, 1] }), "filters.group[0] is 1.5; expected a whole number of at most 32 bits");
  assert.deepEqual([...broadside.pairs(overlapping, { filters: { category: [~0, 2 ** 31], mask: [~0, 2 ** 32 - 1] } })],
    [0, 1], "as bit operations give them");
  isRefused(() => broadside.join(overlapping, overlapping, { rightFilters: { category: [1, 2 ** 32] } }),
    "rightFilters.category[1] is 4294967296; expected a whole number of at most 32 bits");
  const world = broadside.world();
  isRefused(() => world.addOne([0, 0, 1, 1], { filter: { mask: 0.5 } }),
    "filter.mask is 0.5; expected a whole number of at most 32 bits");
  const handle = world.addOne([0, 0, 1, 1]);
  isRefused(() => world.setFilter(handle, { group: Infinity }),
    "filter.group is Infinity; expected a whole number of at most 32 bits");
  isRefused(() => world.remove(undefined as unknown as number), "handles is undefined; expected a handle, or an array of them");
  isRefused(() => world.update(new Float32Array(4) as object),
    "options is Float32Array; expected an object: a world takes boxes by add() and move()");
  world.free();
  const tracker = broadside.tracker();
  tracker.update(overlapping);
  isRefused(() => tracker.update(overlapping, { changed: [false, true] as unknown as number[] }),
    "changed[0] is false; expected a number");
  tracker.free();
  isRefused(() => broadside.pairs(["0", "0", "1", "1"] as unknown as number[]), "boxes[0] is '0'; expected a number");
  isRefused(() => broadside.world().addOne({ x: 0 } as unknown as number[]),
    "box is an object; expected an array of numbers: minX, minY, maxX, maxY of each box");
  isRefused(() => broadside.pairs(overlapping, { sort: true } as object),
    "unknown option 'sort' (did you mean 'sorted'?); expected some of: dimension, algorithm, filters, same, different, " +
    "touching, within, period, sorted, view");
});

test("specs", () => {
  const error = errorOf(() => broadside.pairs(overlapping, { algorithm: "grit", sorted: true }));
  assert.equal(error.code, "INVALID_SPEC");
  assert.match(error.message, /^unknown algorithm 'grit' \(did you mean 'grid'\?\); expected one of: auto, /);
  assert.equal(errorOf(() => broadside.pairs(overlapping, { algorithm: "grid:cell=-1", filters: {} })).message,
    "grid: cell is '-1'; expected a number above 0, or auto");
  assert.equal(errorOf(() => broadside.tracker({ algorithm: "" })).code, "INVALID_SPEC");
  assert.equal(errorOf(() => broadside.world({ algorithm: "grid:sell=1" })).code, "INVALID_SPEC");
  assert.equal(errorOf(() => broadside.world({ margin: -1 })).message,
    "world: margin is '-1'; expected a number of at least 0");
  assert.equal(errorOf(() => broadside.world({ events: "some" as "exact" })).message,
    "world: events is 'some'; expected one of: exact, enlarged");
  assert.equal(errorOf(() => broadside.world({ margin: -1 })).code, "INVALID_ARGUMENT");
  assert.equal(errorOf(() => broadside.world({ firstGeneration: 5 } as object)).code, "INVALID_ARGUMENT");
  assert.equal(errorOf(() => broadside.world({ events: "exact:shadow=yes" as "exact" })).code, "INVALID_ARGUMENT");
  const world = broadside.world({ maxBoxes: 1 });
  assert.equal(errorOf(() => world.add([0, 0, 1, 1, 2, 2, 3, 3])).code, "INVALID_FRAME");
  assert.equal(world.size, 0);
});

test("a world's options have the names of the declarations", () => {
  const { message } = errorOf(() => broadside.world({ margn: 2 } as object));
  const [, names] = /^world: unknown option 'margn' \(did you mean 'margin'\?\); expected one of: (.*)$/.exec(message) ?? [];
  const declared: Required<Omit<WorldOptions, "algorithm" | "dimension">> = {
    margin: 1, relativeMargin: 1, predictedFrames: 1, events: "exact", keepPairs: true, touching: true, quarantine: false,
    shadow: false, maxBoxes: 9,
  };
  assert.equal(names, Object.keys(declared).join(", "));
  assert.equal(broadside.world(declared).size, 0);
});

test("messages of the library have JavaScript's names", () => {
  assert.equal(errorOf(() => broadside.world({ keepPairs: false }).pairs()).message,
    "the world does not keep its pairs; expected keepPairs, or broadside.pairs(boxes)");
  assert.equal(errorOf(() => broadside.world({ relativeMargin: -1 })).message,
    "world: relativeMargin is '-1'; expected a number of at least 0");
  assert.equal(errorOf(() => broadside.index([]).firstHit([0, 0], [1, 0], { tMax: -1 })).message,
    "a cast's tMax is -1; expected at least 0, or infinity");
  assert.match(errorOf(() => broadside.pairs([], { algorithm: "brute_forse" })).message, /brute_force/);
});

/** Calls that take what JavaScript's types do not keep out. */
const wrong = (value: unknown) => value as BoxArray;

test("arguments of the wrong kind, the first of them", () => {
  const index = broadside.index(overlapping);
  const cases: [() => unknown, string][] = [
    [() => broadside.pairs([0, 0, 1]), "the length of boxes is 3; expected a multiple of 4"],
    [() => broadside.pairs(new Float32Array(5)), "the length of boxes is 5; expected a multiple of 4"],
    [() => broadside.pairs(new Float32Array(7)), "the length of boxes is 7; expected a multiple of 4"],
    [() => broadside.pairs(new Float32Array(11), { dimension: 3 }), "the length of boxes is 11; expected a multiple of 6"],
    [() => broadside.pairs([0, 0, 1, 1], { dimension: 3 }), "the length of boxes is 4; expected a multiple of 6"],
    [() => broadside.pairs(wrong(undefined)), "boxes is undefined; expected an array of numbers"],
    [() => broadside.pairs(wrong("four")), "boxes is 'four'; expected an array of numbers"],
    [() => broadside.pairs(wrong(null)), "boxes is null; expected an array of numbers"],
    [() => broadside.pairs(wrong({})), "boxes is an object; expected an array of numbers: minX, minY, maxX, maxY of each box"],
    [() => broadside.pairs(wrong([{ minX: 0, minY: 0, maxX: 1, maxY: 1 }, {}, {}])),
      "boxes[0] is an object; expected a number: one array has all boxes, minX, minY, maxX, maxY of each"],
    [() => broadside.index(wrong([[0, 0, 0, 1, 1, 1]]), { dimension: 3 }),
      "boxes[0] is an array; expected a number: one array has all boxes, minX, minY, minZ, maxX, maxY, maxZ of each"],
    [() => index.nearest(0 as never, 0, 3 as never), "point is 0; expected an array of numbers"],
    [() => index.overlapping(0 as never, 0 as never), "box is 0; expected an array of numbers"],
    [() => index.nearestOfEach(0 as never, 0, 3 as never), "boxes is 0; expected an array of numbers"],
    [() => index.firstHit(0 as never, 0 as never, 3 as never), "origin is 0; expected an array of numbers"],
    [() => index.nearest([0, 0], 1, { filter: (() => true) as never }),
      "filter is a function; expected an object of category, mask, group, isStatic"],
    [() => broadside.world().move(0, 3 as never, 4 as never), "boxes is 3; expected an array of numbers"],
    [() => broadside.world().addOne(overlapping), "the number of boxes is 2; expected 1; add() takes several"],
    [() => broadside.pairs(wrong(new DataView(new ArrayBuffer(16)))),
      "boxes is DataView; expected an array of numbers: minX, minY, maxX, maxY of each box"],
    [() => broadside.pairs([], { dimension: 4 as 3 }), "dimension is 4; expected 2 or 3"],
    [() => broadside.pairs([], { algorithm: 3 as unknown as string }), "algorithm is 3; expected a text such as 'auto'"],
    [() => broadside.pairs([], { sorted: 1 as unknown as boolean }), "sorted is 1; expected true or false"],
    [() => broadside.pairs([], { sortd: true } as object),
      "unknown option 'sortd'; expected some of: dimension, algorithm, filters, same, different, touching, within, period, sorted, view"],
    [() => broadside.count([], { sorted: true } as object),
      "unknown option 'sorted'; expected some of: dimension, algorithm, filters, same, different, touching, within, period"],
    [() => broadside.pairs(overlapping, { filters: { category: [1] } }),
      "the length of filters.category is 1; expected 2, one for each box"],
    [() => broadside.pairs(overlapping, { filters: { kind: [1] } as object }),
      "unknown option 'kind'; expected some of: category, mask, group, isStatic"],
    [() => broadside.boxes(-1), "the number of boxes is -1; expected a whole number of at least 0"],
    [() => broadside.boxes(1, 1 as 2), "dimension is 1; expected 2 or 3"],
    [() => broadside.pairs(broadside.boxes(1, 3)), "the dimension of boxes is 3; expected 2"],
    [() => broadside.world({ margin: [1] as unknown as number }), "margin is an array; expected a number, a text, true or false"],
    [() => broadside.world().add([0, 0, 1, 1], { userData: 1 } as object),
      "unknown option 'userData'; expected some of: filters"],
    [() => broadside.world().box("1" as unknown as Handle), "a handle is '1'; expected a number that add() returned"],
  ];
  for (const [call, message] of cases) {
    const error = errorOf(call);
    assert.equal(error.code, "INVALID_ARGUMENT", message);
    assert.equal(error.message, message);
  }
});

test("handles that name no box of this world", () => {
  const world = broadside.world();
  const other = broadside.world();
  const handle = at(world.add(overlapping), 0);
  const foreign = at(other.add(overlapping), 0);
  world.update();
  for (const invalid of [foreign, handle + 0.5, -1, NaN, Infinity, 2 ** 53, 0]) {
    assert.equal(errorOf(() => world.move(invalid, [0, 0, 1, 1])).code, "INVALID_HANDLE", String(invalid));
    assert.equal(errorOf(() => world.remove(invalid)).code, "INVALID_HANDLE");
    assert.equal(errorOf(() => world.box(invalid)).code, "INVALID_HANDLE");
    assert.equal(world.has(invalid), false);
  }
  assert.equal(errorOf(() => world.ignore(handle, handle)).code, "INVALID_ARGUMENT");
  assert.deepEqual(world.update(), { begun: new Float64Array(0), ended: new Float64Array(0) });
});

test("a call that is refused has changed nothing", () => {
  const world = broadside.world();
  const handles = world.add(overlapping);
  world.update();
  assert.equal(errorOf(() => world.move(handles, [9, 9, 9, 9, 0, 0, NaN, 1])).index, 1);
  assert.equal(errorOf(() => world.add([0, 0, 1, 1, 3, 0, 1, 1])).index, 1);
  assert.equal(errorOf(() => world.move(handles, [0, 0, 1, 1])).message,
    "the number of handles is 2; expected 1, one for each box");
  assert.equal(errorOf(() => world.move(handles, overlapping, { velocities: [1] })).code, "INVALID_ARGUMENT");
  assert.equal(world.size, 2);
  assert.equal(world.update().begun.length + world.update().ended.length, 0);

  const tracker = broadside.tracker();
  tracker.update(overlapping);
  assert.equal(errorOf(() => tracker.update([0, 0, 2, 2, 1, NaN, 3, 3])).code, "INVALID_INPUT");
  assert.equal(errorOf(() => tracker.update(overlapping, { changed: [7] })).code, "INVALID_FRAME");
  assert.deepEqual([...tracker.update([0, 0, 2, 2, 5, 5, 6, 6]).ended], [0, 1]);
});

test("objects that were freed", () => {
  const objects = [broadside.boxes(1), broadside.tracker(), broadside.world(), broadside.index([])] as const;
  for (const object of objects) {
    object.free();
    object.free();
  }
  const [boxes, tracker, world, index] = objects;
  const freed = "an object was used after free(); expected one that is not freed";
  for (const call of [() => boxes.data, () => broadside.pairs(boxes), () => tracker.update([]), () => world.update(),
    () => world.add([]), () => world.size, () => index.overlapping([0, 0, 1, 1]), () => index.update([])])
    assert.equal(errorOf(call).message, freed);
});

test("boxes of another module", async () => {
  const boxes = (await load()).boxes(1);
  assert.equal(errorOf(() => broadside.pairs(boxes)).code, "INVALID_ARGUMENT");
});

test("load() refuses options that do not apply", async () => {
  await assert.rejects(load({ fast: true } as object), { message: "unknown option 'fast'; expected some of: dimension" });
  await assert.rejects(load({ dimension: 4 } as object), { message: "dimension is 4; expected 2 or 3" });
  await assert.rejects(loadPairs({ wasm: 1 } as object), { code: "INVALID_ARGUMENT" });
  await assert.rejects(loadExternal({ wasm: 1 as unknown as URL }), { code: "INVALID_ARGUMENT" });
});

// Pairs, of one set and of two, equal those of the definition.
import assert from "node:assert/strict";
import { test } from "node:test";

import { type Broadside, type Dimension, type Filters, load } from "broadside";
import { load as loadPairs } from "broadside/pairs";

import { joinByDefinition, pairsByDefinition, random, scenes } from "./support.ts";

const dimensions = [2, 3] as const satisfies readonly Dimension[];
const counts = [0, 1, 2, 3, 5, 8, 16, 33, 44, 45, 48, 49, 100, 300, 301, 1200];

const broadside: Broadside = await load();
const builds = [
  { name: "everything", broadside },
  { name: "pairs", broadside: await loadPairs() },
];

for (const { name, broadside } of builds) {
  for (const scene of scenes) {
    for (const dimension of dimensions) {
      test(`${name}: the pairs of boxes ${scene.name}, ${dimension}D`, () => {
        for (const count of counts) {
          const boxes = scene.boxes(count, dimension, count + 1);
          const expected = pairsByDefinition(boxes, dimension);
          for (const algorithm of broadside.algorithms()) {
            const found = broadside.pairs(boxes, { dimension, algorithm, sorted: true });
            assert.deepEqual([...found], expected, `${count} boxes by ${algorithm}`);
          }
          assert.equal(broadside.count(boxes, { dimension }), expected.length / 2);
        }
      });
    }
  }
}

test("each build says its version", () => {
  for (const build of builds) assert.match(build.broadside.version, /^\d+\.\d+\.\d+$/);
});

test("the pairs of few boxes have the order of brute force, whether JavaScript or the module finds them", () => {
  for (const dimension of dimensions) {
    for (let count = 0; count <= 48; ++count) {
      const boxes = (scenes[0] as (typeof scenes)[0]).boxes(count, dimension, 7).map((x) => x / 20);
      const inJavaScript = [...broadside.pairs(boxes, { dimension })];
      // No filters that say anything: but then the module is asked.
      const inModule = [...broadside.pairs(boxes, { dimension, filters: {}, algorithm: "brute_force" })];
      assert.deepEqual(inJavaScript, inModule, `${count} boxes`);
    }
  }
});

test("absent and infinite boxes", () => {
  const absent = [Infinity, Infinity, -Infinity, -Infinity];
  const all = [-Infinity, -Infinity, Infinity, Infinity];
  const one = [0, 0, 1, 1];
  for (const count of [1, 20]) {
    const boxes = Array.from({ length: count }, () => [...absent, ...all, ...one]).flat();
    assert.deepEqual([...broadside.pairs(boxes, { sorted: true })], pairsByDefinition(boxes, 2));
  }
});

test("plain arrays, doubles and boxes in the module's memory", () => {
  const boxes = [0, 0, 2, 2, 1, 1, 3, 3, 5, 5, 6, 6];
  assert.deepEqual([...broadside.pairs(boxes)], [0, 1]);
  assert.deepEqual([...broadside.pairs(Float64Array.from(boxes))], [0, 1]);
  const kept = broadside.boxes(3);
  assert.deepEqual([...broadside.pairs(kept)], [], "boxes are absent at first");
  kept.data.set(boxes);
  assert.deepEqual([...broadside.pairs(kept)], [0, 1]);
  assert.equal(broadside.count(kept), 1);
  kept.free();
});

for (const dimension of dimensions) {
  test(`two sets, ${dimension}D`, () => {
    for (const scene of scenes) {
      for (const [leftCount, rightCount] of [[0, 5], [3, 4], [40, 700]] as const) {
        const left = scene.boxes(leftCount, dimension, 1);
        const right = scene.boxes(rightCount, dimension, 2);
        const expected = joinByDefinition(left, right, dimension);
        const found = broadside.join(left, right, { dimension, sorted: true });
        assert.deepEqual([...found], expected, scene.name);
        assert.equal(broadside.countJoin(left, right, { dimension }), expected.length / 2);
      }
    }
  });

  test(`filters, ${dimension}D`, () => {
    const rng = random(3);
    for (const count of [2, 10, 300]) {
      const boxes = (scenes[4] as (typeof scenes)[0]).boxes(count, dimension, count);
      const of = (value: () => number) => Array.from({ length: count }, value);
      const filters: Filters = {
        category: Uint32Array.from(of(() => 1 << Math.floor(32 * rng()))),
        mask: Uint32Array.from(of(() => 2 ** 32 * rng())),
        group: Int32Array.from(of(() => Math.floor(5 * rng()) - 2)),
        isStatic: of(() => Math.floor(2 * rng())),
      };
      const { category, mask, group, isStatic } = filters;
      for (const some of [filters, { category, mask }, { group }, { isStatic }, {}] as Filters[]) {
        const found = broadside.pairs(boxes, { dimension, filters: some, sorted: true });
        assert.deepEqual([...found], pairsByDefinition(boxes, dimension, some));
      }
    }
  });
}

test("boxes that only touch are left out", () => {
  const tiles = new Float32Array([0, 0, 1, 1, 1, 0, 2, 1, 1, 0.5, 1, 0.5, 0.5, 0, 1.5, 1]);
  const expected = [0, 3, 1, 2, 1, 3, 2, 3];
  for (const { broadside } of builds) {
    assert.equal(broadside.pairs(tiles).length, 12);
    assert.deepEqual([...broadside.pairs(tiles, { touching: false, sorted: true })], expected);
    assert.equal(broadside.countJoin(tiles, tiles, { touching: false }), 12);
    assert.equal(broadside.count(tiles), 6);
    assert.throws(() => broadside.pairs(tiles, { touching: 0 as never }), /touching is 0; expected true or false/);
  }
  const tracker = broadside.tracker({ touching: false });
  assert.deepEqual([...tracker.update(tiles).begun], expected);
  assert.deepEqual([...tracker.update(tiles).ended], []);
  const world = broadside.world({ touching: false });
  world.add(tiles);
  assert.equal(world.update().begun.length, 2 * 4);
  assert.equal(world.overlapping(tiles.slice(0, 4)).length, 2);
});

test("options that were given before are read anew", () => {
  const boxes = new Float32Array([0, 0, 2, 2, 1, 1, 3, 3]);
  const options: { filters?: Filters; algorithm?: string } = {};
  assert.deepEqual([...broadside.pairs(boxes, options)], [0, 1]);
  options.filters = { group: [-1, -1] };
  assert.deepEqual([...broadside.pairs(boxes, options)], []);
  delete options.filters;
  options.algorithm = "none";
  assert.throws(() => broadside.pairs(boxes, options), { code: "INVALID_SPEC" });
});

test("the smaller module has two algorithms, and takes the one for so many boxes", async () => {
  const small = await loadPairs();
  assert.deepEqual(small.algorithms(), ["brute_force", "grid"]);
  assert.throws(() => small.pairs([0, 0, 1, 1, 0, 0, 1, 1], { algorithm: "quadtree" }), { code: "INVALID_SPEC" });
  const boxes = (scenes[0] as (typeof scenes)[0]).boxes(1000, 2, 1);
  assert.deepEqual([...small.pairs(boxes)], [...small.pairs(boxes, { algorithm: "grid" })]);
  assert.deepEqual([...small.pairs(boxes.subarray(0, 240))],
    [...small.pairs(boxes.subarray(0, 240), { algorithm: "brute_force" })]);
});

test("tunables and former names are the library's", () => {
  const boxes = (scenes[0] as (typeof scenes)[0]).boxes(400, 2, 1);
  const expected = pairsByDefinition(boxes, 2);
  for (const algorithm of ["grid:cell=2.5", "grid:cell=1e-3", "hierarchical_grid"])
    assert.deepEqual([...broadside.pairs(boxes, { algorithm, sorted: true })], expected, algorithm);
});

test("only boxes with the same key pair, or only boxes with different ones", () => {
  for (const { broadside } of builds) {
    for (const count of [3, 40, 500]) {
      const boxes = scenes[0]!.boxes(count, 2, 5);
      const all = pairsByDefinition(boxes, 2);
      for (const kinds of [1, 2, 7, 1000]) {
        for (const text of [false, true]) {
          const keys = Array.from({ length: count }, (_, i) => text ? `image ${i * 7 % kinds}` : i * 7 % kinds);
          const expected = (isSame: boolean) => all.filter((_, i) =>
            (keys[all[i - i % 2]!] === keys[all[i - i % 2 + 1]!]) === isSame);
          assert.deepEqual([...broadside.pairs(boxes, { same: keys, sorted: true })], expected(true));
          assert.deepEqual([...broadside.pairs(boxes, { different: keys, sorted: true })], expected(false));
          assert.equal(broadside.count(boxes, { same: keys }), expected(true).length / 2);
          const classes = Array.from({ length: count }, (_, i) => i % 3);
          const both = all.filter((_, i) => keys[all[i - i % 2]!] === keys[all[i - i % 2 + 1]!] &&
            classes[all[i - i % 2]!] !== classes[all[i - i % 2 + 1]!]);
          assert.deepEqual([...broadside.pairs(boxes, { same: keys, different: classes, sorted: true })], both);
        }
      }
    }
  }
});

test("a key means the same in two sets", () => {
  const left = [0, 0, 1, 1, 0, 0, 1, 1], right = [1, 1, 2, 2];
  assert.deepEqual([...broadside.join(left, right, { same: ["a", "b"], rightSame: ["b"] })], [1, 0]);
  assert.equal(broadside.countJoin(left, right, { different: ["a", "b"], rightDifferent: ["b"] }), 1);
  const both = { same: [1, 1], rightSame: [1], different: ["a", "b"], rightDifferent: ["b"] };
  assert.deepEqual([...broadside.join(left, right, both)], [0, 0]);
});

test("refuses keys that it cannot use", () => {
  const boxes = [0, 0, 1, 1, 0, 0, 1, 1];
  const refused = (options: object, message: RegExp) =>
    assert.throws(() => broadside.pairs(boxes, options), { code: "INVALID_ARGUMENT", message });
  refused({ same: [1] }, /the length of same is 1; expected 2, one for each box/);
  refused({ same: [1, NaN] }, /same\[1\] is NaN; expected a whole number or a text/);
  refused({ different: [1, undefined] }, /different\[1\] is undefined/);
  refused({ same: [1, 2], different: [1] }, /the length of different is 1; expected 2, one for each box/);
  refused({ same: [1, 2], filters: {} }, /filters is an object; expected nothing, as same is given/);
  assert.throws(() => broadside.join(boxes, boxes, { same: [1, 2] }), /the length of rightSame is undefined/);
});

test("finds what is within a distance or radii, and lists neighbours", () => {
  for (const { broadside } of builds) {
    const count = 300;
    const boxes = Array.from({ length: count }, (_, i) => [i * 7 % 41, i * 11 % 37]).flatMap(([x, y]) => [x!, y!, x! + 1, y!]);
    const radii = Array.from({ length: count }, (_, i) => i % 3);
    const gap = (a: number, b: number, axis: number) => Math.max(0, boxes[4 * a + axis]! - boxes[4 * b + axis + 2]!,
      boxes[4 * b + axis]! - boxes[4 * a + axis + 2]!);
    const expected = (reach: (a: number, b: number) => number) => {
      const pairs: number[] = [];
      for (let a = 0; a < count; ++a)
        for (let b = a + 1; b < count; ++b)
          if (gap(a, b, 0) ** 2 + gap(a, b, 1) ** 2 <= reach(a, b) ** 2) pairs.push(a, b);
      return pairs;
    };
    for (const within of [0, 1, 5])
      assert.deepEqual([...broadside.pairs(boxes, { within, sorted: true })], expected(() => within));
    const found = broadside.pairs(boxes, { within: radii, sorted: true });
    assert.deepEqual([...found], expected((a, b) => radii[a]! + radii[b]!));
    assert.equal(broadside.countJoin(boxes, boxes, { within: radii, rightWithin: radii }), found.length + count);
    const full = broadside.neighbours(found, count);
    const half = broadside.neighbours(found, count, { full: false });
    for (let i = 0; i < count; ++i) {
      const greater: number[] = [];
      const all: number[] = [];
      for (let k = 0; k < found.length; k += 2) {
        const [a, b] = [found[k]!, found[k + 1]!];
        if (a === i) greater.push(b);
        if (a === i || b === i) all.push(a + b - i);
      }
      assert.deepEqual([...half.ids.subarray(half.offsets[i], half.offsets[i + 1])], greater);
      assert.deepEqual([...full.ids.subarray(full.offsets[i], full.offsets[i + 1])], all.sort((a, b) => a - b));
    }
    const refused = (options: object, code: string, message: RegExp) =>
      assert.throws(() => broadside.pairs(boxes, options), { code, message });
    refused({ within: -1 }, "INVALID_QUERY", /the distance is -1; expected a finite number of 0 or more/);
    refused({ within: radii.map(() => NaN) }, "INVALID_QUERY", /radius of box 0 is nan/);
    refused({ within: [1] }, "INVALID_ARGUMENT", /the length of within is 1; expected 300, one for each box/);
    refused({ within: 1, touching: false }, "INVALID_ARGUMENT", /touching is false/);
    assert.throws(() => broadside.join(boxes, boxes, { within: radii }), /the length of rightWithin is undefined/);
    assert.throws(() => broadside.neighbours([0, 2], 2), /pairs\[1\] is 2; expected an id below 2/);
  }
});

test("boxes pair around the edge of space that repeats", () => {
  for (const { broadside } of builds) {
    const boxes = [170, 0, 190, 1, -180, 0, -175, 1, 0, 0, 1, 1];
    const period = [360, Infinity];
    assert.deepEqual([...broadside.pairs(boxes, { period })], [0, 1]);
    assert.deepEqual([...broadside.pairs(boxes)], []);
    assert.deepEqual([...broadside.pairs(boxes, { period, within: 175, sorted: true })], [0, 1, 0, 2, 1, 2]);
    assert.deepEqual([...broadside.pairs(boxes, { period, within: [0, 0, 169], sorted: true })], [0, 1, 0, 2]);
    assert.equal(broadside.count(boxes, { period }), 1);
    assert.deepEqual([...broadside.components(boxes, { period })], [0, 0, 2]);
    assert.throws(() => broadside.pairs(boxes, { period: [360] }), /the length of period is 1; expected 2/);
    assert.throws(() => broadside.pairs(boxes, { period: [360, 0] }), /the period of axis 1 is 0/);
  }
});

test("components are the boxes that hang together", () => {
  for (const { broadside } of builds) {
    for (const count of [0, 1, 40, 700]) {
      const boxes = scenes[0]!.boxes(count, 2, 9);
      const labels = Array.from({ length: count }, (_, i) => i);
      const pairs = pairsByDefinition(boxes, 2);
      for (let changes = true; changes;) {
        changes = false;
        for (let i = 0; i < pairs.length; i += 2) {
          const [a, b] = [pairs[i]!, pairs[i + 1]!];
          changes ||= labels[a] !== labels[b];
          labels[a] = labels[b] = Math.min(labels[a]!, labels[b]!);
        }
      }
      assert.deepEqual([...broadside.components(boxes)], labels);
      assert.deepEqual([...broadside.components(boxes, { view: true })], labels);
    }
  }
});

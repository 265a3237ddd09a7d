// The engine in Node: searches, observations, trackers, outlines, scenes and errors.
import assert from "node:assert/strict";
import { test } from "node:test";

import { loadEngine } from "../engine/engine.ts";
import { named, overlappingPairs, randomBoxes } from "./boxes.ts";

const engine = await loadEngine();

const kinds = [
  { count: 0, places: 10, maxExtent: 3 },
  { count: 1, places: 10, maxExtent: 3 },
  { count: 40, places: 30, maxExtent: 6 },
  { count: 300, places: 60, maxExtent: 5 },
  { count: 700, places: 400, maxExtent: 40 },
];

function eachSearch(body: (spec: string, boxes: Float32Array<ArrayBuffer>, dimension: 2 | 3) => void): void {
  for (const { name, dimensions } of engine.algorithms()) {
    for (const dimension of dimensions as (2 | 3)[]) {
      for (const [seed, kind] of kinds.entries())
        body(name, randomBoxes(seed, kind.count, { dimension, ...kind }), dimension);
    }
  }
}

test("it has the library's algorithms and the paper's", () => {
  const algorithms = engine.algorithms();
  const names = algorithms.map(({ name }) => name);
  for (const name of ["auto", "brute_force", "grid", "sweep_and_prune", "quadtree", "bvh", "paper_brute_force",
                      "paper_grid", "paper_sweep_and_prune", "paper_quadtree"])
    assert.ok(names.includes(name), name);
  const grid = algorithms.find(({ name }) => name === "grid")!;
  assert.deepEqual([grid.kind, grid.dimensions, grid.tracks], ["own", [2, 3], true]);
  assert.equal(grid.tunables.find(({ name }) => name === "cell")!.type, "number");
  assert.deepEqual(algorithms.find(({ name }) => name === "paper_grid")!.dimensions, [2]);
});

test("every search finds the pairs that overlap", () => {
  eachSearch((spec, boxes, dimension) => {
    const { pairs, milliseconds } = engine.find(spec, boxes, dimension);
    assert.deepEqual(named(pairs).sort(), overlappingPairs(boxes, dimension), `${spec} in ${dimension}D`);
    assert.ok(milliseconds >= 0);
  });
});

test("what is observed are the tests that the search counts", () => {
  eachSearch((spec, boxes, dimension) => {
    const at = `${spec} in ${dimension}D`;
    const { tests, statistics, pairs } = engine.observe(spec, boxes, dimension);
    const plain = engine.find(spec, boxes, dimension);
    assert.equal(tests.length / 2, statistics.tests, at);
    assert.equal(statistics.tests, plain.statistics.tests, at);
    assert.deepEqual(pairs, plain.pairs, at);
    const tested = new Set(named(tests));
    assert.ok(named(pairs).every((pair) => tested.has(pair)), at);
    const overlapping = new Set(named(pairs));
    assert.equal(named(tests).filter((pair) => overlapping.has(pair)).length, statistics.hits, at);
  });
});

test("absent boxes are in no pair and in no test", () => {
  const boxes = randomBoxes(3, 60, { dimension: 2, places: 20, maxExtent: 6 });
  for (let box = 0; box < 60; box += 3) boxes.set([Infinity, Infinity, -Infinity, -Infinity], 4 * box);
  for (const spec of ["grid", "bvh", "paper_quadtree"]) {
    const { tests, pairs, statistics } = engine.observe(spec, boxes, 2);
    assert.equal(tests.length / 2, statistics.tests);
    assert.ok([...tests, ...pairs].every((id) => id % 3 !== 0), spec);
    assert.deepEqual(named(pairs).sort(), overlappingPairs(boxes, 2));
  }
});

test("a tracker tells what begins and what ends", () => {
  for (const spec of ["auto", "grid", "sweep_and_prune", "quadtree", "bvh", "brute_force", "paper_grid",
                      "paper_sweep_and_prune:update=insertion", "paper_quadtree:update=siblings"]) {
    const tracker = engine.tracker(spec, 2);
    const now = new Set<string>();
    for (let frame = 0; frame < 6; ++frame) {
      // Boxes come and go: the number changes from frame to frame.
      const boxes = randomBoxes(frame % 3, 80 - 7 * frame, { dimension: 2, places: 30, maxExtent: 5 });
      const { begun, ended, bytes } = tracker.update(boxes);
      for (const pair of named(ended)) assert.ok(now.delete(pair), `${spec}: ${pair}`);
      for (const pair of named(begun)) {
        assert.ok(!now.has(pair), `${spec}: ${pair}`);
        now.add(pair);
      }
      assert.deepEqual([...now].sort(), overlappingPairs(boxes, 2), `${spec}, frame ${frame}`);
      assert.ok(bytes > 0);
    }
    assert.deepEqual(tracker.update(randomBoxes(2, 45, { dimension: 2, places: 30, maxExtent: 5 })).begun.length, 0);
    tracker.free();
    assert.throws(() => tracker.update(new Float32Array(4)), /was freed/);
  }
});

test("an outline has the boxes of each level", () => {
  const boxes = randomBoxes(4, 300, { dimension: 2, places: 200, maxExtent: 9 });
  const kindOf: Record<string, string> = {
    grid: "cells", sweep_and_prune: "sweep", quadtree: "nodes", bvh: "nodes", paper_grid: "cells", brute_force: "",
  };
  for (const [spec, kind] of Object.entries(kindOf)) {
    const outline = engine.outline(spec, boxes, 2);
    if (spec === "sweep_and_prune") assert.ok(["sweep", "stripes"].includes(outline.kind));
    else assert.equal(outline.kind, kind);
    for (const level of outline.levels) {
      assert.ok(level.length > 0 && level.length % 4 === 0);
      for (let at = 0; at < level.length; at += 4)
        assert.ok(level[at]! <= level[at + 2]! && level[at + 1]! <= level[at + 3]!);
    }
    assert.equal(outline.caption === "", kind === "");
  }
  assert.equal(engine.outline("sweep_and_prune:axis=y:axes=1", boxes, 2).sweptAxis, 1);
});

test("of a tracker with grid, the outline is of the cells that it keeps", () => {
  const boxes = randomBoxes(4, 600, { dimension: 2, places: 200, maxExtent: 4 });
  const [search, kept] = [engine.outline("grid", boxes, 2), engine.outline("grid", boxes, 2, true)];
  assert.match(kept.caption, /^kept: \d+ cells of .* with \d+ boxes/);
  assert.ok(kept.levels.at(-1)!.length > 4 * search.levels.at(-1)!.length);
  assert.deepEqual(engine.outline("bvh", boxes, 2, true), engine.outline("bvh", boxes, 2));
});

test("auto says what it takes and why", () => {
  assert.match(engine.advise(randomBoxes(1, 20, { dimension: 2, places: 50, maxExtent: 3 }), 2),
               /^brute_force, since 20 boxes are so few/);
});

test("a scene is the same for the same seed", () => {
  const scenes = engine.scenes();
  assert.ok(scenes.some(({ name, dimension }) => name === "uniform" && dimension === 3));
  for (const { name, dimension } of scenes) {
    const boxes = engine.scene(name, 50, 7, dimension as 2 | 3);
    assert.deepEqual(boxes, engine.scene(name, 50, 7, dimension as 2 | 3));
    assert.equal(boxes.length, 100 * dimension, name);
  }
  assert.notDeepEqual(engine.scene("uniform", 50, 7), engine.scene("uniform", 50, 8));
});

test("what is refused says what was found and what was expected", () => {
  const boxes = randomBoxes(1, 5, { dimension: 2, places: 9, maxExtent: 3 });
  assert.throws(() => engine.find("gird", boxes, 2), /gird.*grid/);
  assert.throws(() => engine.find("grid:cell=-1", boxes, 2), /cell is '-1'; expected/);
  assert.throws(() => engine.find("paper_grid", boxes.slice(0, 0), 3), /3D|dimension/);
  assert.throws(() => engine.find("grid", boxes.slice(0, 7), 2), /7 numbers of boxes; expected a multiple of 4/);
  assert.throws(() => engine.scene("moon", 5, 1), /no scene 'moon'; expected one of: uniform/);
  boxes[0] = NaN;
  assert.throws(() => engine.find("grid", boxes, 2), /box 0|index 0|at 0/i);
  boxes[0] = 0;
  assert.equal(engine.find("grid", boxes.slice(0, 8), 2).pairs.length % 2, 0);  // it still works
});

test("it takes many boxes, and its memory grows", () => {
  const boxes = engine.scene("uniform", 100_000, 1);
  const grid = engine.find("grid", boxes, 2);
  const bvh = engine.find("bvh", boxes, 2);
  assert.ok(grid.pairs.length > 0);
  assert.deepEqual(named(grid.pairs).sort(), named(bvh.pairs).sort());
});

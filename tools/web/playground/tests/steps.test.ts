// The steps match the C++ listings: the same pairs in the same order, and the same tests one by
// one.
import assert from "node:assert/strict";
import { test } from "node:test";

import { loadEngine } from "../engine/engine.ts";
import type { BvhState, QuadtreeState, GridState, StepAlgorithm, StepOptions, SweepState } from "../engine/types.ts";
import { randomAt } from "../scene/random.ts";
import { steps } from "../steps/index.ts";
import { named, randomBoxes } from "./boxes.ts";
import { pairsByDefinition } from "./law.ts";

const engine = await loadEngine();

const algorithms: StepAlgorithm[] = ["brute_force", "grid", "sweep_and_prune", "quadtree"];

/**
 * Small scenes of all kinds: spread, crowded, points, with a huge box, with an infinite box, with
 * absent boxes, all in one place.
 */
function sceneOf(seed: number): Float32Array<ArrayBuffer> {
  const of = (purpose: number, below: number): number => Math.floor(below * randomAt(seed, 1_000_000, purpose));
  const boxes = randomBoxes(seed, of(0, 41), { dimension: 2, places: [2, 12, 60, 400][of(1, 4)]!, maxExtent: of(2, 9) });
  const count = boxes.length / 4;
  const shift = [0, -17.25, 1e-3][of(3, 3)]!;
  for (let at = 0; at < boxes.length; ++at) boxes[at] = boxes[at]! * [1, 0.37][of(4, 2)]! + shift;
  if (count > 0 && of(5, 4) === 0) boxes.set([-300, -5, 900, 12], 4 * of(6, count));
  if (count > 0 && of(7, 8) === 0) boxes.set([-Infinity, 3, 5, Infinity], 4 * of(8, count));
  for (let box = 0; box < count && of(9, 5) === 0; box += 4) boxes.set([Infinity, Infinity, -Infinity, -Infinity], 4 * box);
  return boxes;
}

function optionsOf(algorithm: StepAlgorithm, seed: number): { spec: string; options: StepOptions } {
  const chosen = Math.floor(4 * randomAt(seed, 2_000_000, 0));
  if (algorithm === "grid" && chosen > 0) {
    const cell = [0.5, 3, 20][chosen - 1]!;
    return { spec: `paper_grid:cell=${cell}`, options: { cell } };
  }
  if (algorithm === "quadtree" && chosen > 0) {
    const capacity = [1, 2, 5][chosen - 1]!;
    return { spec: `paper_quadtree:capacity=${capacity}`, options: { capacity } };
  }
  return { spec: `paper_${algorithm}`, options: {} };
}

const scenes = 400;

for (const algorithm of algorithms) {
  test(`${algorithm}: the pairs and the tests are those of the C++`, () => {
    for (let seed = 0; seed < scenes; ++seed) {
      const boxes = sceneOf(seed);
      const { spec, options } = optionsOf(algorithm, seed);
      const told = steps(algorithm, boxes, options);
      const observed = engine.observe(spec, boxes, 2);
      const at = `${spec}, scene ${seed}`;
      assert.equal(told.tests, observed.statistics.tests, at);
      assert.deepEqual(told.pairs.map(([a, b]) => `${a}-${b}`), named(observed.pairs), at);
      const tested = told.steps.filter(({ outcome }) => outcome === "test").map(({ pair }) => pair!);
      assert.deepEqual(tested.map(([a, b]) => `${Math.min(a, b)}-${Math.max(a, b)}`), named(observed.tests), at);
      const reported = told.steps.filter(({ outcome }) => outcome === "reported").map(({ pair }) => pair!);
      assert.equal(reported.length, told.pairs.length, at);
    }
  });

  test(`${algorithm}: each step is at a line of the listing and says something`, () => {
    const { listing, steps: all } = steps(algorithm, sceneOf(11), { capacity: 2 });
    assert.ok(all.length > 10);
    for (const step of all) {
      assert.notEqual(listing[step.line]?.trim() ?? "", "");
      assert.notEqual(step.text, "");
      assert.equal(step.state.kind, algorithm);
    }
  });
}

/** Numbers as (min x, min y, max x, max y) of boxes. */
const few = Float32Array.from([0, 0, 2, 2, 1, 1, 3, 3, 5, 1, 6, 2, 2, 5, 3, 6, 5, 5, 8, 8, 6, 6, 7, 7]);

test("grid: insertion is shown cell by cell, and the cells keep what earlier steps showed", () => {
  const { steps: all } = steps("grid", few, { cell: 2 });
  const states = all.map(({ state }) => state as GridState);
  const references = states.map(({ cells }) => cells.reduce((sum, cell) => sum + cell.length, 0));
  assert.ok(references.every((count, step) => step === 0 || count >= references[step - 1]! && count - references[step - 1]! <= 1));
  assert.equal(references.at(-1), engine.find("paper_grid:cell=2", few, 2).statistics.references);
  const outline = engine.outline("paper_grid:cell=2", few, 2);
  assert.equal(states.at(-1)!.cells.length, outline.levels[0]!.length / 4);
});

test("sweep_and_prune: the active list holds the boxes that the line still meets", () => {
  const { steps: all, listing } = steps("sweep_and_prune", few);
  for (const { state, outcome, line } of all) {
    const { active, position, order, next } = state as SweepState;
    if (outcome !== "test") continue;
    assert.equal(listing[line]!.trim().startsWith("if Test Collide"), true);
    for (const id of active) assert.ok(few[4 * id + 2]! >= position);
    assert.equal(few[4 * order[next]!], position);
  }
});

test("bvh: each box is in one leaf within the bounds of all nodes above, and all pairs are found", () => {
  for (let seed = 0; seed < 60; ++seed) {
    const boxes = sceneOf(seed);
    const told = steps("bvh", boxes, { capacity: 2 + seed % 3 });
    assert.deepEqual(told.pairs.map(([a, b]) => `${a} ${b}`).sort(), pairsByDefinition(boxes, 2));
    assert.equal(new Set(told.pairs.map(String)).size, told.pairs.length);
    if (told.steps.length === 0) continue;
    const { nodes } = told.steps.at(-1)!.state as BvhState;
    const held = nodes.flatMap((node) => node.boxes);
    assert.deepEqual([...held].sort((a, b) => a - b), [...new Set(held)].sort((a, b) => a - b));
    for (const { box, boxes: ids, children } of nodes) {
      const below = [...ids.map((id) => [...boxes.subarray(4 * id, 4 * id + 4)]), ...children.map((child) => nodes[child]!.box)];
      for (const [left, top, right, bottom] of below as number[][])
        assert.ok(box[0] <= left! && box[1] <= top! && box[2] >= right! && box[3] >= bottom!);
    }
  }
});

test("bvh: each step is at a line of the listing, and few boxes are tested", () => {
  const boxes = randomBoxes(3, 40, { dimension: 2, places: 400, maxExtent: 9 });
  const { listing, steps: all, tests } = steps("bvh", boxes, { capacity: 3 });
  for (const step of all) assert.notEqual(listing[step.line]?.trim() ?? "", "");
  assert.ok(tests < 40 * 39 / 4, `${tests} tests`);
});

test("quadtree: boxes end in the leaves, as many as the C++ has references", () => {
  for (let seed = 0; seed < 40; ++seed) {
    const boxes = sceneOf(seed);
    const { steps: all } = steps("quadtree", boxes, { capacity: 2 });
    if (all.length === 0) continue;
    const { nodes } = all.at(-1)!.state as QuadtreeState;
    const leaves = nodes.filter(({ children }) => children === undefined);
    assert.ok(nodes.every(({ children, boxes: held }) => children === undefined || held.length === 0));
    assert.equal(leaves.reduce((sum, leaf) => sum + leaf.boxes.length, 0),
                 engine.find("paper_quadtree:capacity=2", boxes, 2).statistics.references);
    assert.equal(nodes.length,
                 engine.outline("paper_quadtree:capacity=2", boxes, 2).levels.reduce((sum, level) => sum + level.length / 4, 0));
  }
});

test("too many boxes are refused before the page runs out of memory", () => {
  const boxes = randomBoxes(1, 1500, { dimension: 2, places: 9000, maxExtent: 3 });
  assert.throws(() => steps("brute_force", boxes), /more than 300000 steps; expected fewer boxes/);
});

test("what is no box is refused", () => {
  assert.throws(() => steps("grid", Float32Array.from([1, 1, 0, 2])), /box 0 is \[1, 0\] x \[1, 2\]; expected min <= max/);
  assert.throws(() => steps("grid", new Float32Array(5)), /5 numbers of boxes; expected a multiple of 4/);
  assert.throws(() => steps("grid", few, { cell: 0 }), /cell is 0; expected a number above 0/);
  assert.throws(() => steps("bvh", few, { capacity: 1 }), /capacity is 1; expected a whole number of at least 2/);
  assert.throws(() => steps("quadtree", few, { capacity: 0 }), /capacity is 0; expected a whole number of at least 1/);
});

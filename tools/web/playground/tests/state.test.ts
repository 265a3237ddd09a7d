// The state in an address and back; edits; specs; code to copy.
import assert from "node:assert/strict";
import { test } from "node:test";

import { sceneEntries } from "../scene/catalogue.ts";
import { edited, withEdit, type Edit } from "../scene/edits.ts";
import { linesFor } from "../state/lines.ts";
import { nameOf, settingsOf, withSetting } from "../state/spec.ts";
import { defaultState, startOf, type State } from "../state/state.ts";
import { readState, writeState } from "../state/url.ts";

const edit: Edit = { box: 3, time: 1.5, x: 20, y: 30, width: 4, height: 5, vx: 6, vy: -7 };

test("an address holds the whole state", () => {
  const state: State = {
    mode: "steps",
    scene: { name: "huge_floor", count: 1234, seed: 7, knobs: { ratio: 20, clustering: 0.5, moving: 0.25, speed: 2 } },
    edits: [edit, { ...edit, box: 1300, width: -1 }],
    panels: [{ spec: "grid:cell=4:update=follow", follow: true }, { spec: "paper_quadtree:capacity=3", follow: false }],
    panel: 1, structure: false, up: true, overlaps: false, selected: 12, playing: false, pace: 0.5, lesson: 0,
    steps: { algorithm: "quadtree", at: 17, count: 9, cell: 1.5, capacity: 2 },
    embed: true,
  };
  const { state: read, time, faults } = readState("", `#${writeState(state, 3.25)}`);
  assert.deepEqual(read, state);
  assert.deepEqual(faults, []);
  assert.equal(time, 3.25);
});

test("the default state is an empty address, and an empty address the default state", () => {
  assert.equal(writeState(defaultState, 0), "");
  assert.deepEqual(readState("", "").state, defaultState);
});

test("a link that names only a scene shows what the menu shows", () => {
  const { state } = readState("", "#scene=huge_floor");
  assert.deepEqual(state.panels, [{ spec: "paper_quadtree", follow: false }, { spec: "auto", follow: false }]);
  assert.equal(state.scene.count, 400);
  assert.equal(writeState(state, 0), "scene=huge_floor");
  for (const { name, count } of sceneEntries) {
    const read = readState("", `#scene=${name}`).state;
    assert.deepEqual([read.scene.count, read.panels], [count, startOf(name).panels]);
    const other: State = { ...read, panels: defaultState.panels, scene: { ...read.scene, count: 7 } };
    assert.deepEqual(readState("", writeState(other, 0)).state, other);
  }
});

test("what an address says wrongly is as usual, and numbers keep to their range", () => {
  const { state } = readState("?embed", "#n=1e9&ratio=none&a=;;&edits=1_2~x&box=1.6&lesson=99&pace=");
  assert.equal(state.embed, true);
  assert.equal(state.scene.count, 100_000);
  assert.equal(state.scene.knobs.ratio, defaultState.scene.knobs.ratio);
  assert.deepEqual(state.panels, defaultState.panels);
  assert.deepEqual(state.edits, []);
  assert.equal(state.lesson, 6);
  assert.equal(state.pace, 1);
});

test("an address that is wrong says so, and what is taken instead", () => {
  const { faults, state } = readState("", "#scene=drfit&n=abc&steps=octree&lesson=9&a=grid;bvh;auto;grid;grid&edits=1_2~x&foo=3");
  assert.deepEqual(faults.map((fault) => fault.split(":")[0]), ["foo=3", "a", "scene=drfit", "edits", "lesson=9", "n=abc", "steps=octree"]);
  assert.match(faults.join(), /n=abc: expected a number from 1 to 100,000; the page takes 400/);
  assert.equal(state.scene.name, "drift");
  assert.equal(state.panels.length, 4);
  assert.deepEqual(readState("?embed", "#n=5&pace=0.5&a=grid").faults, []);
});

test("a thrown box flies, bounces and was where it was before", () => {
  const boxes = new Float32Array(16);
  const bounds = [0, 0, 100, 100];
  const at = (time: number): number[] => [...edited(boxes, [edit], time, bounds).subarray(12, 16)];
  assert.deepEqual(at(1), [0, 0, 0, 0]);
  assert.deepEqual(at(1.5), [18, 27.5, 22, 32.5]);
  assert.deepEqual(at(2.5), [24, 20.5, 28, 25.5]);
  // It meets the upper wall after 27.5 / 7 seconds.
  assert.ok(at(1.5 + 5)[1]! > 0 && at(1.5 + 5)[1]! < 10);
});

test("an added box is absent before its time, a removed one afterwards", () => {
  const bounds = [0, 0, 100, 100];
  const added: Edit = { ...edit, box: 1, time: 1 };
  const edits = withEdit([added], { ...added, time: 2, width: -1 });
  const there = (time: number): boolean => {
    const boxes = edited(new Float32Array(4), edits, time, bounds);
    return boxes[4]! <= boxes[6]!;
  };
  assert.deepEqual([0.5, 1.5, 2.5].map(there), [false, true, false]);
});

test("specs come apart and together", () => {
  assert.equal(nameOf("grid:cell=4:update=follow"), "grid");
  assert.deepEqual([...settingsOf("grid:cell=4:update=follow")], [["cell", "4"], ["update", "follow"]]);
  assert.equal(withSetting("grid:cell=4:update=follow", "cell", undefined), "grid:update=follow");
  assert.equal(withSetting("grid", "cell", "2"), "grid:cell=2");
});

test("lines to copy name the algorithm, and the draft's by the library's of its kind", () => {
  assert.match(linesFor("C++", "grid:cell=4", 2, false), /find_pairs\(boxes, \{\.algorithm = "grid:cell=4"\}\)/);
  assert.match(linesFor("C++", "auto", 3, true), /World3 world;/);
  assert.match(linesFor("Python", "paper_quadtree:capacity=3", 2, false), /pairs\(boxes, algorithm="quadtree"\)/);
  assert.match(linesFor("JavaScript", "grid:cell=4", 2, false),
    /broadside\.pairs\(boxes, \{ dimension: 2, algorithm: "grid:cell=4" \}\)/);
});

// The bench with a naive engine: frames, edits, followers, the selected box.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Bench } from "../bench/bench.ts";
import { refusal } from "../bench/budget.ts";
import { duel } from "../bench/measure.ts";
import { Mark, type Reply, type Setup, type Shown } from "../bench/protocol.ts";
import { reasons } from "../bench/reasons.ts";
import { sceneEntries } from "../scene/catalogue.ts";
import { defaultKnobs } from "../scene/drift.ts";
import { median, RecentTimes, timeOf } from "../bench/times.ts";
import { asText, pairsByDefinition } from "./law.ts";
import { loadEngine } from "./naive_engine.ts";

const setup: Setup = {
  scene: { name: "drift", count: 60, seed: 1, knobs: defaultKnobs }, edits: [],
  panels: [{ spec: "grid", follow: false }], structure: true, overlaps: true, selected: -1,
};

async function bench(): Promise<{ frame: (time: number) => Promise<Shown>; take: Bench["take"] }> {
  let last: Reply | undefined;
  const one = new Bench(await loadEngine(), (reply) => { last = reply; });
  return {
    take: (request) => one.take(request),
    async frame(time) {
      await one.take({ kind: "frame", time, held: null });
      if (last?.kind !== "shown") throw new Error(JSON.stringify(last));
      return last.shown;
    },
  };
}

test("shows each scene's pairs, and marks their boxes", async () => {
  const { frame, take } = await bench();
  for (const { name, dimension } of sceneEntries) {
    await take({ kind: "setup", setup: { ...setup, scene: { ...setup.scene, name } } });
    const shown = await frame(2);
    assert.equal(shown.dimension, dimension, name);
    const expected = pairsByDefinition(shown.boxes, dimension);
    assert.deepEqual(asText(shown.pairs), expected, name);
    const lit = new Set(expected.flatMap((pair) => pair.split(" ").map(Number)));
    shown.marks.forEach((mark, box) => assert.equal(mark === Mark.lit, lit.has(box)));
    assert.equal(shown.overlaps.length / (2 * dimension), expected.length);
  }
});

test("a follower's pairs are those of each frame, also when time goes back", async () => {
  const { frame, take } = await bench();
  await take({ kind: "setup", setup: { ...setup, panels: [{ spec: "grid", follow: true }] } });
  for (const time of [0, 0.5, 1, 0.2]) {
    const shown = await frame(time);
    assert.deepEqual(asText(shown.pairs), pairsByDefinition(shown.boxes, 2));
  }
});

test("a box's tests and all the others add up", async () => {
  const { frame, take } = await bench();
  await take({ kind: "setup", setup: { ...setup, selected: 5 } });
  const selection = (await frame(0)).panels[0]!.selection!;
  const others = selection.untested.reduce((sum, { count }) => sum + count, 0);
  assert.equal(selection.tested.length + others, 59);
});

test("says what the structure kept apart, then what the sweep did, then where boxes lie", () => {
  // Two cells of 10; boxes 0, 1 and 2 in the first one.
  const boxes = Float32Array.from([0, 0, 1, 1, 5, 0, 6, 1, 0, 5, 1, 6, 12, 0, 13, 1]);
  const outline = {
    kind: "cells", caption: "", sweptAxis: 0, levels: [Float32Array.from([0, 0, 10, 10, 10, 0, 20, 10])],
  };
  const told = reasons(boxes, 2, 0, new Set(), outline).map(({ count, why }) => `${count} ${why}`);
  assert.equal(told.length, 3);
  assert.match(told[0]!, /^1 share no cell/);
  assert.match(told[1]!, /^1 end before it begins, .* on x/);
  assert.match(told[2]!, /^1 are apart from it on y/);
});

test("a file is a scene of its frames, and a link without it says so", async () => {
  const { frame, take } = await bench();
  const file: Setup = { ...setup, scene: { ...setup.scene, name: "file" } };
  await take({ kind: "setup", setup: file });
  await assert.rejects(frame(0), /no scene was set up/);
  const text = "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n0,1,5,5,6,6\n1,0,0,0,5,5\n";
  await take({ kind: "file", name: "boxes.csv", bytes: new TextEncoder().encode(text), columns: "" });
  await take({ kind: "setup", setup: file });
  assert.equal((await frame(0)).pairs.length, 0);
  assert.equal((await frame(0.06)).pairs.length, 2);
});

test("a file without boxes says so", async () => {
  const replies: Reply[] = [];
  const one = new Bench({ ...await loadEngine(), read: () => ({ dimension: 2, frames: [new Float32Array()], warning: "" }) },
    (reply) => replies.push(reply));
  await one.take({ kind: "file", name: "boxes.csv", bytes: new Uint8Array(), columns: "" });
  assert.match(JSON.stringify(replies), /boxes\.csv: the file holds no boxes/);
});

test("with a clock of 0.1 ms, a search of a microsecond has its time, and not 0", async (context) => {
  let now = 0;
  context.mock.method(performance, "now", () => Math.floor((now += 1e-4) * 10) / 10);
  const engine = {
    ...await loadEngine(),
    time: (_: string, __: Float32Array, ___: number, runs: number) => {
      const begin = performance.now();
      now += runs * 1e-3;
      return performance.now() - begin;
    },
  };
  const time = timeOf(engine, "grid", new Float32Array(4), 2, 5);
  assert.ok(Math.abs(time - 1e-3) < 1e-4, `${time} ms`);
});

test("frames that the clock did not see have no time, and some of them a mean", () => {
  const times = new RecentTimes();
  assert.ok(Number.isNaN(times.add(0)));
  assert.equal(times.add(0.1), 0.05);
  assert.equal(median([3, 1, 2]), 2);
});

test("a race has its order drawn anew each round, and says what auto took and whether the machine was busy", async () => {
  const order: string[] = [];
  const engine = {
    ...await loadEngine(),
    find: () => ({ pairs: new Uint32Array(), statistics: { tests: 0, references: 0, cells: 0, hits: 0 }, milliseconds: 0,
      explanation: "grid, since there are few boxes" }),
    time: (spec: string, _: Float32Array, __: number, runs: number) => {
      if (order.at(-1) !== spec) order.push(spec);
      return runs * (spec === "bvh" && order.length % 2 === 0 ? 90 : 60);
    },
  };
  const { auto, chosen, others, unsteady } = await duel(engine, new Float32Array(4), 2);
  assert.equal(chosen, "grid");
  assert.equal(auto, others[0]!.milliseconds);
  assert.equal(unsteady, false, "only auto and the fastest count");
  const before = order.filter((_, at) => order[at + 1] === "auto");
  assert.ok(new Set(before).size > 2, `before auto came only ${[...new Set(before)].join()}`);
});

test("brute force is refused where it would stop the page", () => {
  assert.match(refusal("brute_force", 40_000)!, /800 million tests/);
  assert.equal(refusal("brute_force", 1000), undefined);
  assert.equal(refusal("grid", 100_000), undefined);
});

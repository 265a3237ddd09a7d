// The shadows of boxes on an axis.
import assert from "node:assert/strict";
import { test } from "node:test";

import { shadowsOn } from "../draw/shadows.ts";
import { randomBoxes } from "./boxes.ts";

test("shadows in a row do not overlap, and there are as many rows as shadows overlap at one place", () => {
  for (const axis of [0, 1] as const) {
    const boxes = randomBoxes(7, 60, { dimension: 2, places: 90, maxExtent: 9 });
    boxes.set([5, 5, 4, 4]);  // absent
    const shadows = shadowsOn(boxes, axis);
    assert.equal(shadows.length, 59);
    for (const a of shadows) {
      assert.deepEqual([a.from, a.to], [boxes[4 * a.box + axis], boxes[4 * a.box + 2 + axis]]);
      for (const b of shadows) assert.ok(a === b || a.row !== b.row || a.to < b.from || b.to < a.from);
    }
    const depths = shadows.map(({ from }) => shadows.filter((one) => one.from <= from && from <= one.to).length);
    assert.equal(Math.max(...shadows.map(({ row }) => row)) + 1, Math.max(...depths));
  }
});

// Each preset breaks the algorithm that it claims to break, and auto copes.
import assert from "node:assert/strict";
import { test } from "node:test";

import { loadEngine } from "../engine/engine.ts";
import type { Statistics } from "../engine/types.ts";
import { presets, type Preset } from "../presets.ts";
import { named, overlappingPairs } from "./boxes.ts";

const engine = await loadEngine();

/** Wasted tests per box: tests that found no pair, or found a pair again. */
function waste({ tests }: Statistics, pairs: number, boxes: number): number {
  return (tests - pairs) / boxes;
}

function wasteOfSearch(spec: string, { dimension, settings, boxes }: Preset, seed: number, time: number): number {
  const packed = boxes(settings.count, seed, time);
  const { tests, statistics, pairs } = engine.observe(spec, packed, dimension);
  assert.equal(tests.length / 2, statistics.tests);
  return waste(statistics, pairs.length / 2, settings.count);
}

/** The mean over two seconds of frames, each followed by one tracker. */
function wasteOfTracker(spec: string, { dimension, settings, boxes }: Preset, seed: number): number {
  const tracker = engine.tracker(spec, dimension);
  tracker.update(boxes(settings.count, seed, 0));
  let sum = 0;
  const frames = 40;
  for (let frame = 1; frame <= frames; ++frame) {
    const { statistics } = tracker.update(boxes(settings.count, seed, 2 * frame / frames));
    sum += waste(statistics, 0, settings.count);
  }
  tracker.free();
  return sum / frames;
}

/** Minimum waste of each, in tests per box, and as a multiple of the waste of auto. */
const minWaste: Record<string, { waste: number; times: number }> = {
  drifting_crowd: { waste: 150, times: 10 },
  huge_floor: { waste: 60, times: 3 },
  one_point: { waste: 1000, times: 100 },
  sorted_line: { waste: 400, times: 100 },
  teleporting: { waste: 15, times: 5 },
  one_huge_among_many: { waste: 150, times: 7 },
  falling_for_ever: { waste: 80, times: 8 },
  clustered: { waste: 40, times: 2 },
  pile_at_rest: { waste: 5, times: 100 },
  scaffold: { waste: 120, times: 1.5 },
  flat_city: { waste: 250, times: 10 },
};

for (const preset of presets) {
  test(`${preset.name} breaks ${preset.breaks}`, () => {
    for (const seed of [1, 2, 3]) {
      const wasteOf = (spec: string): number =>
        preset.follows ? wasteOfTracker(spec, preset, seed) : wasteOfSearch(spec, preset, seed, 1);
      const broken = wasteOf(preset.breaks);
      const auto = wasteOf("auto");
      const { waste: mostly, times } = minWaste[preset.name]!;
      const found = `${broken.toFixed(1)} tests a box for nothing, auto ${auto.toFixed(1)}`;
      assert.ok(broken >= mostly, `${found}; expected at least ${mostly}`);
      assert.ok(broken >= times * auto, `${found}; expected at least ${times} times auto's`);
    }
  });

  test(`${preset.name} is a function of count, seed and time`, () => {
    for (const count of [0, 1, 2, 57, preset.count]) {
      for (const time of [0, 0.4, 12.5, 600]) {
        const boxes = preset.boxes(count, 5, time);
        assert.equal(boxes.length, 2 * preset.dimension * count);
        assert.ok(boxes.every(Number.isFinite));
        assert.deepEqual(boxes, preset.boxes(count, 5, time));
        assert.deepEqual(named(engine.find("auto", boxes, preset.dimension).pairs).sort(),
                         overlappingPairs(boxes, preset.dimension));
      }
    }
    assert.equal(preset.count, preset.settings.count);
    assert.match(preset.summary, /^[A-Z].*\.$/);
    assert.match(preset.why, /^[A-Z].*\.$/);
  });
}

test("the playground opens with some hundred boxes that drift", () => {
  const [first] = presets;
  assert.deepEqual([first!.name, first!.count, first!.dimension], ["drifting_crowd", 400, 2]);
  assert.notDeepEqual(first!.boxes(400, 1, 0), first!.boxes(400, 1, 0.1));
  assert.ok(presets.filter(({ dimension }) => dimension === 3).length >= 2);
});

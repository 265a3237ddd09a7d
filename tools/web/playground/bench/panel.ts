// One algorithm on the boxes of a frame: its search or its tracker, its structure, and the selected
// box's tests.
import type { Engine } from "../engine/types.ts";
import type { Dimension } from "../scene/scene.ts";
import { maxObserved, refusal } from "./budget.ts";
import { Follower } from "./followers.ts";
import { Mark, type PanelChoice, type PanelResult, type Selection, type Setup } from "./protocol.ts";
import { reasons } from "./reasons.ts";
import { coarse, RecentTimes, timeOf } from "./times.ts";

const nothing = { tests: 0, references: 0, cells: 0, hits: 0 };

/** A search that takes longer than this, in ms, does not run in every frame. */
const slow = 60;

/** How often a search that is too short for the clock is measured in batches, and for how long, in ms. */
const batchEvery = 500;
const batchBudget = 6;

export interface PanelFrame {
  result: PanelResult;
  /** Undefined if it did not search in this frame. */
  pairs: Uint32Array | undefined;
}

export class Panel {
  private follower: Follower | undefined;
  private last: PanelResult | undefined;
  private notBefore = 0;
  private readonly times = new RecentTimes();
  private batched = NaN;
  private batchedAt = -Infinity;

  constructor(private readonly engine: Engine, readonly choice: PanelChoice) {}

  frame(boxes: Float32Array, dimension: Dimension, setup: Setup): PanelFrame {
    const { spec } = this.choice;
    const count = boxes.length / (2 * dimension);
    const failed = (error: string): PanelFrame => ({
      pairs: undefined,
      result: {
        spec, error, pairs: 0, statistics: nothing, explanation: "", milliseconds: 0, bytes: 0, begun: 0, ended: 0,
        late: false,
      },
    });
    const refused = refusal(spec, count);
    if (refused !== undefined) return failed(refused);
    if (this.last !== undefined && performance.now() < this.notBefore) {
      // Marks were transferred with their frame.
      const { marks: _, ...result } = this.last;
      return { result: { ...result, late: true }, pairs: undefined };
    }
    const begin = performance.now();
    try {
      const found = this.search(boxes, dimension);
      if (setup.structure) found.result.outline = this.engine.outline(spec, boxes, dimension, this.choice.follow);
      if (setup.selected >= 0 && setup.selected < count) this.observe(found.result, boxes, dimension, setup.selected);
      const took = performance.now() - begin;
      // Leaves a third of the bench's time to the other panels.
      this.notBefore = took > slow ? performance.now() + 2 * took : 0;
      this.last = found.result;
      return found;
    } catch (error) {
      this.free();
      return failed(error instanceof Error ? error.message : String(error));
    }
  }

  free(): void {
    this.follower?.free();
    this.follower = undefined;
  }

  private search(boxes: Float32Array, dimension: Dimension): PanelFrame {
    const { spec, follow } = this.choice;
    if (!follow) {
      const { pairs, statistics, explanation, ...found } = this.engine.find(spec, boxes, dimension);
      const milliseconds = this.timeOf(found.milliseconds, boxes, dimension);
      return {
        pairs,
        result: {
          spec, statistics, explanation, pairs: pairs.length / 2, milliseconds, bytes: 0,
          begun: 0, ended: 0, late: false,
        },
      };
    }
    if (this.follower?.dimension !== dimension) this.free();
    this.follower ??= new Follower(this.engine, spec, dimension);
    const { begun, ended, statistics, milliseconds, bytes } = this.follower.update(boxes);
    // The first update finds all pairs, and its time says nothing about later ones.
    const time = this.last === undefined ? NaN : this.times.add(milliseconds);
    return {
      pairs: this.follower.current(),
      result: {
        spec, statistics, bytes, explanation: "", pairs: this.follower.size, milliseconds: time,
        begun: begun.length / 2, ended: ended.length / 2, late: false,
      },
    };
  }

  /**
   * The time of a search: the median of the last frames, or of batches where `once`, the time of a single run, is too
   * short for the clock. The first run does not count, since it also allocates memory.
   */
  private timeOf(once: number, boxes: Float32Array, dimension: Dimension): number {
    const isDue = !(this.batched > coarse) && performance.now() - this.batchedAt > batchEvery;
    if (once <= slow && isDue) {
      this.batched = timeOf(this.engine, this.choice.spec, boxes, dimension, batchBudget);
      this.batchedAt = performance.now();
      if (this.batched > coarse) return this.times.add(this.batched);
    }
    return this.batched <= coarse ? this.batched : this.times.add(once);
  }

  private observe(result: PanelResult, boxes: Float32Array, dimension: Dimension, box: number): void {
    const { spec } = this.choice;
    const count = boxes.length / (2 * dimension);
    const expected = /brute_force/.test(spec) ? count * (count - 1) / 2 : result.statistics.tests;
    if (expected > maxObserved) {
      result.unobserved = "There are too many tests to record. Take fewer boxes.";
      return;
    }
    const { tests, pairs } = this.engine.observe(spec, boxes, dimension);
    // The tests are those of a search, also if a tracker keeps something else.
    const outline = this.choice.follow || result.outline === undefined
      ? this.engine.outline(spec, boxes, dimension) : result.outline;
    const tested = partners(tests, box);
    const met = partners(pairs, box);
    result.selection = {
      box, tested: Uint32Array.from(tested), hits: met.size, tests: tests.length / 2,
      untested: reasons(boxes, dimension, box, tested, outline),
    } satisfies Selection;
    const marks = new Uint8Array(count).fill(Mark.faded);
    for (const one of tested) marks[one] = Mark.tested;
    for (const one of met) marks[one] = Mark.testedLit;
    marks[box] = Mark.selected;
    result.marks = marks;
  }
}

/** The boxes that form a pair with one box. */
function partners(pairs: Uint32Array, box: number): Set<number> {
  const found = new Set<number>();
  for (let at = 0; at < pairs.length; at += 2) {
    if (pairs[at] === box) found.add(pairs[at + 1]!);
    else if (pairs[at + 1] === box) found.add(pairs[at]!);
  }
  return found;
}

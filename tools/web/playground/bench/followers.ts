// A tracker for a panel, and the current pairs by its events.
import type { Engine, Frame, Tracker } from "../engine/types.ts";
import type { Dimension } from "../scene/scene.ts";

export class Follower {
  private readonly pairs = new Map<number, readonly [number, number]>();
  private tracker: Tracker;

  constructor(engine: Engine, readonly spec: string, readonly dimension: Dimension) {
    this.tracker = engine.tracker(spec, dimension);
  }

  update(boxes: Float32Array): Frame {
    const frame = this.tracker.update(boxes);
    for (let at = 0; at < frame.ended.length; at += 2)
      this.pairs.delete(key(frame.ended[at]!, frame.ended[at + 1]!));
    for (let at = 0; at < frame.begun.length; at += 2) {
      const [a, b] = [frame.begun[at]!, frame.begun[at + 1]!];
      this.pairs.set(key(a, b), [a, b]);
    }
    return frame;
  }

  get size(): number {
    return this.pairs.size;
  }

  current(): Uint32Array {
    const all = new Uint32Array(2 * this.pairs.size);
    let at = 0;
    for (const [a, b] of this.pairs.values()) {
      all[at++] = a;
      all[at++] = b;
    }
    return all;
  }

  free(): void {
    this.tracker.free();
  }
}

/** One number for a pair: ids are below 2^26 here. */
function key(a: number, b: number): number {
  return Math.min(a, b) * 2 ** 26 + Math.max(a, b);
}

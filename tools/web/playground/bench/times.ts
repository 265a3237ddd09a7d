// Times with a coarse clock: browsers round to a tenth of a millisecond, and a search may take
// microseconds.
import type { Engine } from "../engine/types.ts";
import type { Dimension } from "../scene/scene.ts";

/** Up to this time, in ms, a single measurement is too coarse. */
const coarse = 0.5;

/**
 * Summarises the times of the last frames: the median, or the mean if the clock is too coarse for
 * it.
 */
export class RecentTimes {
  private readonly recent: number[] = [];

  add(milliseconds: number): number {
    this.recent.push(milliseconds);
    if (this.recent.length > 40) this.recent.shift();
    const sorted = [...this.recent].sort((a, b) => a - b);
    const median = sorted[Math.floor(sorted.length / 2)]!;
    if (median > coarse) return median;
    // Without outliers, which other work on the machine has caused.
    const usual = sorted.filter((one) => one <= coarse);
    return usual.reduce((sum, one) => sum + one, 0) / Math.max(1, usual.length);
  }
}

/**
 * The time of a search: the shortest of some rounds, each with enough runs for the clock's
 * resolution.
 */
export function timeOf(engine: Engine, spec: string, boxes: Float32Array, dimension: Dimension, budget: number): number {
  const begin = performance.now();
  const first = engine.find(spec, boxes, dimension).milliseconds;
  if (first > budget) return first;
  const runs = Math.min(60, Math.ceil(2 / Math.max(first, 0.02)));
  let best = Infinity;
  do {
    let sum = 0;
    for (let run = 0; run < runs; ++run) sum += engine.find(spec, boxes, dimension).milliseconds;
    best = Math.min(best, sum / runs);
  } while (performance.now() - begin < budget);
  return best;
}

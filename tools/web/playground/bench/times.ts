// Times on a clock that browsers make coarse: a tenth of a millisecond, where a search may take some microseconds.
import type { Engine } from "../engine/types.ts";
import type { Dimension } from "../scene/scene.ts";

/** Up to here, in ms, a single time says little. */
const coarse = 0.5;

/** The times of the last frames as one: the median, or the mean where the clock is too coarse for it. */
export class RecentTimes {
  private readonly recent: number[] = [];

  add(milliseconds: number): number {
    this.recent.push(milliseconds);
    if (this.recent.length > 40) this.recent.shift();
    const sorted = [...this.recent].sort((a, b) => a - b);
    const median = sorted[Math.floor(sorted.length / 2)]!;
    if (median > coarse) return median;
    // Without what something else on the machine has added.
    const usual = sorted.filter((one) => one <= coarse);
    return usual.reduce((sum, one) => sum + one, 0) / Math.max(1, usual.length);
  }
}

/** The time of a search: of as many runs as the clock can tell, the least of some rounds. */
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

// Times with a coarse clock: browsers round to a tenth of a millisecond or more, and a search may
// take microseconds.
import type { Engine } from "../engine/types.ts";
import type { Dimension } from "../scene/scene.ts";

/** Up to this time, in ms, a single measurement is too coarse. */
export const coarse = 0.5;

/** The number of frames whose times are kept. */
const maxRecent = 40;

/** A batch of runs takes at least this many ticks of the clock: its time is then right to 5 %. */
const minTicks = 20;

/**
 * With a very coarse clock, batches of 20 ticks would take seconds; with a very fine one, an interruption would be most of
 * a batch. In ms.
 */
const maxBatch = 60;
const minBatch = 0.5;

export function median(values: readonly number[]): number {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[middle]! : (sorted[middle - 1]! + sorted[middle]!) / 2;
}

/** How far the middle half of the values lies apart, as a part of their median. */
export function spread(values: readonly number[]): number {
  const sorted = [...values].sort((a, b) => a - b);
  const quarter = sorted.length >> 2;
  return (sorted[sorted.length - 1 - quarter]! - sorted[quarter]!) / median(values);
}

/** A step of the clock, in ms. */
function clockTick(): number {
  const begin = performance.now();
  let now = begin;
  while (now === begin) now = performance.now();
  return now - begin;
}

/**
 * Summarises the times of the last frames: the median, or the mean if the clock is too coarse for
 * it. NaN if the clock saw none of them.
 */
export class RecentTimes {
  private readonly recent: number[] = [];

  add(milliseconds: number): number {
    this.recent.push(milliseconds);
    if (this.recent.length > maxRecent) this.recent.shift();
    const typical = median(this.recent);
    if (typical > coarse) return typical;
    // Without outliers, which other work on the machine has caused.
    const usual = this.recent.filter((one) => one <= coarse);
    return usual.reduce((sum, one) => sum + one, 0) / usual.length || NaN;
  }
}

/**
 * Prepares batches of a search: the number of runs is doubled until a batch takes long enough for
 * the clock. Each call of the result times a batch, and returns the milliseconds of one run.
 */
export function batchesOf(engine: Engine, spec: string, boxes: Float32Array, dimension: Dimension): () => number {
  const enough = Math.max(minBatch, Math.min(maxBatch, minTicks * clockTick()));
  engine.time(spec, boxes, dimension, 1);  // the first run allocates memory
  let runs = 1;
  return () => {
    // Also later: a batch that was interrupted by other programs seemed long enough.
    for (;; runs *= 2) {
      const took = engine.time(spec, boxes, dimension, runs);
      if (took >= enough) return took / runs;
    }
  };
}

/** The time of a search: the median of the batches that `budget` has room for. In ms. */
export function timeOf(engine: Engine, spec: string, boxes: Float32Array, dimension: Dimension, budget: number): number {
  const batch = batchesOf(engine, spec, boxes, dimension);
  batch();
  const begin = performance.now();
  const times: number[] = [];
  do times.push(batch()); while (performance.now() - begin < budget);
  return median(times);
}

// Ratios of times with their intervals, and their texts.
import type { Ratio } from "./data.ts";
import { ratioText } from "./numbers.ts";

export type Interval = readonly [low: number, high: number];

/**
 * The interval of a ratio; undefined if it has none, such as the ratio of an algorithm to itself,
 * which is 1.
 */
export function intervalOf({ low, high }: Ratio): Interval | undefined {
  return low === null || high === null || low === high ? undefined : [low, high];
}

/** Whether the two cannot be told apart: the interval contains 1. */
export function isLevel(ratio: Ratio): boolean {
  const interval = intervalOf(ratio);
  return interval !== undefined && interval[0] <= 1 && interval[1] >= 1;
}

/** Whether the text says that the two are level: isLevel(), and the interval is not wide. */
function readsLevel(ratio: Ratio): boolean {
  const wide = 1.5;
  const [low, high] = intervalOf(ratio) ?? [0, Infinity];
  return isLevel(ratio) && low >= 1 / wide && high <= wide;
}

/**
 * "19 (18 to 20)", "1.0 (level)", "2.1 (0.60 to 7.0)", or the ratio alone if it has no interval.
 */
export function intervalText(ratio: Ratio): string {
  const interval = intervalOf(ratio);
  if (interval === undefined) return ratioText(ratio.median);
  return `${ratioText(ratio.median)} (${readsLevel(ratio) ? "level" : interval.map(ratioText).join(" to ")})`;
}

/** The short form: "19", "level". */
export function shortRatioText(ratio: Ratio): string {
  return readsLevel(ratio) ? "level" : ratioText(ratio.median);
}

// Ratios of times with their intervals, and how they are shown.
import type { Ratio } from "./data.ts";
import { ratioText } from "./numbers.ts";

export type Interval = readonly [low: number, high: number];

/** The interval of a ratio; undefined where there is none, as of an algorithm's ratio to itself, which is just 1. */
export function intervalOf({ low, high }: Ratio): Interval | undefined {
  return low === null || high === null || low === high ? undefined : [low, high];
}

/** Whether nothing tells the two apart: the interval holds 1. */
export function isLevel(ratio: Ratio): boolean {
  const interval = intervalOf(ratio);
  return interval !== undefined && interval[0] <= 1 && interval[1] >= 1;
}

/** Whether to say that the two are level: isLevel() by an interval that is not wide. */
function readsLevel(ratio: Ratio): boolean {
  const wide = 1.5;
  const [low, high] = intervalOf(ratio) ?? [0, Infinity];
  return isLevel(ratio) && low >= 1 / wide && high <= wide;
}

/** "19 (18 to 20)", "1.0 (level)", "2.1 (0.60 to 7.0)", or the ratio alone where it has no interval. */
export function intervalText(ratio: Ratio): string {
  const interval = intervalOf(ratio);
  if (interval === undefined) return ratioText(ratio.median);
  return `${ratioText(ratio.median)} (${readsLevel(ratio) ? "level" : interval.map(ratioText).join(" to ")})`;
}

/** The same in short: "19", "level". */
export function shortRatioText(ratio: Ratio): string {
  return readsLevel(ratio) ? "level" : ratioText(ratio.median);
}

// Ratios of times with their intervals, and how they are shown.
import type { Ratio } from "./data.ts";
import { ratio_text } from "./numbers.ts";

export type Interval = readonly [low: number, high: number];

/** The interval of a ratio; undefined where there is none. */
export function intervalOf({ low, high }: Ratio): Interval | undefined {
  return low === null || high === null ? undefined : [low, high];
}

/** Whether nothing tells the two apart: the interval holds 1. */
export function isLevel(ratio: Ratio): boolean {
  const interval = intervalOf(ratio);
  return interval !== undefined && interval[0] <= 1 && interval[1] >= 1;
}

/** Whether the time is clearly the shorter one; without an interval, whether the ratio says so. */
export function isFaster(ratio: Ratio): boolean {
  return (intervalOf(ratio)?.[1] ?? ratio.median) < 1;
}

/** The other's time over this one's. */
export function inverse({ median, low, high, ...rest }: Ratio): Ratio {
  return { ...rest, median: 1 / median, low: high === null ? null : 1 / high, high: low === null ? null : 1 / low };
}

/** "19 (18 to 20)", "level (0.97 to 1.1)", or the ratio alone where it has no interval. */
export function intervalText(ratio: Ratio): string {
  const interval = intervalOf(ratio);
  if (interval === undefined) return ratio_text(ratio.median);
  return `${shortRatioText(ratio)} (${ratio_text(interval[0])} to ${ratio_text(interval[1])})`;
}

/** The same without the interval: "19", "level". */
export function shortRatioText(ratio: Ratio): string {
  return isLevel(ratio) ? "level" : ratio_text(ratio.median);
}

// Shared by all charts: axes, legend, tooltip, and a description for screen readers.
import type { EChartsOption } from "echarts";

import { short } from "./numbers.ts";
import type { Theme } from "./theme.ts";

/** Where and how a chart is shown. */
export interface Place {
  theme: Theme;
  /** In CSS pixels. */
  width: number;
}

/** A chart: its ECharts option, its height, and a description in words. */
export interface Drawn {
  option: EChartsOption;
  height: number;
  description: string;
}

export const font = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

export interface AxisSpec {
  name: string;
  unit: string;
  log: boolean;
}

export function axisName(axis: { name: string; unit: string }): string {
  return axis.unit === "" ? axis.name : `${axis.name} (${axis.unit})`;
}

/** Estimated width of a text at 12 px, on the high side; the same with and without a DOM. */
export function textWidth(text: string): number {
  return text.length * 7.2;
}

/** The text, shortened in the middle if it is longer than `maxLength` characters. */
export function shortened(text: string, maxLength: number): string {
  if (text.length <= maxLength) return text;
  const half = Math.floor((maxLength - 1) / 2);
  return `${text.slice(0, maxLength - 1 - half)}…${text.slice(text.length - half)}`;
}

const legendLine = 22;

/** Number of lines of a legend at a given width. */
function legendLines(names: readonly string[], width: number): number {
  let lines = 1;
  let used = 0;
  for (const name of names) {
    const item = textWidth(name) + 42;
    if (used > 0 && used + item > width - 16) {
      ++lines;
      used = 0;
    }
    used += item;
  }
  return lines;
}

export function legendHeight(names: readonly string[], width: number): number {
  return names.length < 2 ? 0 : legendLines(names, width) * legendLine + 6;
}

/**
 * Ticks and ends of a logarithmic axis: powers of ten, or also 2 and 5 times these if there are
 * few.
 */
export function logTicks(values: readonly number[]): { min: number; max: number; ticks: number[] } {
  const positive = values.filter((value) => value > 0);
  const lowest = Math.min(...positive);
  const highest = Math.max(...positive);
  const decades = Math.log10(highest / lowest);
  const steps = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 5];
  const ticks: number[] = [];
  for (let power = Math.floor(Math.log10(lowest)) - 1; power <= Math.ceil(Math.log10(highest)); ++power) {
    for (const step of steps) ticks.push(Number((step * 10 ** power).toPrecision(6)));
  }
  const first = ticks.findLastIndex((tick) => tick <= lowest * 1.0001);
  const last = ticks.findIndex((tick) => tick >= highest * 0.9999);
  const shown = ticks.slice(first, last + 1);
  const min = shown[0] ?? lowest;
  const max = shown[shown.length - 1] ?? highest;
  // At most about eight labels: for many decades, every second or third.
  const stride = Math.ceil(shown.length / 8);
  return { min, max, ticks: shown.filter((_, i) => i % stride === 0) };
}

type AxisPart = Record<string, unknown>;

/** A numeric axis over `values`. */
export function valueAxis(axis: AxisSpec, values: readonly number[], place: Place): AxisPart {
  const { theme } = place;
  const style = {
    axisLine: { show: false },
    axisTick: { show: false },
    splitLine: { show: true, lineStyle: { color: theme.line, width: 1 } },
    axisLabel: { color: theme.muted, fontSize: 12, hideOverlap: true, formatter: (value: number) => short(value) },
  };
  if (!axis.log || !values.some((value) => value > 0)) return { type: "value", scale: true, ...style };
  const { min, max, ticks } = logTicks(values);
  return {
    type: "log",
    min,
    max: max > min ? max : min * 10,
    ...style,
    axisLabel: { ...style.axisLabel, customValues: ticks },
    axisTick: { show: false, customValues: ticks },
  };
}

export function categoryAxis(labels: readonly string[], place: Place): AxisPart {
  const { theme } = place;
  return {
    type: "category",
    data: [...labels],
    axisLine: { lineStyle: { color: theme.line } },
    axisTick: { show: false },
    splitLine: { show: false },
    axisLabel: { color: theme.muted, fontSize: 12 },
  };
}

/** Title below the horizontal axis. */
export function below(name: string, place: Place): AxisPart {
  return {
    name,
    nameLocation: "middle",
    nameGap: 28,
    nameTextStyle: { color: place.theme.text, fontSize: 12 },
  };
}

/** Title above the vertical axis, starting at its left end. */
export function above(name: string, place: Place): AxisPart {
  return {
    name,
    nameLocation: "end",
    nameGap: 10,
    nameTextStyle: { color: place.theme.text, fontSize: 12, align: "left", padding: [0, 0, 0, -36] },
  };
}

/** The base option of every chart. */
export function frame(names: readonly string[], description: string, place: Place): EChartsOption {
  const { theme } = place;
  const legend = legendHeight(names, place.width);
  return {
    animation: false,
    backgroundColor: "transparent",
    textStyle: { fontFamily: font, color: theme.text },
    aria: { enabled: true, label: { enabled: true, description } },
    legend: {
      show: legend > 0,
      top: 0,
      left: 0,
      width: place.width - 8,
      itemGap: 14,
      itemWidth: 22,
      itemHeight: 10,
      textStyle: { color: theme.text, fontSize: 12 },
      inactiveColor: theme.line,
      data: [...names],
    },
    tooltip: {
      confine: true,
      backgroundColor: theme.background,
      borderColor: theme.line,
      textStyle: { color: theme.text, fontSize: 12 },
    },
  };
}

const symbols = ["circle", "rect", "triangle", "diamond", "emptyCircle", "emptyRect", "emptyTriangle", "emptyDiamond"];
const dashes = ["solid", "dashed", "dotted"] as const;

/** Symbols and dashes that distinguish lines without colour. */
export function mark(index: number): { symbol: string; dash: (typeof dashes)[number] } {
  return {
    symbol: symbols[index % symbols.length] ?? "circle",
    dash: dashes[Math.floor(index / symbols.length) % dashes.length] ?? "solid",
  };
}

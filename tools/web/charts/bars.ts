// Bar charts: one bar per label. Bars are horizontal if labels are long or many, so that they stay
// readable.
import { above, axisName, below, categoryAxis, frame, shortened, textWidth, valueAxis } from "./frame.ts";
import type { AxisSpec, Drawn, Place } from "./frame.ts";
import { rounded } from "./numbers.ts";
import type { Interval } from "./ratios.ts";
import { whiskerSeries } from "./whiskers.ts";

export interface BarsSpec {
  title: string;
  x: { name: string; unit: string };
  y: AxisSpec;
  labels: readonly string[];
  /** Value of each label, or null for none. */
  values: readonly (number | null)[];
  /** Colour of each label. */
  colours: readonly string[];
  /** Start of the bars, marked by a line. */
  from: number;
  /** Text at each label's bar: a short one, and a full one for charts with enough room. */
  texts?: readonly { short: string; full: string }[];
  /** Interval of each label's value, if any. */
  whiskers?: readonly (Interval | undefined)[];
}

function describe(spec: BarsSpec, text: (value: number, at: number) => string): string {
  const maxBars = 40;
  const parts = spec.labels.slice(0, maxBars).map((label, i) => {
    const value = spec.values[i];
    return ` ${label}: ${value === null || value === undefined ? "none" : text(value, i)}.`;
  });
  const more = spec.labels.length > maxBars ? ` And ${spec.labels.length - maxBars} more.` : "";
  return `${spec.title}. Bar chart of ${axisName(spec.y)} by ${axisName(spec.x)}.${parts.join("")}${more}`;
}

/** Draws the bars of `spec`, with the first label at the top or on the left. */
export function drawBars(spec: BarsSpec, place: Place): Drawn {
  const { theme } = place;
  const whiskers = spec.whiskers ?? [];
  const text = (value: number, at: number): string => spec.texts?.[at]?.full ?? rounded(value);
  const description = describe(spec, text);
  const widest = Math.max(0, ...spec.labels.map(textWidth));
  const lying = widest > (place.width - 60) / Math.max(1, spec.labels.length) - 10 || spec.labels.length > 12;
  const ends = [...spec.values.filter((value) => value !== null), ...whiskers.flatMap((interval) => interval ?? []), spec.from];
  const axis = valueAxis(spec.y, ends, place);
  const numberAxis: Record<string, unknown> = {
    ...axis,
    scale: false,
    ...(axis["min"] === undefined ? {} : { startValue: spec.from }),
  };
  const maxCharacters = place.width < 520 ? 22 : 42;
  const labels = spec.labels.map((label) => (lying ? shortened(label, maxCharacters) : label));
  const labelAxis = categoryAxis(labels, place);
  const height = lying ? 56 + spec.labels.length * 24 : Math.round(Math.min(360, Math.max(260, place.width * 0.5)));
  return {
    description,
    height,
    option: {
      ...frame([], description, place),
      grid: lying
        ? {
          left: Math.max(0, ...labels.map(textWidth)) + 12, right: 56, top: 6, bottom: 50, outerBoundsMode: "none",
        }
        : { left: 4, right: 20, top: 8, bottom: 8, outerBoundsMode: "same", outerBoundsContain: "all" },
      xAxis: lying
        ? { ...numberAxis, ...below(axisName(spec.y), place) }
        : { ...labelAxis, ...below(axisName(spec.x), place) },
      yAxis: lying
        ? { ...labelAxis, inverse: true, axisLabel: { color: theme.text, fontSize: 12, interval: 0 } }
        : { ...numberAxis, ...above(axisName(spec.y), place) },
      tooltip: {
        ...frame([], description, place).tooltip,
        trigger: "axis",
        axisPointer: { type: "shadow" },
        valueFormatter: (value: unknown, at: number) => (typeof value === "number" ? text(value, at) : "–"),
      },
      series: [{
        type: "bar" as const,
        name: axisName(spec.y),
        color: theme.muted,
        barMaxWidth: lying ? 20 : 48,
        data: spec.values.map((value, at) => ({
          value: value ?? "-",
          ...(spec.colours[at] === undefined ? {} : { itemStyle: { color: spec.colours[at] } }),
          // The whisker carries the text.
          ...(whiskers[at] === undefined ? {} : { label: { show: false } }),
        })),
        label: {
          show: true,
          position: lying ? "right" as const : "top" as const,
          color: theme.text,
          fontSize: 11,
          formatter: (bar: { dataIndex: number }) => {
            const value = spec.values[bar.dataIndex];
            return typeof value === "number" ? spec.texts?.[bar.dataIndex]?.short ?? text(value, bar.dataIndex) : "";
          },
        },
        markLine: {
          silent: true,
          symbol: "none",
          label: { show: false },
          lineStyle: { color: theme.text, type: "dashed" as const, width: 1 },
          data: [lying ? { xAxis: spec.from } : { yAxis: spec.from }],
        },
      }, ...(whiskers.some((interval) => interval !== undefined) ? [whiskerSeries({
        whiskers, texts: (spec.texts ?? []).map(({ short }) => short), from: spec.from, lying,
      }, place)] : [])],
    },
  };
}

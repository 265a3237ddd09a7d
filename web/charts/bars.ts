// Bars, or dots: one or several for each text. They lie where the texts are long or many, so that these can be read.
import {
  above, axisName, below, categoryAxis, frame, legendHeight, mark, shortened, textWidth, valueAxis,
} from "./frame.ts";
import type { AxisSpec, Drawn, Place } from "./frame.ts";
import { rounded } from "./numbers.ts";
import type { Interval } from "./ratios.ts";
import { coloursOf } from "./theme.ts";
import { whiskerSeries } from "./whiskers.ts";

export interface BarsSpec {
  title: string;
  x: { name: string; unit: string };
  y: AxisSpec;
  labels: readonly string[];
  /** Of each: its name (empty where there is only one) and a number, or none, for each label. */
  series: readonly { name: string; values: readonly (number | null)[] }[];
  /** Of each label; only where there is one series. */
  colours?: readonly string[];
  /** Where bars begin, marked by a line; standard: 0. Without it there are dots on a logarithmic axis. */
  from?: number;
  /** Of each label, where there is one series: what stands at its bar, and in full where there is room. */
  texts?: readonly { short: string; full: string }[];
  /** Likewise: the interval in which its value lies, or none. */
  whiskers?: readonly (Interval | undefined)[];
}

function describe(spec: BarsSpec, text: (value: number, at: number) => string): string {
  const most = 40;
  const parts = spec.labels.slice(0, most).map((label, i) => {
    const values = spec.series.map(({ name, values }) => {
      const value = values[i];
      return `${name === "" ? "" : name + " "}${value === null || value === undefined ? "none" : text(value, i)}`;
    });
    return ` ${label}: ${values.join(", ")}.`;
  });
  const more = spec.labels.length > most ? ` And ${spec.labels.length - most} more.` : "";
  return `${spec.title}. ${spec.y.log && spec.from === undefined ? "Dots" : "Bar chart"} of ${axisName(spec.y)} by ${axisName(spec.x)}.${parts.join("")}${more}`;
}

/** Bars of `spec`, the first label at the top or at the left. */
export function drawBars(spec: BarsSpec, place: Place): Drawn {
  const { theme } = place;
  const whiskers = spec.whiskers ?? [];
  const text = (value: number, at: number): string => spec.texts?.[at]?.full ?? rounded(value);
  const description = describe(spec, text);
  const names = spec.series.map((series) => series.name);
  const colours = coloursOf(names, theme);
  const single = spec.series.length === 1;
  const widest = Math.max(0, ...spec.labels.map(textWidth));
  // On a logarithmic axis without a natural beginning lengths mean nothing, so that there are dots.
  const dots = spec.y.log && spec.from === undefined;
  const lying = widest > (place.width - 60) / Math.max(1, spec.labels.length) - 10 || spec.labels.length > 12;
  const legend = legendHeight(names, place.width);
  const values = [
    ...spec.series.flatMap((series) => series.values.filter((value) => value !== null)),
    ...whiskers.flatMap((interval) => interval ?? []),
  ];
  const ends = spec.from === undefined ? values : [...values, spec.from];
  const axis = valueAxis(spec.y, ends, place);
  const numberAxis: Record<string, unknown> = {
    ...axis,
    scale: false,
    ...(axis["min"] === undefined ? {} : { startValue: spec.from ?? axis["min"] }),
  };
  const most = place.width < 520 ? 22 : 42;
  const labels = spec.labels.map((label) => (lying ? shortened(label, most) : label));
  const labelAxis = categoryAxis(labels, place);
  const thick = single ? 20 : Math.max(9, 14 - spec.series.length);
  const height = lying
    ? legend + 56 + spec.labels.length * (single ? 24 : spec.series.length * thick + 12)
    : legend + Math.round(Math.min(360, Math.max(260, place.width * 0.5)));
  return {
    description,
    height,
    option: {
      ...frame(names, description, place),
      grid: lying
        ? {
          left: Math.max(0, ...labels.map(textWidth)) + 12, right: single ? 56 : 20, top: legend + 6, bottom: 50,
          outerBoundsMode: "none",
        }
        : { left: 4, right: 20, top: legend + 8, bottom: 8, outerBoundsMode: "same", outerBoundsContain: "all" },
      xAxis: lying
        ? { ...numberAxis, ...below(axisName(spec.y), place) }
        : { ...labelAxis, ...below(axisName(spec.x), place) },
      yAxis: lying
        ? { ...labelAxis, inverse: true, axisLabel: { color: theme.text, fontSize: 12, interval: 0 } }
        : { ...numberAxis, ...above(axisName(spec.y), place) },
      tooltip: {
        ...frame(names, description, place).tooltip,
        trigger: "axis",
        axisPointer: { type: "shadow" },
        valueFormatter: (shown: unknown, at: number) => {
          const value: unknown = Array.isArray(shown) ? shown[lying ? 0 : 1] : shown;
          return typeof value === "number" ? text(value, at) : "–";
        },
      },
      series: [...spec.series.map((series, i) => ({
        ...(dots ? { type: "scatter" as const, symbol: mark(i).symbol, symbolSize: 9 } : { type: "bar" as const }),
        name: series.name === "" ? axisName(spec.y) : series.name,
        color: colours[i] ?? theme.muted,
        barMaxWidth: lying ? thick : 48,
        barGap: "10%",
        data: series.values.map((value, at) => ({
          value: dots ? (lying ? [value ?? "-", at] : [at, value ?? "-"]) : value ?? "-",
          ...(single && spec.colours?.[at] !== undefined ? { itemStyle: { color: spec.colours[at] } } : {}),
          // Its whisker carries the text.
          ...(whiskers[at] === undefined ? {} : { label: { show: false } }),
        })),
        label: {
          show: single,
          position: lying ? "right" as const : "top" as const,
          color: theme.text,
          fontSize: 11,
          formatter: (bar: { dataIndex: number }) => {
            const value = series.values[bar.dataIndex];
            return typeof value === "number" ? spec.texts?.[bar.dataIndex]?.short ?? text(value, bar.dataIndex) : "";
          },
        },
        ...(i === 0 && spec.from !== undefined ? {
          markLine: {
            silent: true,
            symbol: "none",
            label: { show: false },
            lineStyle: { color: theme.text, type: "dashed" as const, width: 1 },
            data: [lying ? { xAxis: spec.from } : { yAxis: spec.from }],
          },
        } : {}),
      })), ...(whiskers.some((interval) => interval !== undefined) ? [whiskerSeries({
        whiskers, texts: (spec.texts ?? []).map(({ short }) => short), from: spec.from, lying,
      }, place)] : [])],
    },
  };
}

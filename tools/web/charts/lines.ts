// Line charts over a number: times by number of boxes, frame times.
import { above, axisName, below, frame, legendHeight, mark, valueAxis } from "./frame.ts";
import type { AxisSpec, Drawn, Place } from "./frame.ts";
import { rounded } from "./numbers.ts";
import { coloursOf } from "./theme.ts";

export interface Line {
  name: string;
  /** Sorted by x. */
  points: readonly (readonly [number, number])[];
  /** A level marked by a dashed line: [name, value]. */
  level?: readonly [string, number];
  dashed?: boolean;
}

export interface LinesSpec {
  title: string;
  x: AxisSpec;
  y: AxisSpec;
  lines: readonly Line[];
  /** Without symbols on the points, for lines of many points. */
  plain?: boolean;
}

/** A number with its unit, if it has one. */
function withUnit(value: number, unit: string): string {
  return unit === "" ? rounded(value) : `${rounded(value)} ${unit}`;
}

function describe(spec: LinesSpec, lines: readonly Line[]): string {
  const parts = lines.map((line) => {
    const [first, last] = [line.points[0], line.points[line.points.length - 1]];
    if (first === undefined || last === undefined) return "";
    return ` ${line.name}: ${withUnit(first[1], spec.y.unit)} at ${withUnit(first[0], spec.x.unit)}, ` +
      `${withUnit(last[1], spec.y.unit)} at ${withUnit(last[0], spec.x.unit)}.`;
  });
  return `${spec.title}. Line chart of ${axisName(spec.y)} over ${axisName(spec.x)}` +
    `${spec.x.log || spec.y.log ? ", logarithmic" : ""}.${parts.join("")}`;
}

/** Draws the lines of `spec`. Points that a logarithmic axis cannot show are left out. */
export function drawLines(spec: LinesSpec, place: Place): Drawn {
  const shown = (value: number, axis: AxisSpec): boolean => !axis.log || value > 0;
  const lines = spec.lines
    .map((line) => ({ ...line, points: line.points.filter(([x, y]) => shown(x, spec.x) && shown(y, spec.y)) }))
    .filter((line) => line.points.length > 0);
  const names = lines.map((line) => line.name);
  const colours = coloursOf(names, place.theme);
  const description = describe(spec, lines);
  const all = lines.flatMap((line) => line.points);
  const levels = lines.flatMap((line) => (line.level === undefined ? [] : [line.level[1]]));
  // A small count needs no fractional ticks.
  const xs = all.map(([at]) => at);
  const counts = !spec.x.log && xs.every((at) => Number.isInteger(at) && at >= 0 && at <= 20);
  const legend = legendHeight(names, place.width);
  const height = Math.round(Math.min(380, Math.max(280, place.width * 0.55))) + legend;
  return {
    description,
    height,
    option: {
      ...frame(names, description, place),
      grid: { left: 4, right: 20, top: legend + 8, bottom: 8, outerBoundsMode: "same", outerBoundsContain: "all" },
      xAxis: { ...valueAxis(spec.x, xs, place), ...(counts ? { minInterval: 1 } : {}), ...below(axisName(spec.x), place), ...(spec.plain === true ? { min: "dataMin", max: "dataMax" } : {}) },
      yAxis: {
        ...valueAxis(spec.y, [...all.map(([, at]) => at), ...levels], place),
        scale: false,
        ...above(axisName(spec.y), place),
      },
      tooltip: {
        ...frame(names, description, place).tooltip,
        trigger: spec.plain === true ? "item" : "axis",
        valueFormatter: (value: unknown) => (typeof value === "number" ? withUnit(value, spec.y.unit) : String(value)),
      },
      series: lines.map((line, i) => {
        const { symbol, dash } = mark(i);
        return {
          type: "line" as const,
          name: line.name,
          data: line.points.map(([at, value]) => [at, value]),
          color: colours[i] ?? place.theme.muted,
          symbol,
          symbolSize: 7,
          showSymbol: spec.plain !== true,
          lineStyle: { width: 2, type: line.dashed === true ? "dashed" as const : dash },
          emphasis: { focus: "series" as const },
          ...(line.level === undefined ? {} : {
            markLine: {
              silent: true,
              symbol: "none",
              lineStyle: { type: "dashed" as const, width: 1, opacity: 0.8 },
              label: { show: false },
              data: [{ yAxis: line.level[1], name: line.level[0] }],
            },
          }),
        };
      }),
    },
  };
}

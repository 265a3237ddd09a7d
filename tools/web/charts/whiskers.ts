// Intervals of bars: a line with a cap at each end, and the bar's text after it.
import type { CustomSeriesOption, CustomSeriesRenderItem } from "echarts";

import type { Place } from "./frame.ts";
import type { Interval } from "./ratios.ts";

export interface WhiskersSpec {
  /** One for each bar, with the text after it; undefined if a bar has none. */
  whiskers: readonly (Interval | undefined)[];
  texts: readonly string[];
  /** Leftmost position of the text. */
  from: number;
  /** Whether the bars are horizontal. */
  lying: boolean;
}

const cap = 3;

export function whiskerSeries({ whiskers, texts, from, lying }: WhiskersSpec, { theme }: Place): CustomSeriesOption {
  const renderItem: CustomSeriesRenderItem = (params, api) => {
    const interval = whiskers[params.dataIndex];
    if (interval === undefined) return null;
    const at = (value: number): number[] =>
      api.coord(lying ? [value, params.dataIndex] : [params.dataIndex, value]);
    const point = (x: number, y: number): string => `${x.toFixed(2)} ${y.toFixed(2)}`;
    const [[x1 = 0, y1 = 0], [x2 = 0, y2 = 0]] = [at(interval[0]), at(interval[1])];
    const ends = [[x1, y1], [x2, y2]].map(([x = 0, y = 0]) => (lying
      ? `M${point(x, y - cap)}L${point(x, y + cap)}` : `M${point(x - cap, y)}L${point(x + cap, y)}`));
    const d = `${ends.join("")}M${point(x1, y1)}L${point(x2, y2)}`;
    const [x = 0, y = 0] = at(Math.max(interval[1], from));
    const line = (stroke: string, lineWidth: number) =>
      ({ type: "path" as const, silent: true, shape: { pathData: d }, style: { stroke, lineWidth, fill: "none" } });
    return {
      type: "group",
      silent: true,
      children: [
        // An outline in the background's colour, because a bar may be as dark as its whisker.
        line(theme.background, 3.5),
        line(theme.text, 1.3),
        {
          type: "text",
          silent: true,
          style: {
            text: texts[params.dataIndex] ?? "", fill: theme.text, fontSize: 11,
            x: lying ? x + cap + 4 : x, y: lying ? y : y - cap - 4,
            align: lying ? "left" : "center", verticalAlign: lying ? "middle" : "bottom",
          },
        },
      ],
    };
  };
  return {
    type: "custom",
    renderItem,
    silent: true,
    tooltip: { show: false },
    z: 3,
    data: whiskers.map((interval, i) => (lying ? [interval?.[1] ?? "-", i] : [i, interval?.[1] ?? "-"])),
    encode: { x: 0, y: 1, tooltip: [] },
  };
}

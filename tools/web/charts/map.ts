// The map of winners: a cell for each x and y, coloured by the fastest algorithm and labelled with
// its name.
import type { CustomSeriesRenderItem } from "echarts";

import { axisName, below, categoryAxis, font, frame, legendHeight, shortened, textWidth } from "./frame.ts";
import type { Drawn, Place } from "./frame.ts";
import { coloursOf } from "./theme.ts";

export interface Field {
  x: string;
  y: string;
  value: string;
  /** Additional tooltip text. */
  note?: string;
}

export interface MapSpec {
  title: string;
  x: { name: string; unit: string };
  y: { name: string; unit: string };
  xs: readonly string[];
  ys: readonly string[];
  fields: readonly Field[];
}

/** Black or white, whichever has more contrast with a colour such as "#0072b2". */
function inkOn(colour: string): string {
  const part = (at: number): number => {
    const value = parseInt(colour.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  };
  return 0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5) > 0.22 ? "#10151c" : "#ffffff";
}

function describe(spec: MapSpec): string {
  const wins = new Map<string, number>();
  for (const { value } of spec.fields) wins.set(value, (wins.get(value) ?? 0) + 1);
  const parts = [...wins].sort((a, b) => b[1] - a[1]).map(([value, count]) => `${value} in ${count}`);
  return `${spec.title}. Map with ${spec.fields.length} fields, ${axisName(spec.x)} across and ${axisName(spec.y)} ` +
    `up, each with the name of the winner: ${parts.join(", ")}.`;
}

export function drawMap(spec: MapSpec, place: Place): Drawn {
  const values = [...new Set(spec.fields.map((field) => field.value))].sort();
  const colours = coloursOf(values, place.theme);
  const description = describe(spec);
  const legend = legendHeight(values, place.width);
  const ys = spec.ys.map((label) => shortened(label, place.width < 520 ? 16 : 40));
  const left = Math.max(0, ...ys.map(textWidth)) + 12;
  const top = Math.max(legend, 28) + 26;
  const drawField = (name: string, colour: string): CustomSeriesRenderItem => (_, api) => {
    const [x = 0, y = 0] = api.coord([api.value(0), api.value(1)]);
    const size = api.size?.([1, 1]);
    const [width = 0, height = 0] = Array.isArray(size) ? size : [];
    const maxCharacters = Math.floor((width - 8) / 6.2);
    return {
      type: "group",
      children: [
        {
          type: "rect",
          shape: { x: x - width / 2 + 1, y: y - height / 2 + 1, width: width - 2, height: height - 2, r: 3 },
          style: { fill: colour },
        },
        {
          type: "text",
          style: {
            text: maxCharacters < Math.min(6, name.length) ? "" : shortened(name.replaceAll("_", " "), maxCharacters), x, y, fill: inkOn(colour),
            font: `11px ${font}`,
            align: "center", verticalAlign: "middle",
          },
        },
      ],
    };
  };
  return {
    description,
    height: top + spec.ys.length * 30 + 50,
    option: {
      ...frame(values, description, place),
      legend: { ...frame(values, description, place).legend, show: values.length > 0, icon: "roundRect" },
      grid: { left, right: 12, top, bottom: 50, outerBoundsMode: "none" },
      xAxis: {
        ...categoryAxis(spec.xs, place),
        ...below(axisName(spec.x), place),
        axisLabel: { color: place.theme.text, fontSize: 12, interval: "auto" },
      },
      yAxis: {
        ...categoryAxis(ys, place),
        name: axisName(spec.y),
        nameLocation: "end",
        nameTextStyle: { color: place.theme.text, fontSize: 12, align: "left", padding: [0, 0, 0, 4 - left] },
        axisLabel: { color: place.theme.text, fontSize: 12, interval: 0 },
      },
      series: values.map((value, i) => {
        const colour = colours[i] ?? place.theme.muted;
        return {
          type: "custom" as const,
          name: value,
          color: colour,
          renderItem: drawField(value, colour),
          encode: { x: 0, y: 1 },
          data: spec.fields
            .filter((field) => field.value === value)
            .map((field) => [spec.xs.indexOf(field.x), spec.ys.indexOf(field.y), value, field.note ?? ""]),
          tooltip: {
            formatter: (field: unknown) => {
              const at = (field as { value: [number, number, string, string] }).value;
              return `${escaped(spec.ys[at[1]] ?? "")}, ${escaped(spec.xs[at[0]] ?? "")}<br><b>${escaped(at[2])}</b>` +
                (at[3] === "" ? "" : `<br>${escaped(at[3])}`);
            },
          },
        };
      }),
    },
  };
}

function escaped(text: string): string {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
}

// A chart of an experiment's table.
import { drawBars } from "./bars.ts";
import type { Cell, ChartSpec, Column, Table } from "./data.ts";
import type { Drawn, Place } from "./frame.ts";
import { drawLines } from "./lines.ts";
import { drawMap } from "./map.ts";
import { rounded } from "./numbers.ts";
import type { Interval } from "./ratios.ts";

/** The place of a column. Throws an Error naming those there are. */
export function columnOf(table: Table, name: string): number {
  const at = table.columns.findIndex((column) => column.name === name);
  if (at < 0) {
    const names = table.columns.map((column) => column.name).join(", ");
    throw new Error(`table '${table.name}' has no column '${name}'; expected one of ${names}`);
  }
  return at;
}

/** Whether a column holds ratios, by its name: "time over best". */
function isRatio({ name, unit }: Column): boolean {
  return unit === "" && name.includes(" over ");
}

export function cellText(cell: Cell): string {
  return cell === null ? "–" : typeof cell === "number" ? rounded(cell) : cell;
}

/** The rows that a chart shows. */
function rowsOf(table: Table, chart: ChartSpec): Cell[][] {
  const conditions = chart.where.map(([name, text]) => [columnOf(table, name), text] as const);
  return table.rows.filter((row) =>
    conditions.every(([at, text]) => row[at] === text || (row[at] !== null && cellText(row[at] ?? null) === text)));
}

function distinct(rows: readonly Cell[][], column: number): string[] {
  return [...new Set(rows.flatMap((row) => (row[column] == null ? [] : [cellText(row[column])])))];
}

/** Numbers rise, texts stay in the order in which they come. */
function ordered(rows: readonly Cell[][], column: number): string[] {
  const cells = rows.flatMap((row) => (row[column] == null ? [] : [row[column]]));
  if (cells.every((cell) => typeof cell === "number"))
    cells.sort((a, b) => Number(a) - Number(b));
  return [...new Set(cells.map(cellText))];
}

/** Of the rows whose y has an interval, in columns behind it: where they stand, and the interval. */
function intervalsOf(table: Table, rows: readonly Cell[][], x: number, y: number): [number | string, Interval][] {
  const name = table.columns[y]?.name;
  const [low_at, high_at] = [`${name} low`, `${name} high`].map((other) => table.columns.findIndex((column) => column.name === other));
  return rows.flatMap((row): [number | string, Interval][] => {
    const [at, low, high] = [row[x], row[low_at!], row[high_at!]];
    return at != null && typeof low === "number" && typeof high === "number" && low < high ? [[at, [low, high]]] : [];
  });
}

/** Throws an Error if the chart names a column that the table has not. */
export function drawTableChart(table: Table, chart: ChartSpec, place: Place): Drawn {
  const rows = rowsOf(table, chart);
  const x = columnOf(table, chart.x);
  const y = columnOf(table, chart.y);
  const [x_column, y_column] = [table.columns[x], table.columns[y]];
  if (x_column === undefined || y_column === undefined) throw new Error(`table '${table.name}' has no columns`);
  if (chart.kind === "map") {
    const value = columnOf(table, chart.value);
    const ys = ordered(rows, y);
    return drawMap({
      title: chart.title,
      x: x_column,
      y: y_column,
      xs: ordered(rows, x),
      ys: rows.every((row) => typeof row[y] === "number") ? ys : ys.reverse(),
      fields: rows.filter((row) => row[x] != null && row[y] != null && row[value] != null)
        .map((row) => ({ x: cellText(row[x] ?? null), y: cellText(row[y] ?? null), value: cellText(row[value] ?? null) })),
    }, place);
  }
  const series = chart.series === "" ? -1 : columnOf(table, chart.series);
  const nameOf = (row: readonly Cell[]): string => (series < 0 ? "" : cellText(row[series] ?? null));
  const names = series < 0 ? [""] : distinct(rows, series);
  if (chart.kind === "bars") {
    const labels = ordered(rows, x);
    return drawBars({
      title: chart.title,
      x: x_column,
      y: { ...y_column, log: chart.log_y },
      labels,
      ...(isRatio(y_column) && chart.log_y ? { from: 1 } : {}),
      series: names.map((name) => ({
        name,
        values: labels.map((label) => {
          const cell = rows.find((row) => nameOf(row) === name && cellText(row[x] ?? null) === label)?.[y];
          return typeof cell === "number" && (!chart.log_y || cell > 0) ? cell : null;
        }),
      })),
    }, place);
  }
  return drawLines({
    title: chart.title,
    x: { ...x_column, log: chart.log_x },
    y: { ...y_column, log: chart.log_y },
    ...(isRatio(y_column) ? { reference: 1 } : {}),
    lines: names.map((name) => {
      const points = rows.filter((row) => nameOf(row) === name).flatMap((row): [number | string, number][] => {
        const [at, value] = [row[x], row[y]];
        return at != null && typeof value === "number" ? [[at, value]] : [];
      });
      if (points.every(([at]) => typeof at === "number")) points.sort((a, b) => Number(a[0]) - Number(b[0]));
      return { name, points, intervals: intervalsOf(table, rows.filter((row) => nameOf(row) === name), x, y) };
    }),
  }, place);
}

// The charts: pure functions from what the program writes, and the place where a chart is shown, to ECharts options.
export * from "./comparison.ts";
export * from "./comparison_charts.ts";
export * from "./data.ts";
export { drawBars } from "./bars.ts";
export { drawLines } from "./lines.ts";
export { drawMap } from "./map.ts";
export { drawTableChart, cellText, columnOf } from "./table_chart.ts";
export { dark, light, coloursOf, familyColour, familyOf } from "./theme.ts";
export type { Theme } from "./theme.ts";
export type { Drawn, Place } from "./frame.ts";
export * from "./numbers.ts";
export * from "./ratios.ts";

// The charts: pure functions from what the program writes, and the place where a chart is shown, to ECharts options.
export * from "./comparison.ts";
export * from "./comparison_charts.ts";
export * from "./data.ts";
export { draw_bars } from "./bars.ts";
export { draw_lines } from "./lines.ts";
export { draw_map } from "./map.ts";
export { draw_table_chart, cell_text, column_of } from "./table_chart.ts";
export { dark, light, colours_of, family_colour, family_of } from "./theme.ts";
export type { Theme } from "./theme.ts";
export type { Drawn, Place } from "./frame.ts";
export * from "./numbers.ts";
export { inTodaysShape } from "./old_results.ts";
export type { OldComparison } from "./old_results.ts";
export * from "./ratios.ts";

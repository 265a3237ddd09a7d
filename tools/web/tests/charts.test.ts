// The charts of comparisons.
import assert from "node:assert/strict";
import { test } from "node:test";

import { casesOf, labelOf, leadOf, standings } from "../charts/comparison.ts";
import {
  drawFrames, drawLeads, drawRatios, drawScaling, drawStandings, drawWinners, scaledScenes,
} from "../charts/comparison_charts.ts";
import { echarts } from "../charts/echarts.ts";
import { logTicks } from "../charts/frame.ts";
import type { Drawn, Place } from "../charts/frame.ts";
import { drawLines } from "../charts/lines.ts";
import { bytesText, grouped, ratioText, rounded, short, timeText } from "../charts/numbers.ts";
import { intervalText } from "../charts/ratios.ts";
import { coloursOf, dark, familyOf, light } from "../charts/theme.ts";
import { comparison } from "./fixture.ts";

const place: Place = { theme: light, width: 640 };

type Series = { type: string; name: string; data: unknown[]; color: string };

function seriesOf(drawn: Drawn): Series[] {
  return drawn.option.series as unknown as Series[];
}

test("lines leave out what cannot be on a logarithmic axis, and tell in words what they show", () => {
  const drawn = (log: boolean): Drawn => drawLines({
    title: "Time", x: { name: "boxes", unit: "", log }, y: { name: "time", unit: "ms", log },
    lines: [{ name: "grid", points: [[1, 3], [2, 0], [4, 0.5]] }],
  }, place);
  assert.deepEqual(seriesOf(drawn(true))[0]?.data, [[1, 3], [4, 0.5]]);
  assert.deepEqual(seriesOf(drawn(false))[0]?.data, [[1, 3], [2, 0], [4, 0.5]]);
  assert.equal(drawn(true).description, "Time. Line chart of time (ms) over boxes, logarithmic. grid: 3 ms at 1, 0.500 ms at 4.");
});

test("an algorithm has its family's colour in every chart", () => {
  assert.equal(familyOf("grid:cell=2.5"), "grid");
  assert.equal(familyOf("paper_grid"), "grid");
  assert.equal(familyOf("bullet_dbvt"), "bullet");
  assert.equal(familyOf("mixed"), undefined);
  assert.equal(coloursOf(["chipmunk_space_hash"], light)[0], coloursOf(["chipmunk_bb_tree", "chipmunk_space_hash"], light)[1]);
  assert.deepEqual(coloursOf(["bvh", "grid"], light), [coloursOf(["grid", "bvh"], light)[1], "#e69f00"]);
  assert.notDeepEqual(coloursOf(["bvh"], light), coloursOf(["bvh"], dark));
});

test("no two of up to eight series have the same colour", () => {
  const names = ["grid:cell=1", "grid:cell=2", "grid", "bvh", "uniform", "mixed", "1", "2"];
  assert.equal(new Set(coloursOf(names, light)).size, names.length);
  assert.equal(new Set(coloursOf(names, dark)).size, names.length);
});

test("ticks of a logarithmic axis span the values", () => {
  for (const values of [[1, 2], [0.003, 4000], [7], [1, 1e9], [0.2, 0.9]]) {
    const { min, max, ticks } = logTicks(values);
    assert.ok(min <= Math.min(...values) && max >= Math.max(...values), String(values));
    assert.ok(ticks.length >= 1 && ticks.length <= 8, String(ticks));
  }
});

test("numbers are told with three digits", () => {
  assert.deepEqual([0, 1234567, 0.012345, 12.345, 5, 99.99].map(rounded), ["0", "1,234,567", "0.0123", "12.3", "5", "100.0"]);
  assert.deepEqual([1000, 250000, 0.05, 2e6].map(short), ["1k", "250k", "0.05", "2M"]);
  assert.deepEqual([0.0123, 1.5, 2500, 0.0002].map(timeText), ["12.3 µs", "1.50 ms", "2.50 s", "200 ns"]);
  assert.equal(grouped(-1234.5), "-1,234.5");
  assert.deepEqual([168, 1536, 2.04e7].map(bytesText), ["168 B", "1.54 kB", "20.4 MB"]);
});

const cases = casesOf(comparison.measurements);

test("measurements on the same boxes are one case", () => {
  assert.deepEqual(cases.map(({ name }) => name), [
    "uniform, 2D, 1,000 boxes", "uniform, 2D, 10,000 boxes", "churn, 2D, 1,000 boxes, 25 % moving",
  ]);
});

test("a lead is the fastest peer's time over that of the fastest of ours", () => {
  const lead = leadOf(cases[0]!);
  assert.deepEqual([lead?.own.algorithm, lead?.peer.algorithm, lead?.ratio.median], ["bvh", "box2d_tree", 4]);
  assert.equal(intervalText(lead!.ratio), "4.0 (3.8 to 4.2)");
});

test("a lead names the two that its ratio is of, whatever their medians over other rounds are", () => {
  const [of] = casesOf(structuredClone(comparison.measurements));
  const lead = leadOf(of!)!;
  for (const measurement of of!.measurements)
    if (measurement !== lead.own && measurement !== lead.peer && measurement.median_ms !== null) measurement.median_ms = 1e-9;
  const again = leadOf(of!)!;
  assert.deepEqual([again.own.algorithm, again.peer.algorithm], [lead.own.algorithm, lead.peer.algorithm]);
});

test("ratios have two significant digits, and are level where their interval holds one", () => {
  assert.deepEqual([0.0514, 0.996, 1.04, 1.26, 9.96, 19.4, 134, 1349].map(ratioText),
    ["0.051", "1.0", "1.0", "1.3", "10", "19", "130", "1,300"]);
  const text = (low: number | null, high: number | null): string =>
    intervalText({ of: "grid", median: 1.02, low, high, rounds: 5 });
  assert.deepEqual([text(1.01, 1.03), text(0.98, 1.06), text(1, 1.06), text(null, null)],
    ["1.0 (1.0 to 1.0)", "1.0 (level)", "1.0 (level)", "1.0"]);
});

test("a ratio's interval is a whisker of its bar, and told in words", () => {
  const drawn = drawRatios(cases[0]!, place);
  const [bars, whiskers] = seriesOf(drawn) as unknown as { type: string; data: { value?: number; label?: object }[] }[];
  assert.deepEqual([bars?.type, whiskers?.type], ["bar", "custom"]);
  // The fastest algorithm's ratio is to itself.
  assert.deepEqual(bars?.data.map(({ label }) => label === undefined), [true, false, false, false]);
  assert.match(drawn.description, / bvh: 1\.0\. grid: 2\.0 \(1\.9 to 2\.1\)\. /);
  assert.match(drawRatios(cases[2]!, place).description, / bvh: 1\.2 \(0\.92 to 1\.6\)\. /);
});

test("an algorithm's threads are told once", () => {
  const of = (algorithm: string, threads: number): string => labelOf({ ...comparison.measurements[0]!, algorithm, threads });
  assert.equal(of("grid", 1), "grid");
  assert.equal(of("auto:threads=2", 2), "auto:threads=2");
  assert.equal(of("grid:threads=0:cell=2", 4), "grid:threads=0:cell=2 (4 threads)");
  assert.equal(of("grid:threads=12", 1), "grid:threads=12");
});

test("what is counted has no ticks between whole numbers", () => {
  const axisOf = (xs: number[], log: boolean): unknown => (drawLines({
    title: "", x: { name: "threads", unit: "", log }, y: { name: "time", unit: "ms", log: false },
    lines: [{ name: "", points: xs.map((x) => [x, 1] as const) }],
  }, place).option.xAxis as { minInterval?: number }).minInterval;
  assert.equal(axisOf([1, 2], false), 1);
  assert.equal(axisOf([1, 1.5], false), undefined);
  assert.equal(axisOf([1, 2], true), undefined);
});

test("a skipped algorithm does not stand in a case", () => {
  assert.deepEqual(standings(cases).map(({ algorithm, cases, fastest }) => [algorithm, cases, fastest]),
    [["bvh", 3, 1], ["grid", 3, 2], ["box2d_tree", 3, 0], ["brute_force", 1, 0]]);
});

test("the charts of a comparison hold what was measured", () => {
  assert.deepEqual(scaledScenes(cases).map(({ scene, dimension }) => [scene, dimension]), [["uniform", 2]]);
  const lines = seriesOf(drawScaling(cases, scaledScenes(cases)[0]!, place));
  assert.deepEqual(lines.find(({ name }) => name === "grid")?.data, [[1000, 0.2], [10000, 1]]);
  const frames = seriesOf(drawFrames(cases[2]!, place));
  assert.deepEqual(frames.map(({ name, data }) => [name, data.length]), [["grid", 4], ["bvh", 4], ["box2d_tree", 4]]);
  assert.equal(seriesOf(drawRatios(cases[0]!, place))[0]?.data.length, 4);
  assert.deepEqual(seriesOf(drawWinners(cases, place)).map(({ name }) => name), ["bvh", "grid"]);
});

test("every chart is drawn without a DOM, in both themes and wide and narrow", () => {
  for (const theme of [light, dark]) {
    for (const width of [340, 720]) {
      const at = { theme, width };
      for (const { option, height, description } of [
        drawStandings(cases, at), drawLeads(cases, at), drawWinners(cases, at), drawFrames(cases[2]!, at),
        drawRatios(cases[1]!, at), drawScaling(cases, scaledScenes(cases)[0]!, at),
      ]) {
        const chart = echarts.init(null, null, { renderer: "svg", ssr: true, width, height });
        chart.setOption(option);
        const svg = chart.renderToSVGString();
        chart.dispose();
        assert.ok(svg.includes("<path"), description);
        assert.doesNotMatch(svg, /NaN|Infinity|undefined/);
      }
    }
  }
});

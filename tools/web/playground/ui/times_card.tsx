// Time by number of boxes: measured over the whole range, or collected while the visitor drags the
// number.
import { useEffect, useRef } from "preact/hooks";
import UPlot from "uplot";

import type { Measured } from "../bench/protocol.ts";
import { fileScene } from "../scene/catalogue.ts";
import { bench } from "../state/client.ts";
import { measured, measuring, shown, state, timesKey } from "../state/store.ts";
import { Card } from "./field.tsx";
import { duration, grouped } from "./numbers.ts";
import { theme } from "./themes.ts";

/** Eight per power of ten, from 10 to 100,000. */
const counts = Array.from({ length: 33 }, (_, at) => Math.round(10 ** (1 + at / 8)));

/** Five colours that colour-blind people can tell apart (after Okabe and Ito); light and dark. */
const inks: readonly (readonly [string, string])[] = [
  ["#0067a8", "#5cb8f5"], ["#c84a00", "#ff9350"], ["#00806a", "#2fc49a"], ["#9c3f87", "#e08fbe"], ["#7a5200", "#f0b43c"],
];
const dashes = [[], [6, 3], [2, 3], [8, 3, 2, 3], []];

/** The series by spec. */
function table(): { specs: string[]; data: UPlot.AlignedData } {
  const bySpec = new Map<string, Map<number, number>>();
  for (const { spec, count, milliseconds } of measured.value) {
    const times = bySpec.get(spec) ?? new Map<number, number>();
    bySpec.set(spec, times);
    times.set(count, milliseconds);
  }
  const xs = [...new Set([...bySpec.values()].flatMap((times) => [...times.keys()]))].sort((a, b) => a - b);
  return {
    specs: [...bySpec.keys()],
    data: [xs, ...[...bySpec.values()].map((times) => xs.map((x) => times.get(x) ?? null))],
  };
}

function options(specs: readonly string[], width: number): UPlot.Options {
  const dark = theme.value === "dark";
  const text = dark ? "#a5aebd" : "#5a6473";
  const grid = { stroke: dark ? "#2a313d" : "#e6e9ef", width: 1 };
  const axis = { stroke: text, grid, ticks: grid, font: "13px system-ui, sans-serif" };
  // uPlot leaves out the labels between powers of ten.
  return {
    width, height: Math.round(Math.min(460, Math.max(300, 0.4 * width))),
    padding: [null, 24, null, null],
    legend: { live: false },
    cursor: { drag: { x: false, y: false } },
    scales: { x: { distr: 3, time: false }, y: { distr: 3 } },
    axes: [
      { ...axis, label: "boxes", labelFont: axis.font, labelSize: 20, values: (_, all) => all.map((one) => one === null ? "" : grouped(one)) },
      { ...axis, size: 70, values: (_, all) => all.map((one) => one === null ? "" : duration(one)) },
    ],
    series: [
      { label: "boxes" },
      ...specs.map((spec, at) => ({
        label: spec, stroke: inks[at % inks.length]![dark ? 1 : 0], width: 2, dash: dashes[at % dashes.length]!,
        spanGaps: true, points: { show: true, size: 5 },
      })),
    ],
  };
}

/** The results on screen are measurements as well: the latest for each number of boxes counts. */
function noteShown(): void {
  const now = shown.value;
  if (now === null || state.value.scene.name === fileScene || state.value.edits.length > 0) return;
  const news = now.panels.filter((panel) =>
    panel.error === undefined && !panel.late && panel.milliseconds > 0 && !state.value.panels.some(({ spec, follow }) => spec === panel.spec && follow));
  const before = measured.value;
  const isOf = (one: Measured, spec: string): boolean => one.spec === spec && one.count === now.present;
  const better = news.filter(({ spec, milliseconds }) =>
    !before.some((one) => isOf(one, spec) && (one.ofFrames !== true || one.milliseconds === milliseconds)));
  if (better.length === 0) return;
  const kept = before.filter((one) => !better.some(({ spec }) => isOf(one, spec)));
  measured.value = [...kept, ...better.map(({ spec, milliseconds }) =>
    ({ spec, count: now.present, milliseconds, ofFrames: true }))];
}

export function TimesCard() {
  const element = useRef<HTMLDivElement>(null);
  const key = useRef(timesKey.value);
  const { specs, data } = table();
  useEffect(() => {
    if (key.current !== timesKey.value) {
      key.current = timesKey.value;
      measured.value = [];
    }
  });
  useEffect(() => {
    // Every frame would be too often.
    const timer = setInterval(noteShown, 500);
    return () => clearInterval(timer);
  }, []);
  useEffect(() => {
    if (element.current === null || data[0].length < 2) return undefined;
    const chart = new UPlot(options(specs, Math.max(240, element.current.clientWidth)), data, element.current);
    return () => chart.destroy();
  }, [measured.value, theme.value]);
  const start = (): void => {
    measuring.value = true;
    measured.value = [];
    bench().send({ kind: "measure", counts, specs: [...new Set(state.value.panels.map(({ spec }) => spec))] });
  };
  const last = data[0].length - 1;
  const summary = last < 1 ? "" : `Time against the number of boxes, from ${grouped(data[0][0]!)} to ${grouped(data[0][last]!)}: ` +
    specs.map((spec, at) => {
      const known = [...data[at + 1]!].filter((one): one is number => typeof one === "number");
      return `${spec} from ${duration(known[0] ?? 0)} to ${duration(known[known.length - 1] ?? 0)}`;
    }).join("; ");
  return (
    <Card title="Time against the number of boxes" class="large">
      <p class="note">How long does a search take, and how fast does the time grow? Measure every algorithm above on 10
        to 100,000 of these boxes, or drag the number of boxes yourself: each time shown becomes a point. Times are
        measured in this browser, on this machine; both axes are logarithmic.</p>
      <button type="button" disabled={measuring.value || state.value.scene.name === fileScene} onClick={start}>
        {measuring.value ? "Measuring …" : "Measure 10 to 100,000 boxes"}</button>
      <div ref={element} class="times" role="img" aria-label={summary || "No times yet"} />
    </Card>
  );
}

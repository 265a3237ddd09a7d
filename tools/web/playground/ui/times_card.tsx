// Time by number of boxes: measured over the whole range, or collected while the visitor drags the
// number.
import { signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";

import type { Measured } from "../bench/protocol.ts";
import { chartOf, csvOf, type Description, type Series } from "../draw/chart.ts";
import { pngOfSvg } from "../out/png.ts";
import { saveAs } from "../out/save.ts";
import { fileScene, sceneEntry, settingsText } from "../scene/catalogue.ts";
import { bench } from "../state/client.ts";
import { measured, measuring, shown, state, timesKey } from "../state/store.ts";
import { Card } from "./field.tsx";
import { duration, grouped } from "./numbers.ts";
import { attempt } from "./share_card.tsx";
import { theme } from "./themes.ts";

/** Eight per power of ten, from 10 to 100,000. */
const counts = Array.from({ length: 33 }, (_, at) => Math.round(10 ** (1 + at / 8)));

/** Width of the chart, in pixels. */
const width = signal(640);

function table(): Series[] {
  const bySpec = new Map<string, Map<number, Measured>>();
  for (const one of measured.value) {
    if (!bySpec.has(one.spec)) bySpec.set(one.spec, new Map());
    bySpec.get(one.spec)!.set(one.count, one);
  }
  return [...bySpec].map(([name, points]) => ({ name, points: [...points.values()].sort((a, b) => a.count - b.count) }));
}

/** Such as "Chrome 130, Linux". */
function browser(agent: string): string {
  const [, name = "", version = ""] = /(Edg|OPR|Firefox|Chrome)\/(\d+)/.exec(agent.replace(/Chrome(.*(Edg|OPR)\/)/, "$1")) ??
    /(Version)\/(\d+)/.exec(agent) ?? [];
  const names: Record<string, string> = { Edg: "Edge", OPR: "Opera", Version: "Safari" };
  const system = /Windows|Android|iPhone|iPad|Mac OS X|CrOS|Linux/.exec(agent)?.[0];
  return [`${names[name] ?? name} ${version}`.trim() || "a browser", system].filter((one) => one !== undefined).join(", ");
}

/** What is measured, and where, for those who read a saved chart. */
function description(series: readonly Series[]): Description {
  const { scene } = state.value;
  const ways = new Set(series.flatMap(({ points }) => points.map(({ ofFrames }) => ofFrames === true)));
  const way = ways.size > 1 ? "in batches, hollow points in single frames" : ways.has(true) ? "in single frames" : "in batches";
  return {
    title: `Time of a search by the number of boxes: ${sceneEntry(scene.name)?.title ?? scene.name}`,
    caption: [settingsText(scene).replaceAll("=", " ").replaceAll(/(\d) (?=[a-z])/g, "$1, "), `seed ${scene.seed}`,
      `measured ${way}`, new Date().toISOString().slice(0, 10), browser(navigator.userAgent),
      "Broadside playground"].filter((one) => one !== "").join("; "),
  };
}

/**
 * The results on screen are measurements as well: the latest for each number of boxes counts. A curve of batches takes
 * none of them, since other work between frames makes these slower.
 */
function noteShown(): void {
  const now = shown.value;
  if (now === null || measuring.value || state.value.scene.name === fileScene || state.value.edits.length > 0) return;
  const news = now.panels.filter((panel) =>
    panel.error === undefined && !panel.late && panel.milliseconds > 0 && !state.value.panels.some(({ spec, follow }) => spec === panel.spec && follow));
  const before = measured.value;
  const isOf = (one: Measured, spec: string): boolean => one.spec === spec && one.count === now.present;
  const better = news.filter(({ spec, milliseconds }) => !before.some((one) =>
    one.spec === spec && (one.ofFrames !== true || (one.count === now.present && one.milliseconds === milliseconds))));
  if (better.length === 0) return;
  const kept = before.filter((one) => !better.some(({ spec }) => isOf(one, spec)));
  measured.value = [...kept, ...better.map(({ spec, milliseconds }) =>
    ({ spec, count: now.present, milliseconds, ofFrames: true }))];
}

export function TimesCard() {
  const element = useRef<HTMLDivElement>(null);
  const key = useRef(timesKey.value);
  const series = table();
  const numbers = new Set(measured.value.map(({ count }) => count));
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
  useLayoutEffect(() => {
    const sizes = new ResizeObserver(() => { width.value = Math.max(300, element.current!.clientWidth); });
    sizes.observe(element.current!);
    return () => sizes.disconnect();
  }, []);
  const isFile = state.value.scene.name === fileScene;
  const start = (): void => {
    measuring.value = true;
    measured.value = [];
    bench().send({ kind: "measure", counts, specs: [...new Set(state.value.panels.map(({ spec }) => spec))] });
  };
  const chart = numbers.size < 2 ? "" : chartOf(series, width.value, theme.value);
  const described = (): string => chartOf(series, width.value, theme.value, description(series));
  const summary = chart === "" ? "" : `Time against the number of boxes, from ${grouped(Math.min(...numbers))} to ` +
    `${grouped(Math.max(...numbers))}: ` +
    series.map(({ name, points }) => `${name} from ${duration(points[0]!.milliseconds)} to ${duration(points.at(-1)!.milliseconds)}`).join("; ");
  const save = (what: string, kind: string, of: () => Blob | Promise<Blob>) =>
    <button type="button" onClick={() => void attempt(async () => saveAs(await of(), `broadside-times.${kind.toLowerCase()}`))}>
      {`${what} as ${kind}`}</button>;
  return (
    <Card title="Time against the number of boxes" class="large">
      <p class="note">How long does a search take, and how fast does the time grow? {isFile
        ? "Your file has one number of boxes: choose a scene under Boxes to measure over many."
        : "Measure every algorithm above on 10 to 100,000 boxes of this scene, or drag the number of boxes yourself: each " +
          "time shown becomes a hollow point, until you measure."} Times are
        measured in this browser, on this machine; both axes are logarithmic.</p>
      <div class="row">
        <button type="button" disabled={measuring.value || isFile} onClick={start}
          title={isFile ? "A file has one number of boxes: choose a scene" : undefined}>
          {measuring.value ? "Measuring …" : "Measure 10 to 100,000 boxes"}</button>
        {chart !== "" && !measuring.value && <>
          {save("Chart", "SVG", () => new Blob([described()], { type: "image/svg+xml" }))}
          {save("Chart", "PNG", () => pngOfSvg(described()))}
          {save("Times", "CSV", () => new Blob([csvOf(series, state.value.scene)], { type: "text/csv" }))}
        </>}
      </div>
      <div ref={element} class="times" role="img" aria-label={summary || "No times yet"}
        dangerouslySetInnerHTML={{ __html: chart }} />
    </Card>
  );
}

// The comparison: the fastest algorithm of each case, its lead, and every measurement.
import { casesOf, isTimed, labelOf, leadOf, ranking, standings } from "../charts/comparison.ts";
import type { Case } from "../charts/comparison.ts";
import {
  drawFrames, drawLeads, drawRatios, drawScaling, drawStandings, drawWinners, scaledScenes,
} from "../charts/comparison_charts.ts";
import type { Comparison, Measurement, Ratio } from "../charts/data.ts";
import { bytesText, geometricMean, grouped, ratioText, rounded, timeText } from "../charts/numbers.ts";
import { intervalOf, intervalText, isLevel } from "../charts/ratios.ts";
import { dataTable } from "./data_table.ts";
import type { DataColumn } from "./data_table.ts";
import { add, choices, el, picker } from "./dom.ts";
import { csvOfComparison, downloadButton } from "./downloads.ts";
import { chartFigure } from "./figure.ts";
import { facts, tile } from "./summary.ts";
import type { Doubts } from "./summary.ts";

function outcomeOf(measurement: Measurement): string {
  if (measurement.verified === null) return "skipped";
  if (!measurement.verified) return "FAILED";
  const by = `verified ${measurement.verified_by}`;
  return measurement.unsteady === true ? `${by}, unsteady` : by;
}

function plural(count: number, one: string): string {
  return `${grouped(count)} ${one}${count === 1 ? "" : "s"}`;
}

function rangeText(ratio: Ratio): string {
  const interval = intervalOf(ratio);
  return interval === undefined ? "" : ` (${ratioText(interval[0])} to ${ratioText(interval[1])})`;
}

function tiles(comparison: Comparison, cases: readonly Case[]): HTMLElement {
  const best = standings(cases)[0];
  const leads = cases.flatMap((of) => {
    const lead = leadOf(of);
    return lead === undefined ? [] : [{ of, ...lead }];
  });
  const worst = leads.reduce<(typeof leads)[number] | undefined>(
    (min, lead) => (min === undefined || lead.ratio.median < min.ratio.median ? lead : min), undefined);
  const failed = comparison.measurements.filter(({ verified }) => verified === false);
  const skipped = comparison.measurements.filter(({ verified }) => verified === null).length;
  const measured = comparison.measurements.length - skipped;
  return el("dl", { class: "tiles" },
    best !== undefined && tile("Fastest overall", best.algorithm,
      `${rounded(best.ratio)} times the fastest's time, geometric mean of ${plural(best.cases, "case")}`),
    leads.length > 0 && tile("Ours against the fastest peer",
      `${rounded(geometricMean(leads.map(({ ratio }) => ratio.median)))} times`,
      `as fast, the best of each; geometric mean of ${plural(leads.length, "case")}`),
    worst !== undefined && tile("At the least", isLevel(worst.ratio) ? "level" : `${ratioText(worst.ratio.median)} times`,
      `${isLevel(worst.ratio) ? "with it" : "as fast"}${rangeText(worst.ratio)}: ${worst.of.name}: ${worst.own.algorithm} against ${worst.peer.algorithm}`),
    tile("Verified", failed.length === 0 ? `all ${grouped(measured)}` : `${grouped(failed.length)} FAILED`,
      `${plural(measured, "measurement")} in ${plural(cases.length, "case")}; ${grouped(skipped)} skipped` +
        (comparison.stopped ? "; stopped before the end" : "")));
}

function failures(comparison: Comparison): HTMLElement | null {
  const failed = comparison.measurements.filter(({ verified }) => verified === false);
  if (failed.length === 0) return null;
  return el("div", { class: "card" }, el("h3", {}, "Failed"), el("ul", {}, ...failed.map((measurement) =>
    el("li", {}, `${measurement.algorithm} on ${measurement.scene}, ${measurement.dimension}D, ${grouped(measurement.boxes)} boxes: ` +
      `${measurement.skipped ?? "its pairs are not those of " + (measurement.verified_by ?? "the reference")}`))));
}

/** Explains the whiskers, if there are any. */
function whiskersNote(cases: readonly Case[]): string {
  const some = cases.some((of) => of.measurements.some((m) => m.ratio_to_fastest !== null && intervalOf(m.ratio_to_fastest) !== undefined));
  return some ? " Whiskers: 95 % intervals; “level” where one holds 1." : "";
}

const kinds: [string, string, Measurement["kind"][]][] = [
  ["own", "ours", ["own", "user"]],
  ["all", "all", ["own", "paper", "literature", "peer", "user"]],
  ["paper", "the paper's", ["paper"]],
  ["literature", "from the literature", ["literature"]],
  ["peer", "other libraries", ["peer"]],
];

function scaling(cases: readonly Case[]): HTMLElement | null {
  const scenes = scaledScenes(cases);
  const [first] = scenes;
  if (first === undefined) return null;
  let scene = first;
  let kind = kinds[0]?.[2] ?? [];
  const caption = (): string => `Time over the number of boxes: ${scene.scene}, ${scene.dimension}D`;
  const draw = (): void => figure.show(caption(), (place) => drawScaling(cases, scene, place, kind));
  const figure = chartFigure(caption(), (place) => drawScaling(cases, scene, place, kind), "Both axes are logarithmic; at most eight algorithms.");
  const there = kinds.filter(([, , some]) => cases.some((of) => of.measurements.some((m) => isTimed(m) && some.includes(m.kind))));
  return el("div", { class: "card", id: "scaling" }, el("h3", {}, "How time grows"), el("div", { class: "controls" },
    scenes.length > 1 && picker("Scene", scenes.map((one, i) => [String(i), `${one.scene}, ${one.dimension}D${one.mode === "track" ? ", moving" : ""}`]), (value) => {
      scene = scenes[Number(value)] ?? scene;
      draw();
    }),
    there.length > 1 && choices("Algorithms", there.map(([value, text]) => [value, text]), (value) => {
      kind = kinds.find(([name]) => name === value)?.[2] ?? kind;
      draw();
    })), figure.element);
}

const time = (value: number | null): string => (value === null ? "–" : timeText(value));
const remarksOf = (m: Measurement): string | null =>
  [m.unsteady === true ? "unsteady" : null, m.skipped ?? m.explanation].filter((part) => part !== null).join("; ") || null;
const number = (value: number | null): string => (value === null ? "–" : rounded(value));

/** A column of ratios, sorted by their medians. */
function ratioColumn(title: string, ratioOf: (m: Measurement) => Ratio | null): DataColumn<Measurement> {
  return {
    title,
    value: (m) => ratioOf(m)?.median ?? null,
    text: (m) => {
      const ratio = ratioOf(m);
      return ratio === null ? "–" : intervalText(ratio);
    },
  };
}

function caseTable(of: Case): HTMLElement {
  return dataTable<Measurement>({
    caption: of.name,
    rows: [...ranking(of), ...of.measurements.filter((measurement) => !isTimed(measurement))],
    columns: [
      { title: "algorithm", value: labelOf },
      { title: "median", value: (m) => m.median_ms, text: (m) => time(m.median_ms) },
      ratioColumn("to the fastest", (m) => m.ratio_to_fastest),
      ratioColumn("to our best", (m) => m.ratio_to_best_own),
      ratioColumn("to the fastest peer", (m) => m.ratio_to_fastest_peer),
      { title: "p99", value: (m) => m.p99_ms, text: (m) => time(m.p99_ms) },
      { title: "rounds", value: (m) => m.rounds, text: (m) => (isTimed(m) ? grouped(m.rounds) : "–") },
      { title: "tests", value: (m) => m.tests, text: (m) => number(m.tests) },
      { title: "memory", value: (m) => m.own_bytes, text: (m) => (m.own_bytes === null ? "–" : bytesText(m.own_bytes)) },
    ],
    note: remarksOf,
  });
}

/** One case at a time: ratios, frames, and all measurements. */
function caseView(cases: readonly Case[]): HTMLElement | null {
  let of = cases[0];
  if (of === undefined) return null;
  const first = of;
  const ratios = chartFigure(`Multiples of the fastest: ${of.name}`, (place) => drawRatios(first, place), whiskersNote(cases).trim());
  const frames = chartFigure("", (place) => drawFrames(first, place), "At most the six fastest; dashed: each one's 99th percentile.");
  const table = el("div");
  const floor = el("p", { class: "note" });
  const show = (): void => {
    const chosen = of;
    if (chosen === undefined) return;
    ratios.show(`Multiples of the fastest: ${chosen.name}`, (place) => drawRatios(chosen, place));
    frames.element.hidden = chosen.mode !== "track";
    if (chosen.mode === "track") frames.show(`Time of each frame: ${chosen.name}`, (place) => drawFrames(chosen, place));
    table.replaceChildren(caseTable(chosen));
    floor.textContent = chosen.floor_ms === null ? "" : `The floor, boxes moved into parts and read back and as many pairs written: ${timeText(chosen.floor_ms)}.`;
  };
  const box = el("div", { class: "card", id: "cases" }, el("h3", {}, "Case by case"), el("div", { class: "controls" },
    cases.length > 1 && picker("Case", cases.map((one, i) => [String(i), one.name]), (value) => {
      of = cases[Number(value)];
      show();
    })), el("div", { class: "charts" }, ratios.element, frames.element), floor, table);
  show();
  return box;
}

function measurementsTable(comparison: Comparison): HTMLElement {
  const columns: DataColumn<Measurement>[] = [
    { title: "scene", value: (m) => m.scene },
    { title: "D", value: (m) => m.dimension },
    { title: "boxes", value: (m) => m.boxes, text: (m) => grouped(m.boxes) },
    { title: "moving", value: (m) => (m.mode === "track" ? m.moving : null), text: (m) => (m.mode === "track" ? `${rounded(m.moving * 100)} %` : "–") },
    { title: "algorithm", value: labelOf },
    { title: "kind", value: (m) => m.kind },
    { title: "median", value: (m) => m.median_ms, text: (m) => time(m.median_ms) },
    ratioColumn("to the fastest", (m) => m.ratio_to_fastest),
    { title: "least", value: (m) => m.min_ms, text: (m) => time(m.min_ms) },
    { title: "p99", value: (m) => m.p99_ms, text: (m) => time(m.p99_ms) },
    { title: "ns a box", value: (m) => m.ns_per_box, text: (m) => number(m.ns_per_box) },
    { title: "pairs", value: (m) => m.pairs, text: (m) => (m.pairs === null ? "–" : grouped(m.pairs)) },
    { title: "tests", value: (m) => m.tests, text: (m) => number(m.tests) },
    { title: "references", value: (m) => m.references, text: (m) => number(m.references) },
    { title: "memory", value: (m) => m.own_bytes, text: (m) => (m.own_bytes === null ? "–" : bytesText(m.own_bytes)) },
    { title: "outcome", value: outcomeOf },
  ];
  return dataTable({
    caption: "All measurements",
    rows: comparison.measurements,
    columns,
    note: remarksOf,
    search: true,
    filters: [
      { title: "Scene", value: (m) => m.scene },
      { title: "Dimension", value: (m) => `${m.dimension}D` },
      { title: "Kind", value: (m) => m.kind },
      { title: "Algorithm", value: labelOf },
      { title: "Outcome", value: outcomeOf },
    ],
  });
}

export function doubtsOfComparison({ measurements, busy, processor_share }: Comparison): Doubts {
  return {
    busy, processorShare: processor_share, unsteady: measurements.filter(({ unsteady }) => unsteady === true).length,
    measurements: measurements.filter(isTimed).length,
  };
}

/** The sections of a comparison, each [id, title, element]. */
export function comparisonSections(
  comparison: Comparison, date: string,
): [string, string, HTMLElement][] {
  const cases = casesOf(comparison.measurements);
  const target = comparison.measurements.find((measurement) => measurement.target !== null)?.target ?? null;
  const leads = cases.some((of) => leadOf(of) !== undefined);
  const summary = el("section", {}, tiles(comparison, cases), failures(comparison),
    el("div", { class: "card" }, el("h3", {}, "Where this comes from"), facts({ ...comparison, date, target }),
      el("p", { class: "downloads", style: "margin: 1rem 0 0" },
        downloadButton("Save as JSON", "comparison.json", "application/json", () => JSON.stringify(comparison)), " ",
        downloadButton("Save as CSV", "comparison.csv", "text/csv", () => csvOfComparison(comparison)))));
  const charts = el("section", {});
  if (cases.length > 1) {
    add(charts, el("div", { class: "pair" },
      el("div", { class: "card" }, el("h3", {}, "Over all cases"), chartFigure(
        "Times as multiples of the fastest", (place) => drawStandings(cases, place),
        "Geometric mean over the cases that an algorithm does.").element),
      el("div", { class: "card" }, el("h3", {}, "Which algorithm wins where"), chartFigure(
        "The fastest in each case", (place) => drawWinners(cases, place),
        "Scene, boxes and, where they move, how many of them.").element)),
    leads && el("div", { class: "card" }, el("h3", {}, "Against other libraries"), chartFigure(
      "How many times as fast as the fastest peer our best is", (place) => drawLeads(cases, place),
      `Below 1, the peer is faster. Each bar has the colour of our best, which is never auto: that takes one of the others.${whiskersNote(cases)}`).element));
  }
  add(charts, scaling(cases), caseView(cases));
  return [
    ["summary", "Summary", summary],
    ["charts", "Charts", charts],
    ["measurements", "Measurements", el("section", {}, el("div", { class: "card" }, measurementsTable(comparison)))],
  ];
}

// The experiments: each claim, its verdict and what it rests on.
import type { Cell, Experiment, Experiments, Figure, Statement, Table, Verdict } from "../charts/data.ts";
import { bytesText, grouped, rounded } from "../charts/numbers.ts";
import { cellText, drawTableChart } from "../charts/table_chart.ts";
import { dataTable } from "./data_table.ts";
import { el } from "./dom.ts";
import { csvOfTable, downloadButton } from "./downloads.ts";
import { chartFigure } from "./figure.ts";
import { facts, tile } from "./summary.ts";
import type { Doubts } from "./summary.ts";

const looks = {
  "confirmed": ["good", "✓"],
  "holds within bounds": ["fair", "◐"],
  "refuted": ["bad", "✕"],
  "not testable": ["none", "–"],
} as const;

function badge({ verdict }: Statement): HTMLElement {
  const [look, sign] = looks[verdict];
  return el("span", { class: `badge ${look}` }, el("span", { "aria-hidden": "true" }, `${sign} `), verdict);
}

/** What a claim says, one statement a line, with its verdict. */
function statementList(experiment: Experiment): HTMLElement {
  return el("ul", {}, ...experiment.statements.map((one) =>
    el("li", {}, `${one.label}: ${one.text}. `, badge(one), one.condition === "" ? "" : ` ${one.condition}`)));
}

function tableView(table: Table): HTMLElement {
  return el("div", {}, dataTable<Cell[]>({
    caption: table.title,
    rows: table.rows,
    search: table.rows.length > 12,
    columns: table.columns.map((column, i) => ({
      title: column.unit === "" ? column.name : `${column.name} (${column.unit})`,
      value: (row) => row[i] ?? null,
      text: (row) => cellText(row[i] ?? null),
    })),
  }), el("p", { class: "downloads", style: "margin: .5rem 0 1rem" },
    downloadButton("Save as CSV", `${table.name}.csv`, "text/csv", () => csvOfTable(table))));
}

function figureText({ value, unit, low, high }: Figure): string {
  if (unit === "bytes" && value >= 1000) return bytesText(value);
  const interval = low === null || high === null || low === high ? "" : ` (${rounded(low)} to ${rounded(high)})`;
  return rounded(value) + interval + (unit === "" ? "" : ` ${unit}`);
}

function figures(experiment: Experiment): HTMLElement | null {
  const all = Object.entries(experiment.figures);
  if (all.length === 0) return null;
  return el("ul", { class: "figures" }, ...all.map(([name, figure]) =>
    el("li", {}, `${name.replaceAll("_", " ")} `, el("b", {}, figureText(figure)))));
}

function view(experiment: Experiment): HTMLElement {
  const charts = experiment.tables.flatMap((table) => table.charts.map((chart) =>
    chartFigure(chart.title, (place) => drawTableChart(table, chart, place)).element));
  const rows = experiment.tables.reduce((sum, table) => sum + table.rows.length, 0);
  const section = experiment.section === "beyond" ? "our own claim" : `section ${experiment.section} of the paper`;
  return el("article", { class: "card", id: experiment.name, "aria-labelledby": `${experiment.name}-title` },
    el("h3", { id: `${experiment.name}-title` }, `${experiment.label}. ${experiment.title}`),
    el("p", { class: "note" }, section),
    el("blockquote", {}, experiment.claim),
    statementList(experiment),
    el("p", {}, experiment.reason),
    figures(experiment),
    el("p", { class: "note" }, `Measured: ${experiment.measured}`),
    charts.length > 0 && el("div", { class: "charts" }, ...charts),
    el("details", {}, el("summary", {}, `What was measured, as tables (${grouped(rows)} rows)`), ...experiment.tables.map(tableView)));
}

export function doubtsOfExperiments({ experiments, busy, processor_share }: Experiments): Doubts {
  const sum = (of: "unsteady" | "measurements"): number =>
    experiments.reduce((all, one) => all + (one.steadiness?.[of] ?? 0), 0);
  return {
    busy: busy ?? null, processorShare: processor_share ?? null, unsteady: sum("unsteady"), measurements: sum("measurements"),
  };
}

/** The sections of experiments, each [id, title, element]. */
export function experimentSections(results: Experiments): [string, string, HTMLElement][] {
  const { experiments } = results;
  const statements = experiments.flatMap((one) => one.statements);
  const count = (verdict: Verdict): string => String(statements.filter((one) => one.verdict === verdict).length);
  const seconds = experiments.reduce((sum, one) => sum + one.seconds, 0);
  const summary = el("section", {},
    el("dl", { class: "tiles" },
      tile("Statements confirmed", count("confirmed"), `of ${statements.length}`),
      tile("That hold within bounds", count("holds within bounds")),
      tile("Refuted", count("refuted")),
      tile("Not testable", count("not testable")),
      tile("Measured in", `${rounded(seconds)} s`, (results.quick ? "quickly: fewer boxes, fewer samples" : "thoroughly") + (results.stopped ? "; stopped before the end" : ""))),
    el("div", { class: "card" }, el("h3", {}, "Verdicts"), el("ol", { class: "verdicts" }, ...experiments.flatMap((one) =>
      one.statements.map((statement) => el("li", {}, el("span", {}, statement.label),
        el("a", { href: `#${one.name}` }, statement.text), el("span", {}, badge(statement))))))),
    el("div", { class: "card" }, el("h3", {}, "Where this comes from"), facts(results),
      el("p", { class: "downloads", style: "margin: 1rem 0 0" },
        downloadButton("Save as JSON", "experiments.json", "application/json", () => JSON.stringify(results)))));
  return [
    ["verdicts", "Verdicts", summary],
    ["experiments", "Experiments", el("section", {}, ...experiments.map(view))],
  ];
}

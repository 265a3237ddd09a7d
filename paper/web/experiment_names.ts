// What the experiments and their machine come to, as texts and tables.
import type { Experiment, Experiments, Figure, Statement, Table, Verdict } from "../../web/charts/data.ts";
import { bytesText, timeText } from "../../web/charts/numbers.ts";
import { plain, tableText } from "./markdown.ts";
import { processorName, shown, withUnit } from "./words.ts";

export const isOwn = ({ section }: Experiment): boolean => section === "beyond";

/** The verdict with its condition. */
export function verdictText({ verdict, condition }: Statement): string {
  return condition === "" ? verdict : `${verdict}: ${condition}`;
}

export function sectionText(section: string): string {
  return section === "beyond" ? "our own claim" : `section ${section}`;
}

/** What a statement says, what became of it, what was asked and the figures that decided, a line each. */
export function statementsList(experiment: Experiment): string {
  return experiment.statements
    .map((one) => {
      const asked = one.threshold ? ` Asked: ${plain(one.threshold)}.` : "";
      const evidence = one.evidence.map((name) => plain(evidenceText(experiment, name))).join("; ");
      const condition = one.condition === "" ? "" : `: ${plain(one.condition)}`;
      return `- *${plain(one.text)}*: ${outcome(one)}${condition}.${asked}${evidence === "" ? "" : ` Figures: ${evidence}.`}`;
    })
    .join("\n");
}

/** The beginning of a row: the claim, what it says, what became of it, and what was asked; the evidence follows. */
export function judgedRow(one: Statement, address: string): string {
  const condition = one.condition === "" ? "" : `: ${plain(one.condition)}`;
  return `| [${one.label}](${address}) | ${plain(one.text)} | ${outcome(one)}${condition} | ${plain(one.threshold || "-")} |`;
}

const outcome = ({ verdict }: Statement): string => `**${verdict}**`;

/** "1.45 to 1.55"; empty for counts, and for times of too few rounds to tell. */
export const intervalText = ({ low, high }: Figure): string =>
  low === null || high === null || low === high ? "" : `${shown(low)} to ${shown(high)}`;

/** "mending growth 1.50 (1.45 to 1.55)". */
function evidenceText(experiment: Experiment, name: string): string {
  const figure = experiment.figures[name]!;
  const words = name.replaceAll("_", " ");
  const interval = intervalText(figure);
  if (interval === "") return `${words} ${withUnit(figure.value, figure.unit)}`;
  return `${words} ${shown(figure.value)} (${interval})${figure.unit === "" ? "" : ` ${figure.unit}`}`;
}

/** How many claims and statements there are, and what became of the statements. */
function counts(experiments: readonly Experiment[]): Record<string, string> {
  const statements = experiments.flatMap((one) => one.statements);
  const count = (verdict: Verdict) => shown(statements.filter((one) => one.verdict === verdict).length);
  return {
    claims: shown(experiments.length),
    statements: shown(statements.length),
    confirmed: count("confirmed"),
    within_bounds: count("holds within bounds"),
    refuted: count("refuted"),
    not_testable: count("not testable"),
  };
}

export function machineData(results: Experiments): Record<string, unknown> {
  const { machine, build, experiments } = results;
  const draft = experiments.filter((one) => !isOwn(one));
  const own = experiments.filter(isOwn);
  return {
    machine: {
      cpu: processorName(machine),
      cores: shown(machine.cores ?? 0),
      memory: bytesText(machine.memory_bytes ?? 0),
      os: machine.os,
      instruction_set: results.target,
    },
    build: { version: build.version, revision: build.revision, compiler: build.compiler, flags: build.flags },
    date: results.date,
    experiments: {
      ...counts(draft),
      own: counts(own),
      time: timeText(1000 * experiments.reduce((sum, one) => sum + one.seconds, 0)),
      command: results.command.join(" "),
      quick: results.quick,
      measurements: shown(experiments.reduce((sum, one) => sum + (one.steadiness?.measurements ?? 0), 0)),
      unsteady: shown(experiments.reduce((sum, one) => sum + (one.steadiness?.unsteady ?? 0), 0)),
    },
  };
}

/** Every figure that an experiment came to. */
export function figuresTable({ experiments }: Experiments): string {
  return tableText(
    ["experiment", "figure", " value", " interval"],
    experiments.flatMap(({ name: experiment, figures }) =>
      Object.entries(figures).map(([name, figure]) => [
        `\`${experiment}\``,
        `\`${name}\``,
        withUnit(figure.value, figure.unit),
        intervalText(figure) || "-",
      ]),
    ),
  );
}

/** The places of the columns of a ratio's bounds, where these stand behind it. */
function boundsOf({ columns }: Table, i: number): [low: number, high: number] | undefined {
  const name = columns[i]!.name;
  return columns[i + 1]?.name === `${name} low` && columns[i + 2]?.name === `${name} high` ? [i + 1, i + 2] : undefined;
}

/** A table of results as Markdown; a ratio has its interval in brackets. */
export function resultsTable(table: Table): string {
  const bounds = table.columns.map((_, i) => boundsOf(table, i));
  const hidden = new Set(bounds.flatMap((places) => places ?? []));
  const kept = table.columns.flatMap((column, i) => (hidden.has(i) ? [] : [{ ...column, i }]));
  const columns = kept.map(({ name, unit, i }) => {
    const heading = plain(unit === "" || unit === "bytes" ? name : `${name} (${unit})`);
    return table.rows.some((row) => typeof row[i] === "string") ? heading : ` ${heading}`;
  });
  const rows = table.rows.map((row) =>
    kept.map(({ unit, i }) => {
      const cell = row[i] ?? null;
      if (cell === null) return "-";
      if (typeof cell === "string") return plain(cell);
      const [low, high] = (bounds[i] ?? []).map((at) => row[at]);
      if (typeof low === "number" && typeof high === "number" && low !== high)
        return `${shown(cell)} (${shown(low)} to ${shown(high)})`;
      return unit === "bytes" ? bytesText(cell) : shown(cell);
    }),
  );
  return tableText(columns, rows);
}

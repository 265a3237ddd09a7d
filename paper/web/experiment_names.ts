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

/** What a statement says and what became of it, a line each. */
export function statementsList({ statements }: Experiment): string {
  return statements
    .map((one) => `- *${plain(one.text)}*: ${outcome(one)}${one.condition === "" ? "" : `: ${plain(one.condition)}`}.`)
    .join("\n");
}

const outcome = ({ verdict }: Statement): string => `**${verdict}**`;

/** "1.45 to 1.55"; empty for counts, and for times of too few rounds to tell. */
const intervalText = ({ low, high }: Figure): string =>
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
    },
  };
}

/** The statements of these claims, with what became of each and the figures that decided. */
export function verdictsTable(
  experiments: readonly Experiment[], address: (experiment: Experiment) => string,
): string {
  return tableText(
    ["claim", "what it says", "outcome", "condition", "evidence"],
    experiments.flatMap((one) =>
      one.statements.map((statement) => [
        `[${statement.label}](${address(one)})`,
        plain(statement.text),
        outcome(statement),
        statement.condition === "" ? "-" : plain(statement.condition),
        statement.evidence.map((name) => plain(evidenceText(one, name))).join("; ") || "-",
      ]),
    ),
  );
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

/** A table of results as Markdown. */
export function resultsTable(table: Table): string {
  const columns = table.columns.map(({ name, unit }, i) => {
    const heading = plain(unit === "" || unit === "bytes" ? name : `${name} (${unit})`);
    return table.rows.some((row) => typeof row[i] === "string") ? heading : ` ${heading}`;
  });
  const rows = table.rows.map((row) =>
    row.map((cell, i) => {
      if (cell === null) return "-";
      if (typeof cell === "string") return plain(cell);
      return table.columns[i]?.unit === "bytes" ? bytesText(cell) : shown(cell);
    }),
  );
  return tableText(columns, rows);
}

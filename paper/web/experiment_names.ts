// What the experiments and their machine come to, as texts and tables.
import type { Experiment, Experiments, Table } from "../../web/charts/data.ts";
import { bytesText, timeText } from "../../web/charts/numbers.ts";
import { plain, tableText } from "./markdown.ts";
import { processorName, shown, withUnit } from "./words.ts";

/** The verdict with its condition, which goes on after "holds when". */
export function verdictText({ verdict, condition }: Experiment): string {
  return verdict === "holds when" ? `holds when ${condition}` : verdict;
}

export function sectionText(section: string): string {
  return section === "beyond" ? "beyond the draft" : `section ${section}`;
}

export function machineData(results: Experiments): Record<string, unknown> {
  const { machine, build, experiments } = results;
  const count = (verdict: string) => shown(experiments.filter((one) => one.verdict === verdict).length);
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
      count: shown(experiments.length),
      hold: count("holds"),
      hold_when: count("holds when"),
      fail: count("does not hold"),
      any_fail: experiments.some((one) => one.verdict === "does not hold"),
      time: timeText(1000 * experiments.reduce((sum, one) => sum + one.seconds, 0)),
      command: results.command.join(" "),
      quick: results.quick,
    },
  };
}

export function verdictsTable({ experiments }: Experiments, address: (experiment: Experiment) => string): string {
  return tableText(
    [" claim", "what it says", "section", "verdict"],
    experiments.map((one) => [String(one.number), `[${plain(one.title)}](${address(one)})`, plain(one.section), plain(verdictText(one))]),
  );
}

/** Each verdict with its condition and what decided it. */
export function findingsTable({ experiments }: Experiments, address: (experiment: Experiment) => string): string {
  return tableText(
    [" claim", "what it says", "section", "verdict", "what decided"],
    experiments.map((one) => [
      String(one.number),
      `[${plain(one.title)}](${address(one)})`,
      plain(one.section),
      plain(verdictText(one)),
      plain(one.reason),
    ]),
  );
}

/** Every figure that an experiment came to. */
export function figuresTable({ experiments }: Experiments): string {
  return tableText(
    ["experiment", "figure", " value"],
    experiments.flatMap(({ name: experiment, figures }) =>
      Object.entries(figures).map(([name, { value, unit }]) => [
        `\`${experiment}\``,
        `\`${name}\``,
        withUnit(value, unit),
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

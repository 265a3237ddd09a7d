// What the experiments and their machine come to, as texts and tables.
import type { Experiment, Experiments, Table } from "../charts/data.ts";
import { bytes_text, time_text } from "../charts/numbers.ts";
import { plain, table_text } from "./markdown.ts";
import { shown, with_unit } from "./words.ts";

/** The verdict with its condition, which goes on after "holds when". */
export function verdict_text({ verdict, condition }: Experiment): string {
  return verdict === "holds when" ? `holds when ${condition}` : verdict;
}

export function section_text(section: string): string {
  return section === "beyond" ? "beyond the draft" : `section ${section}`;
}

export function machine_data(results: Experiments): Record<string, unknown> {
  const { machine, build, experiments } = results;
  const count = (verdict: string) => shown(experiments.filter((one) => one.verdict === verdict).length);
  return {
    machine: {
      cpu: (machine.cpu ?? "").replace(/\((R|TM)\)/g, ""),
      cores: shown(machine.cores ?? 0),
      memory: bytes_text(machine.memory_bytes ?? 0),
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
      time: time_text(1000 * experiments.reduce((sum, one) => sum + one.seconds, 0)),
      command: results.command.join(" "),
      quick: results.quick,
    },
  };
}

export function verdicts_table({ experiments }: Experiments): string {
  return table_text(
    [" claim", "what it says", "section", "verdict"],
    experiments.map((one) => [String(one.number), `[${plain(one.title)}](#${one.name})`, plain(one.section), plain(verdict_text(one))]),
  );
}

/** Every figure that an experiment came to. */
export function figures_table({ experiments }: Experiments): string {
  return table_text(
    ["experiment", "figure", " value"],
    experiments.flatMap(({ name: experiment, figures }) =>
      Object.entries(figures).map(([name, { value, unit }]) => [
        `\`${experiment}\``,
        `\`${name}\``,
        with_unit(value, unit),
      ]),
    ),
  );
}

/** A table of results as Markdown. */
export function results_table(table: Table): string {
  const columns = table.columns.map(({ name, unit }, i) => {
    const heading = plain(unit === "" || unit === "bytes" ? name : `${name} (${unit})`);
    return table.rows.some((row) => typeof row[i] === "string") ? heading : ` ${heading}`;
  });
  const rows = table.rows.map((row) =>
    row.map((cell, i) => {
      if (cell === null) return "-";
      if (typeof cell === "string") return plain(cell);
      return table.columns[i]?.unit === "bytes" ? bytes_text(cell) : shown(cell);
    }),
  );
  return table_text(columns, rows);
}

// The results that the paper quotes, read from JSON and checked: what is not as the program writes it is refused.
import type { Comparison, Experiments, Verdict } from "../../web/charts/data.ts";
import { Problem } from "./problem.ts";

type Kind = "a text" | "a finite number" | "true or false" | "a list" | "an object";

function isA(kind: Kind, value: unknown): boolean {
  switch (kind) {
    case "a text":
      return typeof value === "string";
    case "a finite number":
      return typeof value === "number" && Number.isFinite(value);
    case "true or false":
      return typeof value === "boolean";
    case "a list":
      return Array.isArray(value);
    case "an object":
      return typeof value === "object" && value !== null && !Array.isArray(value);
  }
}

function found(value: unknown): string {
  if (value === undefined) return "nothing";
  const text = typeof value === "number" ? String(value) : JSON.stringify(value);
  return text.length > 60 ? `${text.slice(0, 60)}...` : text;
}

/** A value of JSON and where it stands, so that errors can say so. */
class Place {
  constructor(
    readonly value: unknown,
    readonly where: string,
  ) {}

  refuse(expected: string): never {
    throw new Problem(`${this.where}: ${found(this.value)}; expected ${expected}`);
  }

  is(kind: Kind): this {
    if (!isA(kind, this.value)) this.refuse(kind);
    return this;
  }

  isOneOf(texts: readonly string[]): void {
    if (!texts.includes(this.value as string)) this.refuse(texts.map((text) => `'${text}'`).join(" or "));
  }

  at(name: string): Place {
    return new Place((this.is("an object").value as Record<string, unknown>)[name], `${this.where}: ${name}`);
  }

  list(): Place[] {
    return (this.is("a list").value as unknown[]).map((value, i) => new Place(value, `${this.where}[${i}]`));
  }

  entries(): Place[] {
    return Object.keys(this.is("an object").value as object).map((name) => this.at(name));
  }

  /** Each of the names has to be there, and to be of a kind. */
  has(kind: Kind, ...names: string[]): this {
    for (const name of names) this.at(name).is(kind);
    return this;
  }

  hasOrNull(kind: Kind, ...names: string[]): this {
    for (const name of names) if (this.at(name).value !== null) this.at(name).is(kind);
    return this;
  }
}

function rootOf(text: string, file: string, ...schemas: string[]): Place {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch (error) {
    throw new Problem(`${file}: ${(error as Error).message}; expected JSON of the schema '${schemas[0]}'`);
  }
  const root = new Place(value, file);
  root.at("schema").isOneOf(schemas);
  root.has("true or false", "stopped").has("a list", "command");
  if (root.at("stopped").value === true) root.at("stopped").refuse("false: results of a whole run");
  for (const word of root.at("command").list()) word.is("a text");
  root.at("machine").has("a text", "cpu", "os").has("a finite number", "cores", "memory_bytes");
  root.at("build").has("a text", "version", "revision", "compiler", "type", "flags");
  return root;
}

function checkChart(chart: Place): void {
  chart.has("a text", "title", "x", "y", "series", "value").has("true or false", "log_x", "log_y");
  chart.at("kind").isOneOf(["lines", "bars", "map"]);
  for (const pair of chart.at("where").list()) {
    if (pair.list().length !== 2) pair.refuse("a column and a text");
    for (const text of pair.list()) text.is("a text");
  }
}

function checkTable(table: Place): void {
  table.has("a text", "name", "title");
  const columns = table.at("columns").list();
  for (const column of columns) column.has("a text", "name", "unit");
  for (const chart of table.at("charts").list()) checkChart(chart);
  for (const row of table.at("rows").list()) {
    const cells = row.list();
    if (cells.length !== columns.length) row.refuse(`${columns.length} cells, one a column`);
    for (const cell of cells)
      if (cell.value !== null && typeof cell.value !== "string") cell.is("a finite number");
  }
}

const verdicts: readonly Verdict[] = ["confirmed", "holds within bounds", "refuted", "not testable"];

function checkExperiment(experiment: Place): void {
  experiment.has("a text", "label", "name", "title", "claim", "section", "measured", "reason");
  experiment.has("a finite number", "seconds");
  for (const figure of experiment.at("figures").entries())
    figure.has("a finite number", "value").has("a text", "unit").hasOrNull("a finite number", "low", "high");
  const statements = experiment.at("statements").list();
  if (statements.length === 0) experiment.at("statements").refuse("at least one statement");
  for (const statement of statements) {
    statement.has("a text", "label", "name", "text", "condition");
    statement.at("verdict").isOneOf(verdicts);
    for (const figure of statement.at("evidence").list())
      experiment.at("figures").has("an object", figure.is("a text").value as string);
  }
  for (const table of experiment.at("tables").list()) checkTable(table);
}

/** Reads what `broadside experiment --json` wrote. Throws Problem. */
export function readExperiments(text: string, file: string): Experiments {
  const root = rootOf(text, file, "broadside.experiments/2");
  root.has("a text", "target", "date").has("true or false", "quick");
  const experiments = root.at("experiments").list();
  if (experiments.length === 0) root.at("experiments").refuse("at least one experiment");
  for (const experiment of experiments) checkExperiment(experiment);
  return root.value as Experiments;
}

function checkMeasurement(measurement: Place): void {
  measurement.has("a text", "scene", "algorithm").has("a list", "seeds");
  measurement.has("a finite number", "dimension", "boxes", "frames", "moving", "threads");
  measurement.hasOrNull("a finite number", "drift", "teleport", "pairs", "median_ms", "p99_ms", "floor_ms");
  measurement.hasOrNull("a text", "skipped").hasOrNull("true or false", "verified");
  measurement.at("kind").isOneOf(["own", "paper", "literature", "peer", "user"]);
  measurement.at("mode").isOneOf(["find", "track"]);
  if (measurement.at("verified").value === false)
    measurement.at("verified").refuse("true: nothing is quoted that is wrong");
}

function checkRatio(ratio: Place): void {
  if (ratio.value === null) return;
  ratio.has("a text", "of").has("a finite number", "median", "rounds").hasOrNull("a finite number", "low", "high");
}

/** Reads what `broadside compare --json` wrote, with samples or without. Throws Problem. */
export function readComparison(text: string, file: string): Comparison {
  const root = rootOf(text, file, "broadside.results/2");
  root.has("a text", "date").has("a finite number", "processor_share").has("true or false", "busy");
  const measurements = root.at("measurements").list();
  if (measurements.length === 0) root.at("measurements").refuse("at least one measurement");
  for (const measurement of measurements) {
    checkMeasurement(measurement);
    measurement.hasOrNull("a finite number", "rounds");
    for (const name of ["ratio_to_fastest", "ratio_to_best_own", "ratio_to_fastest_peer"])
      checkRatio(measurement.at(name));
  }
  return root.value as Comparison;
}

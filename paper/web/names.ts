// What templates may name: the machine, the experiments and what they came to, the comparison, figures and sources.
import type { ChartSpec, Comparison, Experiment, Experiments, Figure, Statement, Table, Verdict } from "../../web/charts/data.ts";
import type { Drawn, Place } from "../../web/charts/frame.ts";
import { drawTableChart } from "../../web/charts/table_chart.ts";
import {
  comparisonCharts, comparisonData, groupsTable, leadsTable, literatureTable, lostList, rivalsTable, sceneParameters,
  standingsTable, versionOf,
} from "./comparison_names.ts";
import {
  figuresTable, intervalText, judgedRow, machineData, resultsTable, sectionText, statementsList, verdictText,
} from "./experiment_names.ts";
import { factsOf, levelOf, lostOf, type Facts } from "./facts.ts";
import type { Names } from "./fill.ts";
import { plain } from "./markdown.ts";
import { Numbering } from "./numbering.ts";
import { listed, Problem } from "./problem.ts";
import { shown, withUnit } from "./words.ts";

/** Where `make playground` puts the playground: named, not linked, since a clone does not have it. */
const playground = "build/playground/index.html";

const narrow = 420;
const wide = 760;

/** A figure of the paper. */
export interface Drawing {
  caption: string;
  /** In pixels: two narrow ones stand beside each other in print. */
  width: number;
  draw: (place: Place) => Drawn;
}

/** What `key` is among `all`. Throws Problem naming those there are. */
function oneOf<Thing>(all: Record<string, Thing>, key: string, what: string): Thing {
  const thing = Object.hasOwn(all, key) ? all[key] : undefined;
  if (thing === undefined) throw new Problem(`no ${what} '${key}'; there are ${listed(Object.keys(all))}`);
  return thing;
}

const by = <Thing>(all: readonly Thing[], key: (thing: Thing) => string): Record<string, Thing> =>
  Object.fromEntries(all.map((thing) => [key(thing), thing]));

/** A drawing's name, which is its file's: short, and unique where names of experiments and tables are. */
function drawingName(experiment: Experiment, table: Table, chart: ChartSpec): string {
  const name = `${experiment.name}_${table.name}`;
  return table.charts.length === 1 ? name : `${name}_${table.charts.indexOf(chart) + 1}`;
}

/** The chart's title, and the table's where that says more. */
function captionOf(table: Table, chart: ChartSpec): string {
  const [begin = ""] = table.title.split(/[:;,]/, 1);
  return chart.kind === "map" || chart.title.includes(begin) ? chart.title : `${chart.title}. ${table.title}`;
}

/** Results as templates name them. What is drawn, and how figures and sources are numbered, is kept here. */
export class Paper {
  /** Of the pass that is going on, by the name of its file. */
  readonly drawings = new Map<string, Drawing>();
  /** The page that is being filled: each has its own figures. */
  private page = "";
  private readonly figuresOf = new Map<string, Numbering>();
  /** On which pages the sections of experiments and the sources are. */
  private readonly sectionPages = new Map<string, string>();
  private readonly sourcePages = new Map<string, string>();
  private readonly sources = new Numbering("source");
  private readonly cited = new Set<string>();
  private readonly judged = new Set<string>();
  private readonly experiments: Record<string, Experiment>;
  private readonly facts: Facts;

  constructor(
    private readonly results: Experiments,
    private readonly comparison: Comparison,
    comparison_file: string,
    private readonly pictures: readonly string[],
  ) {
    this.experiments = by(results.experiments, (experiment) => experiment.name);
    this.facts = factsOf(comparison, comparison_file);
  }

  /** Ends a pass over all templates: after the first, numbers of figures and sources are known. */
  endPass(): void {
    for (const figures of this.figuresOf.values()) figures.endPass();
    this.sources.endPass();
  }

  beginPass(): void {
    this.drawings.clear();
  }

  beginPage(page: string): void {
    this.page = page;
    if (!this.figuresOf.has(page)) this.figuresOf.set(page, new Numbering("figure"));
  }

  private get figures(): Numbering {
    return this.figuresOf.get(this.page)!;
  }

  /** How many figures a page has. */
  figureCount(page: string): number {
    return this.figuresOf.get(page)!.all().length;
  }

  /** A link's address: of a place on a page, from the page that is being filled. */
  private address(place: string, page: string | undefined): string {
    return page === undefined || page === this.page ? `#${place}` : `${page}#${place}`;
  }

  private addressOf(experiment: Experiment): string {
    return this.address(experiment.name, this.sectionPages.get(experiment.name));
  }

  /** Statements that no row has, where there are rows of some. */
  unjudged(): string[] {
    const all = this.results.experiments.flatMap((one) => one.statements.map(({ name }) => `${one.name}: ${name}`));
    return this.judged.size === 0 ? [] : all.filter((name) => !this.judged.has(name));
  }

  /** Sources that no template cites. */
  uncited(): string[] {
    return this.sources.all().filter((source) => !this.cited.has(source));
  }

  private experiment(name: string): Experiment {
    return oneOf(this.experiments, name, "experiment");
  }

  private table(experiment: string, name: string): Table {
    const tables = by(this.experiment(experiment).tables, (table) => table.name);
    return oneOf(tables, name, `table in the experiment '${experiment}':`);
  }

  private statement(experiment: string, name: string): Statement {
    const statements = by(this.experiment(experiment).statements, (statement) => statement.name);
    return oneOf(statements, name, `statement in the experiment '${experiment}':`);
  }

  private figure(experiment: string, name: string): Figure {
    return oneOf(this.experiment(experiment).figures, name, `figure in the experiment '${experiment}':`);
  }

  private show(path: string, name: string, caption: string, after = ""): string {
    const alternative = caption.replace(/[[\]]/g, "");
    return `![${alternative}](${path})\n\n*Figure ${this.figures.next(name)}. ${plain(caption)}${after}*`;
  }

  private draw(name: string, drawing: Drawing): string {
    this.drawings.set(name, drawing);
    return this.show(`figures/${name}.svg`, name, drawing.caption);
  }

  private drawChart(experiment: Experiment, table: Table, chart: ChartSpec, caption = captionOf(table, chart)): string {
    const draw = (place: Place) => drawTableChart(table, chart, place);
    return this.draw(drawingName(experiment, table, chart), { caption, width: narrow, draw });
  }

  private see(names: readonly string[]): string {
    const numbers = this.figures.numbersOf(names).map(String);
    return `${numbers.length === 1 ? "Figure" : "Figures"} ${listed(numbers)}`;
  }

  names(): Names {
    const of = (name: string) => this.experiment(name);
    const value = (experiment: string, name: string) => this.figure(experiment, name).value;
    const is = (verdict: Verdict) => (experiment: string, name: string) =>
      this.statement(experiment, name).verdict === verdict;
    const comparison = comparisonCharts(this.facts);
    return {
      data: { ...machineData(this.results), comparison: comparisonData(this.facts, this.comparison) },
      helpers: {
        heading: (experiment) => {
          const { name, label, title } = of(experiment);
          this.sectionPages.set(name, this.page);
          return `<a id="${name}"></a>Claim ${label}: ${plain(title)}`;
        },
        number: (experiment) => `[${of(experiment).label}](${this.addressOf(of(experiment))})`,
        claim: (experiment) => `> ${plain(of(experiment).claim)}\n>\n> (${sectionText(of(experiment).section)})`,
        measured: (experiment) => plain(of(experiment).measured),
        statements: (experiment) => statementsList(of(experiment)),
        verdict: (experiment, name) => plain(verdictText(this.statement(experiment, name))),
        reason: (experiment) => plain(of(experiment).reason),
        figure: (experiment, name) => {
          const figure = this.figure(experiment, name);
          return withUnit(figure.value, figure.unit);
        },
        value: (experiment, name) => shown(value(experiment, name)),
        table: (experiment, name) => {
          const table = this.table(experiment, name);
          return `*${plain(table.title)}*\n\n${resultsTable(table)}`;
        },
        chart: (experiment, name, title) => {
          const table = this.table(experiment, name);
          const charts = by(table.charts, (chart) => chart.title);
          return this.drawChart(of(experiment), table, oneOf(charts, title, `chart of the table '${name}':`));
        },
        captioned_chart: (experiment, name, title, caption) => {
          const table = this.table(experiment, name);
          const charts = by(table.charts, (chart) => chart.title);
          return this.drawChart(of(experiment), table, oneOf(charts, title, `chart of the table '${name}':`), caption);
        },
        charts: (experiment) =>
          of(experiment)
            .tables.flatMap((table) => table.charts.map((chart) => this.drawChart(of(experiment), table, chart)))
            .join("\n\n"),
        see: (experiment) =>
          this.see(
            of(experiment).tables.flatMap((table) =>
              table.charts.map((chart) => drawingName(of(experiment), table, chart)),
            ),
          ),
        judged: (experiment, name) => {
          const one = of(experiment);
          this.judged.add(`${experiment}: ${name}`);
          return judgedRow(this.statement(experiment, name), this.addressOf(one));
        },
        with_interval: (experiment, name) => {
          const figure = this.figure(experiment, name);
          const interval = intervalText(figure);
          return interval === "" ? withUnit(figure.value, figure.unit)
            : `${shown(figure.value)} (${interval})${figure.unit === "" ? "" : ` ${figure.unit}`}`;
        },
        all_figures: () => figuresTable(this.results),
        confirmed: is("confirmed"),
        within_bounds: is("holds within bounds"),
        refuted: is("refuted"),
        not_testable: is("not testable"),
        given: (experiment, name) => Object.hasOwn(of(experiment).figures, name),
        less: (experiment, first, second) => value(experiment, first) < value(experiment, second),
        scene: (name) => {
          const scenes = by(this.facts.cases, (one) => one.scene.split(":")[0]!);
          oneOf(scenes, name, "scene in the comparison:");
          return `\`${name}\``;
        },
        leads: (which) => leadsTable(this.facts, which),
        groups: () => groupsTable(this.facts),
        rivals: () => rivalsTable(this.facts),
        parameters: (scene) => plain(sceneParameters(this.facts, scene)),
        version: (algorithm) => versionOf(this.comparison, algorithm),
        literature: () => literatureTable(this.facts),
        any_literature: () => this.facts.literature.length > 0,
        lost: () => lostList(this.facts),
        any_lost: () => lostOf(this.facts.leads).length > 0,
        any_level: () => levelOf(this.facts.leads).length > 0,
        standings: () => standingsTable(this.facts),
        picture: (name, caption, link) => {
          const path = oneOf(by(this.pictures, (picture) => picture.split("/").at(-1)!), `${name}.svg`, "picture");
          const live = `. To move its boxes, run \`make playground\` and open \`${playground}#${link}\``;
          return this.show(path, `picture ${name}`, caption, live);
        },
        comparison_chart: (name) =>
          this.draw(`comparison_${name}`, { ...oneOf(comparison, name, "chart of the comparison"), width: wide }),
        see_picture: (name) => this.see([`picture ${name}`]),
        see_comparison: (name) => this.see([`comparison_${name}`]),
        cite: (source) => {
          this.cited.add(source);
          return `[[${this.sources.numberOf(source)}]](${this.address(source, this.sourcePages.get(source))})`;
        },
        source: (source) => {
          this.sourcePages.set(source, this.page);
          return `${this.sources.next(source)}. <a id="${source}"></a>`;
        },
      },
    };
  }
}

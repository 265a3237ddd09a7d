// The paper and its supplements: their templates filled, their figures drawn.
import { light } from "../../web/charts/theme.ts";
import { svgOf } from "../../web/charts/render.ts";
import { fill, type Template } from "./fill.ts";
import { Paper } from "./names.ts";
import { listed, Problem } from "./problem.ts";
import { quoted, quotesOn } from "./quotes.ts";
import { readComparison, readExperiments } from "./results.ts";
import { wrapped } from "./wrap.ts";

export interface Sources {
  /** The paper's chapters, in order. */
  templates: Template[];
  /** Pages beside the paper, by their names: "claims.md". What is long is there. */
  supplements: Record<string, Template>;
  experiments: { file: string; text: string };
  comparison: { file: string; text: string };
  /** Passages that other pages quote, by name, and these pages, by their paths from docs/paper/. */
  quotes: Record<string, Template>;
  quoting: Record<string, string>;
  /** The paths of drawings that are there already. */
  pictures: string[];
}

/** Paths from docs/paper/ and what stands there. */
export type Document = Map<string, string>;

const notice = "<!-- Made by `make paper` from paper/templates/ and paper/results/; edit those. -->\n\n";
/** More would not be printed. */
export const mostFigures = 25;

/** The same sources give the same bytes everywhere. Throws Problem. */
export function documentOf(sources: Sources): Document {
  const experiments = readExperiments(sources.experiments.text, sources.experiments.file);
  const comparison = readComparison(sources.comparison.text, sources.comparison.file);
  if (sources.templates.length === 0) throw new Problem("0 templates; expected at least one *.md");
  const paper = new Paper(experiments, comparison, sources.comparison.file, sources.pictures);
  const names = paper.names();
  const pages: Record<string, Template[]> = { "paper.md": sources.templates };
  for (const [page, template] of Object.entries(sources.supplements)) pages[page] = [template];
  const texts = new Map<string, string>();
  for (const pass of ["to number figures and sources", "to refer to them"]) {
    void pass;
    paper.beginPass();
    for (const [page, templates] of Object.entries(pages)) {
      paper.beginPage(page);
      texts.set(page, templates.map((template) => fill(template, names).trim()).join("\n\n"));
    }
    paper.endPass();
  }
  const quotes = new Map(Object.entries(sources.quotes).map(([name, template]) => [name, wrapped(fill(template, names).trim())]));
  const unused = [...quotes.keys()].filter((name) => !Object.values(sources.quoting).some((page) => quotesOn(page).includes(name)));
  if (unused.length > 0) throw new Problem(`no page quotes ${listed(unused)}; expected each on a page`);
  const uncited = paper.uncited();
  if (uncited.length > 0) throw new Problem(`nothing cites the source ${listed(uncited)}; expected every one cited`);
  const unjudged = paper.unjudged();
  if (unjudged.length > 0) throw new Problem(`no row is of the statement ${listed(unjudged)}; expected one of each`);
  const figures = paper.figureCount("paper.md");
  if (figures > mostFigures)
    throw new Problem(`paper.md: ${figures} figures; expected at most ${mostFigures}: move some to a supplement`);

  const document: Document = new Map([...texts].map(([page, text]) => [page, `${notice}${wrapped(text)}\n`]));
  for (const [name, { caption, width, draw }] of paper.drawings) {
    const drawn = draw({ theme: light, width });
    document.set(`figures/${name}.svg`, svgOf(drawn, { width, background: light.background, title: caption }));
  }
  for (const [path, page] of Object.entries(sources.quoting)) document.set(path, quoted(path, page, quotes));
  return document;
}

// The paper: its templates filled, its figures drawn.
import { light } from "../../web/charts/theme.ts";
import { svgOf } from "../../web/charts/render.ts";
import { fill, type Template } from "./fill.ts";
import { Paper } from "./names.ts";
import { listed, Problem } from "./problem.ts";
import { readComparison, readExperiments } from "./results.ts";
import { wrapped } from "./wrap.ts";

export interface Sources {
  templates: Template[];
  experiments: { file: string; text: string };
  comparison: { file: string; text: string };
  /** The names of those in docs/pictures/. */
  pictures: string[];
}

/** Paths under docs/paper/ and what stands there. */
export type Document = Map<string, string>;

const notice = "<!-- Made by `make paper` from paper/templates/ and paper/results/; edit those. -->\n\n";
const width = 760;

/** The same sources give the same bytes everywhere. Throws Problem. */
export function documentOf(sources: Sources): Document {
  const experiments = readExperiments(sources.experiments.text, sources.experiments.file);
  const comparison = readComparison(sources.comparison.text, sources.comparison.file);
  if (sources.templates.length === 0) throw new Problem("0 templates; expected at least one *.md");
  const paper = new Paper(experiments, comparison, sources.comparison.file, sources.pictures);
  const names = paper.names();
  let text = "";
  for (const pass of ["to number figures and sources", "to refer to them"]) {
    void pass;
    paper.beginPass();
    text = sources.templates.map((template) => fill(template, names).trim()).join("\n\n");
    paper.endPass();
  }
  const uncited = paper.uncited();
  if (uncited.length > 0) throw new Problem(`nothing cites the source ${listed(uncited)}; expected every one cited`);

  const document: Document = new Map([["paper.md", `${notice}${wrapped(text)}\n`]]);
  for (const [name, { caption, draw }] of paper.drawings) {
    const drawn = draw({ theme: light, width });
    document.set(`figures/${name}.svg`, svgOf(drawn, { width, background: light.background, title: caption }));
  }
  return document;
}

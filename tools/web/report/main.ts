// The report: builds the page from the document that the program embedded in it.
import type { Comparison } from "../charts/data.ts";
import { comparisonSections, doubtsOfComparison } from "./comparison_section.ts";
import { add, el } from "./dom.ts";
import { drawingSection } from "./drawing_section.ts";
import type { Drawing } from "./drawing_section.ts";
import { doubtsNotice } from "./summary.ts";
import { beginThemes } from "./themes.ts";

/** Written by lab/report/page.cpp. */
interface ReportDocument {
  date: string;
  comparison: Comparison;
  drawings: Drawing[];
}

function build({ date, comparison, drawings }: ReportDocument): void {
  const sections = comparisonSections(comparison, date);
  const pictures = drawingSection(drawings);
  // The long table comes last: in print it has pages of its own.
  if (pictures !== undefined) sections.splice(-1, 0, pictures);

  const title = "Algorithms compared";
  const intro = "Ways of finding all overlapping pairs of axis-aligned boxes, timed on the same boxes. Every result that has a time was verified in the same run.";
  document.title = `Broadside: ${title.toLowerCase()}${date === "" ? "" : `, ${date}`}`;
  const main = document.getElementById("main");
  const nav = document.getElementById("sections");
  if (main === null || nav === null) return;
  add(nav, el("ul", {}, ...sections.map(([id, name]) => el("li", {}, el("a", { href: `#${id}` }, name)))));
  add(main, el("div", { class: "intro" }, el("h1", {}, title), el("p", {}, intro),
    doubtsNotice(doubtsOfComparison(comparison))));
  for (const [id, name, section] of sections) {
    section.id = id;
    section.setAttribute("aria-labelledby", `${id}-heading`);
    section.prepend(el("h2", { id: `${id}-heading` }, name));
    add(main, section);
  }
}

beginThemes();
build(JSON.parse(document.getElementById("document")?.textContent ?? "null") as ReportDocument);

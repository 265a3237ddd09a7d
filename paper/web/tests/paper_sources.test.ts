// What pages quote of the comparison comes from one file, and the printed paper is the paper.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { withoutQuotes } from "../quotes.ts";
import { project } from "./fixture.ts";

/** What a comparison came to, in words that pages have used for it. */
const figures = [
  /times\s+as\s+fast\s+as\s+the\s+(?:fastest|best)\s+(?:peer|of)/,
  /best\s+of\s+ours\s+is\s+\S*\d/,
  /\bleads?\b[^.|:]{0,120}\s\d+(?:\.\d+)?\s+(?:times|instead)/,
  /`?broadside\s+compare`?\s+of\s+revision/,
  /\b(?:boost|embree|cgal|bullet|chipmunk|fcl|geos|box2d|ode)_\w+\s+\d[\d.]*\s*(?:us|ms|s)\b/,
];

const isMade = (text: string) => text.startsWith("<!-- Made by `make paper`");

/** This page shows what the program prints, with figures of no account. */
const samples = ["docs/program.md"];

const folders = ["", "docs", "docs/paper", "docs/integrations"];
const pages = folders
  .flatMap((folder) => readdirSync(join(project, folder)).map((name) => join(folder, name)))
  .filter((path) => path.endsWith(".md") && !samples.includes(path));

function secondSources(text: string): string[] {
  if (isMade(text)) return [];
  const own = withoutQuotes(text);
  return figures.flatMap((figure) => {
    const found = figure.exec(own);
    return found ? [`line ${own.slice(0, found.index).split("\n").length}: ${found[0]}`] : [];
  });
}

for (const path of pages) {
  test(`${path} has no figures of a comparison but those of paper/results/comparison.json`, () => {
    assert.deepEqual(secondSources(readFileSync(join(project, path), "utf8")), [],
      "a figure must come from the results: put it into a quote, whose template is in paper/templates/quotes/");
  });
}

test("figures that were typed into a page are found, those of a quote are not", () => {
  assert.deepEqual(secondSources("a\nuniform  boost_rtree 392 us\n"), ["line 2: boost_rtree 392 us"]);
  assert.equal(secondSources("the best of ours is 7 times as fast as the fastest peer").length, 2);
  assert.deepEqual(secondSources("<!-- quote: a -->\nboost_rtree 392 us\n<!-- end of quote -->\n"), []);
});

test("CITATION.cff has the version and the title that there are", () => {
  const text = (path: string) => readFileSync(join(project, path), "utf8");
  const version = /define BROADSIDE_VERSION "([\d.]+)"/.exec(text("include/broadside/version.hpp"))?.[1];
  const title = /^# (.*)$/m.exec(text("docs/paper/paper.md"))?.[1];
  const citation = text("CITATION.cff");
  assert.match(citation, new RegExp(`^version: ${version}$`, "m"));
  assert.ok(citation.includes(`title: "${title}"`), title);
});

const pdf = readFileSync(join(project, "docs/paper/paper.pdf"), "latin1");

test("the PDF is of this text", () => {
  const sum = createHash("sha256").update(readFileSync(join(project, "docs/paper/paper.md"))).digest("hex");
  assert.ok(pdf.includes(`/TextSum (${sum})`), "docs/paper/paper.pdf is of another docs/paper/paper.md; run make paper");
});

test("the PDF has at most 20 pages", () => {
  const count = pdf.match(/\/Type \/Page\b/g)?.length ?? 0;
  assert.ok(count > 0 && count <= 20, `${count} pages`);
});

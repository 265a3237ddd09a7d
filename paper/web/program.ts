// The program that makes the paper: its arguments, files read and written.
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { basename, dirname, join, relative } from "node:path";

import { documentOf, type Document } from "./document.ts";
import type { Template } from "./fill.ts";
import { listed, Problem } from "./problem.ts";

/** Where texts go. */
export interface Print {
  out: (text: string) => void;
  error: (text: string) => void;
}

const usage = `usage: main.mjs [--check] EXPERIMENTS COMPARISON TEMPLATES FOLDER [PAGE]...
Fills templates from the results of broadside experiment and broadside compare (JSON), and writes
FOLDER/paper.md from TEMPLATES/*.md, FOLDER/NAME.md from TEMPLATES/supplements/NAME.md, FOLDER/figures/*.svg,
and the passages of each PAGE that quote TEMPLATES/quotes/*.md. With --check nothing is written: the exit
status says whether they are what would be.
`;

function read(file: string, what: string): string {
  try {
    return readFileSync(file, "utf8");
  } catch (error) {
    throw new Problem(`${file}: ${(error as Error).message}; expected ${what}`);
  }
}

function namesIn(folder: string, ending: string): string[] {
  try {
    return readdirSync(folder)
      .filter((name) => name.endsWith(ending))
      .sort();
  } catch (error) {
    throw new Problem(`${folder}: ${(error as Error).message}; expected a folder`);
  }
}

function figuresIn(folder: string): string[] {
  const figures = join(folder, "figures");
  return existsSync(figures) ? namesIn(figures, ".svg").map((name) => `figures/${name}`) : [];
}

/** Names what differs between the folder and the document. */
function differences(document: Document, folder: string): string[] {
  const stale = figuresIn(folder).filter((path) => !document.has(path));
  const other = [...document].filter(([path, text]) => {
    try {
      return readFileSync(join(folder, path), "utf8") !== text;
    } catch {
      return true;
    }
  });
  return [...other.map(([path]) => path), ...stale];
}

/** Each file is written beside the old one and renamed, the text last. */
function write(document: Document, folder: string): void {
  const stale = figuresIn(folder).filter((path) => !document.has(path));
  mkdirSync(join(folder, "figures"), { recursive: true });
  for (const [path, text] of document) {
    const file = join(folder, path);
    writeFileSync(join(dirname(file), `.${basename(file)}.new`), text);
  }
  for (const path of [...document.keys()].reverse()) {
    const file = join(folder, path);
    renameSync(join(dirname(file), `.${basename(file)}.new`), file);
  }
  for (const path of stale) rmSync(join(folder, path));
}

/** The templates in a folder, which need not be there, by their names. */
function templatesIn(folder: string): Record<string, Template> {
  if (!existsSync(folder)) return {};
  return Object.fromEntries(
    namesIn(folder, ".md").map((name) => {
      const file = join(folder, name);
      return [name, { file, text: read(file, "a template") }];
    }),
  );
}

function documentFrom(experiments: string, comparison: string, templates: string, folder: string, pages: readonly string[]): Document {
  // What the program drew, and what was drawn by hand.
  const pictures = ["../pictures", "diagrams"].filter((path) => existsSync(join(folder, path)));
  return documentOf({
    templates: Object.values(templatesIn(templates)),
    supplements: templatesIn(join(templates, "supplements")),
    quotes: Object.fromEntries(
      Object.entries(templatesIn(join(templates, "quotes"))).map(([name, template]) => [basename(name, ".md"), template]),
    ),
    quoting: Object.fromEntries(pages.map((page) => [relative(folder, page), read(page, "a page that quotes")])),
    experiments: { file: experiments, text: read(experiments, "results of broadside experiment --json") },
    comparison: { file: comparison, text: read(comparison, "results of broadside compare --json") },
    pictures: pictures.flatMap((path) => namesIn(join(folder, path), ".svg").map((name) => `${path}/${name}`)),
  });
}

/** Returns the exit status: 0 fine, 1 not what would be written, 2 unusable arguments or input. */
export function run(words: readonly string[], print: Print): number {
  const check = words[0] === "--check";
  const [experiments, comparison, templates, folder, ...pages] = check ? words.slice(1) : words;
  if (!experiments || !comparison || !templates || !folder) {
    print.error(usage);
    return 2;
  }
  try {
    const document = documentFrom(experiments, comparison, templates, folder, pages);
    const figures = [...document.keys()].filter((path) => path.endsWith(".svg")).length;
    const different = differences(document, folder);
    if (check && different.length > 0) {
      print.error(`${folder} is not what make paper writes: ${listed(different)}; expected no difference\n`);
      return 1;
    }
    if (!check) write(document, folder);
    print.out(`${join(folder, "paper.md")}: ${figures} figures on its pages, ${different.length} files new or changed\n`);
    return 0;
  } catch (error) {
    if (!(error instanceof Problem)) throw error;
    print.error(`make paper: ${error.message}\n`);
    return 2;
  }
}

// Bundles what is written in TypeScript.
//
//   node build.mjs --page FILE.cpp   the report's page, as a C++ source that holds it
//   node build.mjs --html FILE.html  the same as it is, its document missing
//   node build.mjs --tests [FOLDER]  the tests, for node --test, to *.test.mjs there (standard: build/web/tests)
//   node build.mjs --paper FOLDER    what makes the paper, and its tests, to *.mjs there
import { mkdirSync, readFileSync, readdirSync, renameSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

/** The page in two halves, between which the document goes. */
async function page() {
  const { outputFiles: [script] } = await build({
    entryPoints: [join(here, "report/main.ts")],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2020",
    charset: "utf8",
    legalComments: "none",
    logLevel: "warning",
  });
  const { outputFiles: [style] } = await build({
    entryPoints: [join(here, "report/page.css")], minify: true, write: false, charset: "utf8", logLevel: "warning",
  });
  const licence = "/*! With Apache ECharts and ZRender: Apache-2.0 and BSD-3-Clause. */";
  // A script ends where its text says so, were it in a string.
  const safe = script.text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
  const parts = readFileSync(join(here, "report/page.html"), "utf8")
    .replace("/*STYLE*/", () => style.text.trim())
    .replace("/*SCRIPT*/", () => licence + safe.trim())
    .split("/*DOCUMENT*/");
  if (parts.length !== 2) throw new Error(`report/page.html has ${parts.length - 1} places for the document; expected 1`);
  return parts;
}

/** A text as C++ literals, none longer than compilers must take. */
function literals(text) {
  const most = 30000;
  const bytes = Buffer.from(text, "utf8");
  const lines = [];
  for (let begin = 0; begin < bytes.length;) {
    let end = Math.min(begin + most, bytes.length);
    while (end < bytes.length && (bytes[end] & 0xc0) === 0x80) --end;
    lines.push(`    R"part(${bytes.subarray(begin, end).toString("utf8")})part"sv,`);
    begin = end;
  }
  if (text.includes(")part\"")) throw new Error("the page holds the end of a C++ literal");
  return lines.join("\n");
}

function write(path, text) {
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path + ".new", text);
  renameSync(path + ".new", path);
}

async function build_page(path) {
  const [before, after] = await page();
  write(path, `// Written by web/build.mjs.
#include "lab/report/page_template.hpp"

namespace broadside::lab {
namespace {

// With their lengths: clang counts no further than a million characters in a constant.
using namespace std::string_view_literals;

constexpr std::string_view before[] = {
${literals(before)}
};
constexpr std::string_view after[] = {
${literals(after)}
};

}  // namespace

PageTemplate page_template() { return {before, after}; }

}  // namespace broadside::lab
`);
}

/** Bundles programs for Node, each of its own. */
async function build_programs(entryPoints, outdir) {
  await build({
    entryPoints,
    outdir,
    outExtension: { ".js": ".mjs" },
    entryNames: "[name]",
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    external: ["playwright-core"],
    logLevel: "warning",
  });
}

/** The tests whose names begin so. */
function tests_of(name) {
  const sources = readdirSync(join(here, "tests")).filter((test) => test.startsWith(name) && test.endsWith(".test.ts"));
  return sources.map((test) => join(here, "tests", test));
}

async function build_tests(folder) {
  await build_programs(tests_of(""), folder);
}

async function build_paper(folder) {
  const programs = ["main.ts", "without_samples.ts"].map((name) => join(here, "paper", name));
  await build_programs([...programs, ...tests_of("paper")], folder);
}

const [mode, path] = process.argv.slice(2);
if (mode === "--tests") await build_tests(path ?? join(here, "../build/web/tests"));
else if (mode === "--paper" && path !== undefined) await build_paper(path);
else if (mode === "--page" && path !== undefined) await build_page(path);
else if (mode === "--html" && path !== undefined) write(path, (await page()).join("/*DOCUMENT*/"));
else {
  console.error(`build.mjs: '${process.argv.slice(2).join(" ")}'; expected --page FILE.cpp, --html FILE.html, --paper FOLDER or --tests [FOLDER]`);
  process.exitCode = 2;
}

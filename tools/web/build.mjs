// Bundles the TypeScript of this folder.
//
//   node build.mjs --page FILE.cpp   the report page, embedded in a C++ source file
//   node build.mjs --html FILE.html  the report page itself, without a document
//   node build.mjs --tests [FOLDER]  tests of charts and report, to FOLDER/*.test.mjs (default: build/web/tests)
//   node build.mjs --playground FOLDER [ENGINE]  the playground, with build/playground/engine or ENGINE
//   node build.mjs --playground-tests FOLDER     its tests, and in FOLDER/page the page that they open
import { existsSync, mkdirSync, readFileSync, readdirSync, renameSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

import { buildPlayground } from "./playground/build.mjs";

const here = dirname(fileURLToPath(import.meta.url));

/** The page in two halves; the document goes between them. */
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
  // "</script" would end the script, even inside a string.
  const safe = script.text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
  const parts = readFileSync(join(here, "report/page.html"), "utf8")
    .replace("/*STYLE*/", () => style.text.trim())
    .replace("/*SCRIPT*/", () => licence + safe.trim())
    .split("/*DOCUMENT*/");
  if (parts.length !== 2) throw new Error(`report/page.html has ${parts.length - 1} places for the document; expected 1`);
  return parts;
}

/** A text as C++ string literals, none longer than compilers must accept. */
function literals(text) {
  const maxLength = 30000;
  const bytes = Buffer.from(text, "utf8");
  const lines = [];
  for (let begin = 0; begin < bytes.length;) {
    let end = Math.min(begin + maxLength, bytes.length);
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

async function buildPage(path) {
  const [before, after] = await page();
  write(path, `// Written by tools/web/build.mjs.
#include "lab/report/page.hpp"

namespace broadside::lab {
namespace {

// With explicit lengths: clang counts at most a million characters in a constant.
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

/** Bundles programs for Node, one file each. */
async function buildPrograms(entryPoints, outdir) {
  await build({
    entryPoints,
    outdir,
    outExtension: { ".js": ".mjs" },
    entryNames: "[name]",
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    loader: { ".wasm": "binary" },
    jsx: "automatic",
    jsxImportSource: "preact",
    external: ["playwright-core"],
    logLevel: "warning",
  });
}

/**
 * The playground's tests. Without a built engine, only the tests of the page, with a naive engine
 * in it.
 */
async function buildPlaygroundTests(folder) {
  const tests = testsIn(join(here, "playground/tests"));
  const built = existsSync(join(here, "../../build/playground/engine/observing.wasm"));
  const reason = "skipped: the playground's engine is missing; make playground builds it";
  const needy = built ? [] : tests.filter((path) => readFileSync(path, "utf8").includes("/engine/engine.ts"));
  if (!built) console.log(`${reason}. The page is tested with a naive one.`);
  await buildPrograms(tests.filter((path) => !needy.includes(path)), folder);
  for (const path of needy) {
    write(join(folder, basename(path).replace(".ts", ".mjs")),
      `import { test } from "node:test";\ntest(${JSON.stringify(basename(path))}, { skip: ${JSON.stringify(reason)} }, () => {});\n`);
  }
  await buildPlayground(join(folder, "page"), built ? undefined : join(here, "playground/tests/naive_engine.ts"));
}

/** The tests in a folder. */
function testsIn(folder) {
  return readdirSync(folder).filter((name) => name.endsWith(".test.ts")).map((name) => join(folder, name));
}

const [mode, path, engine] = process.argv.slice(2);
if (mode === "--tests") await buildPrograms(testsIn(join(here, "tests")), path ?? join(here, "../../build/web/tests"));
else if (mode === "--playground" && path !== undefined) await buildPlayground(path, engine);
else if (mode === "--playground-tests" && path !== undefined) await buildPlaygroundTests(path);
else if (mode === "--page" && path !== undefined) await buildPage(path);
else if (mode === "--html" && path !== undefined) write(path, (await page()).join("/*DOCUMENT*/"));
else {
  console.error(`build.mjs: '${process.argv.slice(2).join(" ")}'; expected --page FILE.cpp, --html FILE.html, --playground FOLDER [ENGINE], --playground-tests FOLDER or --tests [FOLDER]`);
  process.exitCode = 2;
}

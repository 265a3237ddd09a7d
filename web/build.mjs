// Bundles what is written in TypeScript.
//
//   node build.mjs --tests    the tests, to build/web/tests/*.test.mjs, for node --test
//   node build.mjs --paper FOLDER    what makes the paper, and its tests, to FOLDER/*.mjs
import { readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

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

function tests_of(name) {
  const sources = readdirSync(join(here, "tests")).filter((test) => test.startsWith(name) && test.endsWith(".test.ts"));
  return sources.map((test) => join(here, "tests", test));
}

async function build_tests() {
  await build_programs(tests_of(""), join(here, "../build/web/tests"));
}

async function build_paper(folder) {
  const programs = ["main.ts", "without_samples.ts"].map((name) => join(here, "paper", name));
  await build_programs([...programs, ...tests_of("paper")], folder);
}

const [mode, path] = process.argv.slice(2);
if (mode === "--tests") await build_tests();
else if (mode === "--paper" && path !== undefined) await build_paper(path);
else {
  console.error(`build.mjs: '${process.argv.slice(2).join(" ")}'; expected --paper FOLDER or --tests`);
  process.exitCode = 2;
}

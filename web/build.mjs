// Bundles what is written in TypeScript.
//
//   node build.mjs --tests    the tests, to build/web/tests/*.test.mjs, for node --test
//   node build.mjs --paper    what makes the paper, to build/web/paper/*.mjs
import { readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

/** Bundles programs for Node, each of its own. */
async function build_programs(entryPoints, outdir) {
  await build({
    entryPoints,
    outdir: join(here, "../build/web", outdir),
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    external: ["playwright-core"],
    logLevel: "warning",
  });
}

async function build_tests() {
  const sources = readdirSync(join(here, "tests")).filter((name) => name.endsWith(".test.ts"));
  await build_programs(sources.map((name) => join(here, "tests", name)), "tests");
}

async function build_paper() {
  await build_programs(["main.ts", "without_samples.ts"].map((name) => join(here, "paper", name)), "paper");
}

await (process.argv.includes("--paper") ? build_paper() : build_tests());

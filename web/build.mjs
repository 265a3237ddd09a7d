// Bundles what is written in TypeScript.
//
//   node build.mjs --tests    the tests, to build/web/tests/*.test.mjs, for node --test
import { readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

async function build_tests() {
  const sources = readdirSync(join(here, "tests")).filter((name) => name.endsWith(".test.ts"));
  await build({
    entryPoints: sources.map((name) => join(here, "tests", name)),
    outdir: join(here, "../build/web/tests"),
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    external: ["playwright-core"],
    logLevel: "warning",
  });
}

await build_tests();

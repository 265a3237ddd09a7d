// Takes the samples out of a comparison's JSON, which are most of it: node without_samples.mjs FROM TO.
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { argv, exit, stderr } from "node:process";

import { Problem } from "./problem.ts";
import { readComparison } from "./results.ts";

const [from, to] = argv.slice(2);
if (!from || !to) {
  stderr.write("usage: without_samples.mjs FROM TO\n");
  exit(2);
}
try {
  // The text is kept otherwise: one measurement a line.
  const text = readFileSync(from, "utf8").replace(/"samples_ms":\[[^\]]*\]/g, '"samples_ms":null');
  readComparison(text, from);
  writeFileSync(`${to}.new`, text);
  renameSync(`${to}.new`, to);
} catch (error) {
  if (!(error instanceof Problem) && (error as NodeJS.ErrnoException).code === undefined) throw error;
  stderr.write(`without_samples: ${(error as Error).message}\n`);
  exit(2);
}

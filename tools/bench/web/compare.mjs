// Compares the npm package with other JavaScript libraries, in Node or in Chromium.
//
//   node compare.mjs [--chromium] [--least N] [--most N] PACKAGE
//
// Times in Node are processor times, which other programs on the machine hardly affect; times in Chromium are
// wall-clock times. Every library's pairs are compared with those of the first one, which is the package.
import { createRequire } from "node:module";
import { cpus } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { parseArgs } from "node:util";

const here = dirname(fileURLToPath(import.meta.url));
const { values, positionals: [folder] } = parseArgs({
  allowPositionals: true,
  options: { chromium: { type: "boolean" }, most: { type: "string", default: "1000000" }, least: { type: "string", default: "1" } },
});
if (folder === undefined) {
  console.error("compare.mjs: no package; expected the folder of one, such as build/wasm/package");
  process.exit(2);
}
const maxCount = Number(values.most);
const minCount = Number(values.least);

async function inNode() {
  const { compareAll } = await import("./measure.mjs");
  const { others, ours } = await import("./libraries.mjs");
  const { rapier2d } = await import("./rapier.mjs");
  const { load } = await import(pathToFileURL(join(resolve(folder), "index.js")).href);
  const clock = () => {
    const { user, system } = process.cpuUsage();
    return (user + system) / 1000;
  };
  const libraries = [...ours(await load()), ...others, rapier2d];
  console.log(`Node ${process.version}, ${cpus()[0].model}, processor time`);
  compareAll({ clock, libraries, minCount, maxCount, say: (text) => console.log(`\n${text}`) });
}

async function inChromium() {
  const require = createRequire(join(here, "../../web/package.json"));
  const { build } = require("esbuild");
  const { chromium } = require("playwright-core");
  const { outputFiles: [script] } = await build({
    stdin: {
      resolveDir: here,
      contents: `import { compareAll } from "./measure.mjs";
        import { others, ours } from "./libraries.mjs";
        import { load } from ${JSON.stringify(join(resolve(folder), "index.js"))};
        const first = performance.now();
        const broadside = await load();
        broadside.pairs(new Float32Array([0, 0, 2, 2, 1, 1, 3, 3]), { filters: {} });
        console.log("from the script's start to the first pairs: " + (performance.now() - first).toFixed(1) + " ms");
        compareAll({ clock: () => performance.now(), libraries: [...ours(broadside), ...others], minCount: ${minCount}, maxCount: ${maxCount},
          say: (text) => console.log("\\n" + text) });
        console.log("done");`,
    },
    bundle: true, format: "esm", write: false, define: { global: "globalThis" }, logLevel: "warning",
  });
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
  const page = await browser.newPage();
  const done = new Promise((fulfil, reject) => {
    page.on("console", (message) => (message.text() === "done" ? fulfil() : console.log(message.text())));
    page.on("pageerror", reject);
  });
  console.log(`Chromium ${browser.version()}, ${cpus()[0].model}, time by the clock`);
  await page.addScriptTag({ type: "module", content: script.text });
  await done;
  await browser.close();
}

await (values.chromium ? inChromium() : inNode());

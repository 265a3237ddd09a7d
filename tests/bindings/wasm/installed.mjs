// The package as others take it: packed, installed in an empty project, built by Vite, opened in Chromium; and its tests in
// the oldest Node that it says it runs in. Takes the network, for Vite and that Node.
//
//   node installed.mjs PACKAGE TESTS    TESTS: the folder that `build.mjs --tests` has made
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, extname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const vite = "8.3.8";
const oldestNode = "18.20.8";

const web = join(dirname(fileURLToPath(import.meta.url)), "../../../tools/web");
const [packageFolder, tests] = process.argv.slice(2);
if (tests === undefined) {
  console.error("installed.mjs: too few arguments; expected PACKAGE TESTS");
  process.exit(2);
}

const work = mkdtempSync(join(tmpdir(), "broadside-"));
const npm = (folder, ...words) =>
  execFileSync("npm", [...words, "--silent", "--no-audit", "--no-fund"], { cwd: folder, encoding: "utf8" }).trim();

function project(name, ...packages) {
  const folder = join(work, name);
  mkdirSync(folder);
  writeFileSync(join(folder, "package.json"), JSON.stringify({ private: true, type: "module" }));
  npm(folder, "install", ...packages);
  return folder;
}

/** A site of static files, as a host serves them. */
async function serve(folder) {
  const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
  const sent = new Map();
  const server = createServer((request, response) => {
    const path = request.url === "/" ? "/index.html" : request.url;
    try {
      const bytes = readFileSync(join(folder, path));
      sent.set(path, gzipSync(bytes, { level: 9 }).length);
      response.writeHead(200, { "content-type": types[extname(path)] ?? "application/octet-stream" }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return { server, sent, address: `http://127.0.0.1:${server.address().port}/` };
}

/** What the page says of itself, once it has. */
async function shownBy(address) {
  const { chromium } = createRequire(`${web}/`)("playwright-core");
  const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
  try {
    const page = await browser.newPage();
    const problems = [];
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("console", (message) => message.type() === "error" && !/favicon/.test(message.location().url) &&
      problems.push(message.text()));
    await page.goto(address);
    await page.waitForFunction(() => document.title !== "", undefined, { timeout: 20_000 }).catch(() => {});
    assert.deepEqual(problems, []);
    return await page.title();
  } finally {
    await browser.close();
  }
}

/** Builds a page by Vite and opens it. Says what a visitor downloads. */
async function built(folder, name, code, expected) {
  writeFileSync(join(folder, "index.html"), '<!doctype html><canvas></canvas><script type="module" src="/main.js"></script>');
  writeFileSync(join(folder, "main.js"), code);
  execFileSync(join(folder, "node_modules/.bin/vite"), ["build", "--logLevel", "warn"], { cwd: folder, stdio: "inherit" });
  const { server, sent, address } = await serve(join(folder, "dist"));
  try {
    assert.equal(await shownBy(address), expected);
  } finally {
    server.close();
  }
  const bytes = [...sent.values()].reduce((sum, size) => sum + size, 0);
  console.log(`Vite ${vite}, ${name}: "${expected}" in Chromium; ${sent.size} files, ${bytes} bytes gzipped`);
}

try {
  const packed = join(work, npm(resolve(packageFolder), "pack", "--pack-destination", work));
  console.log(`npm pack: ${statSync(packed).size} bytes`);
  const site = project("site", packed, `vite@${vite}`);
  await built(site, "load({ dimension: 2 })", `import { load } from "broadside";
    const broadside = await load({ dimension: 2 });
    document.title = [...broadside.pairs([0, 0, 2, 2, 1, 1, 3, 3, 5, 5, 6, 6])].join();`, "0,1");
  await built(site, "load()", `import { load } from "broadside";
    const broadside = await load();
    document.title = broadside.index([0, 0, 0, 1, 1, 1], { dimension: 3 }).overlapping([1, 1, 1, 2, 2, 2]).join();`, "0");
  await built(site, "a separate file", `import { load } from "broadside/external";
    import wasm from "broadside/broadside-2d.wasm?url";
    const broadside = await load({ wasm });
    document.title = [...broadside.pairs([0, 0, 2, 2, 1, 1, 3, 3, 5, 5, 6, 6])].join();`, "0,1");
  const [, tutorial] = readFileSync(join(web, "../../docs/tutorials/javascript.md"), "utf8").match(/`page.js`:\n\n```js\n([^]*?)```/);
  await built(site, "the tutorial's page", `${tutorial}
    setTimeout(() => { document.title = world.pairs().length > 0 ? "drawn" : "no pairs"; }, 500);`, "drawn");
  const node = join(project("node", `node@${oldestNode}`), "node_modules/node/bin/node");
  const files = readdirSync(tests).filter((file) => file.endsWith(".test.mjs")).map((file) => join(resolve(tests), file));
  const report = execFileSync(node, ["--test", ...files], {
    encoding: "utf8", maxBuffer: 2 ** 26,
    env: { ...process.env, BROADSIDE_PACKAGE: resolve(packageFolder), BROADSIDE_WEB: resolve(web) },
  });
  console.log(`Node ${oldestNode}: ${/^# pass (\d+)$/m.exec(report)[1]} tests passed`);
} finally {
  rmSync(work, { recursive: true, force: true });
}

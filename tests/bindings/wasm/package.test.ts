// The package as a visitor gets it: its size, its README's example, in a worker, packed and installed, and bundled.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";
import { Worker } from "node:worker_threads";
import { gzipSync } from "node:zlib";

import { BroadsideError, load } from "broadside";
import { load as loadExternal } from "broadside/external";
import { load as loadPairs } from "broadside/pairs";

/** The folders of the package and of the repository's web/: the Makefile says. */
const packageFolder = process.env["BROADSIDE_PACKAGE"] as string;
const web = process.env["BROADSIDE_WEB"] as string;

const work = mkdtempSync(join(tmpdir(), "broadside-"));
after(() => rmSync(work, { recursive: true, force: true }));

const example = "import { load } from \"broadside\";\n" +
  "const broadside = await load();\n" +
  "console.log([...broadside.pairs([0, 0, 2, 2, 1, 1, 3, 3, 5, 5, 6, 6])].join());\n";

/**
 * A page that needs one dimension loads an entry and the module of that dimension. With these limits, a test fails if
 * they grow.
 */
const limits: readonly (readonly [string, string, number])[] = [
  ["index.js", "broadside-2d.js", 199_000], ["index.js", "broadside-3d.js", 205_000],
  ["pairs.js", "broadside-pairs-2d.js", 166_000], ["pairs.js", "broadside-pairs-3d.js", 170_500],
];

for (const [entry, module, most] of limits) {
  test(`${entry} and ${module} are small enough`, () => {
    const gzipped = (file: string) => gzipSync(readFileSync(join(packageFolder, file)), { level: 9 }).length;
    const size = gzipped(entry) + gzipped(module);
    assert.ok(size <= most, `they have ${size} bytes, gzipped; expected at most ${most}`);
  });
}

test("entries bring the modules that are needed", () => {
  for (const [entry, module] of limits) {
    const text = readFileSync(join(packageFolder, entry), "utf8");
    assert.ok(text.includes(`import("./${module}")`), `${entry} imports ${module} when it is needed`);
    assert.doesNotMatch(text, /\beval\b|new Function/);
    assert.ok(text.length < 40_000, `${entry} has no module inline`);
  }
  assert.ok(readFileSync(join(packageFolder, "external.js")).length < 40_000);
});

test("one dimension alone", async () => {
  const boxes = [0, 0, 0, 2, 2, 2, 1, 1, 1, 3, 3, 3];
  for (const loadOne of [load, loadPairs]) {
    const space = await loadOne({ dimension: 3 });
    assert.deepEqual([...space.pairs(boxes)], [0, 1], "what names no dimension means the one that there is");
    assert.deepEqual([...space.pairs(boxes, { dimension: 3 })], [0, 1]);
    assert.equal(space.world().dimension, 3);
    assert.equal(space.tracker().dimension, 3);
    assert.equal(space.boxes(1).dimension, 3);
    assert.throws(() => space.pairs(boxes, { dimension: 2 }),
      { code: "INVALID_ARGUMENT", message: "dimension is 2; expected 3, the one that was loaded" });
    assert.throws(() => space.world({ dimension: 2 }), { code: "INVALID_ARGUMENT" });
  }
  assert.equal((await load({ dimension: 2 })).index([0, 0, 1, 1]).dimension, 2);
});

/** The README's examples, one after the other, as a program. */
function examplesOf(readme: string): string {
  const blocks = [...readme.matchAll(/```js\n([\s\S]*?)```/g)].map(([, code]) => code as string);
  assert.ok(blocks.length > 0);
  return blocks.join("\n");
}

test("the README's examples run", async () => {
  const folder = join(work, "readme");
  install(folder);
  writeFileSync(join(folder, "readme.mjs"), examplesOf(readFileSync(join(packageFolder, "README.md"), "utf8")));
  const printed = execFileSync(process.execPath, ["readme.mjs"], { cwd: folder, encoding: "utf8" });
  assert.match(printed, /boxes 0 and 1 overlap/);
});

test("the tutorial prints what its page shows", () => {
  const page = readFileSync(join(web, "../../docs/tutorials/javascript.md"), "utf8");
  const [, code, shown] = page.match(/```js\n([\s\S]*?)```[\s\S]*?\n```\n(frame [\s\S]*?)```/) as string[];
  const folder = join(work, "tutorial");
  install(folder);
  writeFileSync(join(folder, "drift.mjs"), code as string);
  assert.equal(execFileSync(process.execPath, ["drift.mjs"], { cwd: folder, encoding: "utf8" }), shown);
});

let packed: string | undefined;

/** Installs the packed package in an empty project. */
function install(folder: string): void {
  packed ??= join(work, execFileSync("npm", ["pack", "--silent", "--pack-destination", work],
    { cwd: packageFolder, encoding: "utf8" }).trim());
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "package.json"), JSON.stringify({ type: "module" }));
  execFileSync("npm", ["install", "--silent", "--offline", "--no-audit", "--no-fund", packed], { cwd: folder });
}

test("packed, installed in an empty project, and bundled", async () => {
  const folder = join(work, "project");
  install(folder);
  writeFileSync(join(folder, "main.mjs"), example);
  const run = (file: string) => execFileSync(process.execPath, [file], { cwd: folder, encoding: "utf8" });
  assert.equal(run("main.mjs"), "0,1\n");
  assert.deepEqual(readdirSync(join(folder, "node_modules")).filter((name) => !name.startsWith(".")), ["broadside"]);

  const { build } = createRequire(join(web, "package.json"))("esbuild");
  await build({
    entryPoints: [join(folder, "main.mjs")], outdir: join(folder, "bundle"), outExtension: { ".js": ".mjs" },
    bundle: true, format: "esm", splitting: true, logLevel: "warning",
  });
  assert.equal(run("bundle/main.mjs"), "0,1\n");
});

test("its types are those of a strict project", () => {
  const folder = join(work, "types");
  install(folder);
  writeFileSync(join(folder, "main.ts"), `import { load, BroadsideError, type Handle } from "broadside";
import { load as loadPairs } from "broadside/pairs";
import { load as loadExternal } from "broadside/external";
const broadside = await load();
const pairs = broadside.pairs(new Float32Array(4), { dimension: 2, algorithm: "grid:cell=2" });
const handle: Handle | undefined = broadside.world().add([0, 0, 1, 1])[0];
{ using tracker = broadside.tracker(); tracker.update(pairs); }
// @ts-expect-error: this module has no queries
(await loadPairs()).index([]);
// @ts-expect-error: the bytes are missing
await loadExternal();
// @ts-expect-error: no such option
broadside.pairs(pairs, { dimensions: 3 });
// @ts-expect-error: no such option
broadside.world({ margn: 2 });
const plain: Uint32Array = pairs;
new Blob([pairs, broadside.boxes(1).data, broadside.index(pairs).nearest([0, 0], 1).distances]);
if (handle === undefined) throw new BroadsideError();
`.replace("throw new BroadsideError()", "throw new Error(BroadsideError.name)"));
  writeFileSync(join(folder, "readme.ts"), examplesOf(readFileSync(join(packageFolder, "README.md"), "utf8")));
  const tsc = join(web, "node_modules/typescript/bin/tsc");
  for (const resolution of [["--module", "nodenext"], ["--module", "esnext", "--moduleResolution", "bundler"]]) {
    execFileSync(process.execPath, [tsc, "--noEmit", "--strict", "--exactOptionalPropertyTypes",
      "--noUncheckedIndexedAccess", "--target", "es2022", "--lib", "es2022,dom,esnext.disposable", ...resolution, "main.ts",
      "readme.ts"], { cwd: folder, stdio: "inherit" });
  }
});

test("in a worker", async () => {
  const code = `import { load } from ${JSON.stringify(pathToFileURL(join(packageFolder, "index.js")).href)};
    import { parentPort } from "node:worker_threads";
    const broadside = await load();
    parentPort.postMessage(broadside.pairs([0, 0, 2, 2, 1, 1, 3, 3]).slice());`;
  const worker = new Worker(new URL(`data:text/javascript,${encodeURIComponent(code)}`));
  const pairs = await new Promise((resolve, reject) => worker.once("message", resolve).once("error", reject));
  assert.deepEqual(pairs, Uint32Array.of(0, 1));
  await worker.terminate();
});

test("modules that the caller brings", async () => {
  const path = join(packageFolder, "broadside-2d.wasm");
  const bytes = readFileSync(path);
  const response = () => new Response(bytes, { headers: { "content-type": "application/wasm" } });
  const wasms = [bytes, new Uint8Array(bytes).buffer, await WebAssembly.compile(bytes), response(),
    Promise.resolve(response()), `data:application/wasm;base64,${bytes.toString("base64")}`];
  for (const wasm of wasms) {
    const broadside = await loadExternal({ wasm });
    assert.deepEqual([...broadside.pairs([0, 0, 2, 2, 1, 1, 3, 3])], [0, 1]);
  }
  const flat = await loadExternal({ wasm: bytes });
  assert.throws(() => flat.world({ dimension: 3 }), { code: "INVALID_ARGUMENT" });
  const both = await loadExternal({ wasm: [readFileSync(join(packageFolder, "broadside-3d.wasm")), bytes] });
  assert.deepEqual([both.world().dimension, both.world({ dimension: 3 }).dimension], [2, 3]);
  await assert.rejects(loadExternal({ wasm: [bytes, bytes] }),
    { message: "the number of modules of 2D is 2; expected 1" });
  await assert.rejects(loadExternal({ wasm: [] }), { message: "the number of modules is 0; expected 1 for each dimension" });
  await assert.rejects(loadExternal({ wasm: new Response("", { status: 404 }) }),
    { message: /^the status of the response is 404; expected 200, from the address of a file of the package/ });
  await assert.rejects(loadExternal({ wasm: "nope.wasm" }), { code: "FAILED", message: /^nope.wasm could not be fetched/ });
});

test("a host that lacks something is told what", async () => {
  const version9 = Uint8Array.of(0, 0x61, 0x73, 0x6d, 9, 0, 0, 0);
  const needed = "expected Chrome 95, Firefox 113, Safari 16.4, Node 18 or newer";
  await assert.rejects(loadExternal({ wasm: version9 }),
    ({ message }) => message.startsWith("this host does not compile a module with SIMD and exceptions (") && message.endsWith(needed));
  const { DecompressionStream: kept } = globalThis;
  Reflect.deleteProperty(globalThis, "DecompressionStream");
  try {
    await assert.rejects(load(), { code: "FAILED", message: `this host has no DecompressionStream; ${needed}` });
  } finally {
    globalThis.DecompressionStream = kept;
  }
});

test("an error of one entry is one of the others", async () => {
  const pairs = await loadPairs();
  assert.throws(() => pairs.pairs([0]), (error) => error instanceof BroadsideError);
  assert.equal(BroadsideError.name, "BroadsideError");
  assert.ok(!((new Error("another") as unknown) instanceof BroadsideError));
  class Derived extends BroadsideError {}
  assert.ok(new Derived() instanceof Derived && new Derived() instanceof BroadsideError);
  assert.ok(!((new BroadsideError() as unknown) instanceof Derived), "a derived class is as any other");
});

test("modules are apart from each other", async () => {
  const [one, other] = [await load(), await load()];
  const pairs = one.pairs([0, 0, 2, 2, 1, 1, 3, 3], { filters: {} });
  other.pairs([5, 5, 6, 6, 5, 5, 6, 6, 5, 5, 6, 6], { filters: {} });
  assert.deepEqual([...pairs], [0, 1]);
});

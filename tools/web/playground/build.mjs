// Bundles the playground into one self-contained page, which opens from a folder as well as from a
// server.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

/** For an engine without modules. */
const nothing = gzipSync("").toString("base64");

const licences = "/*! With Preact, signals, twgl.js and gifenc, all under the MIT licence. */";

/** Tests replace the library's engine by a naive one. */
function withEngine(path) {
  return {
    name: "engine",
    setup: ({ onResolve }) => onResolve({ filter: /\/engine\/engine\.ts$/ }, () => ({ path })),
  };
}

const modules = join(here, "../../../build/playground/engine");

/** An engine module, compressed for bench/serve.ts. */
function packed(name) {
  return gzipSync(readFileSync(join(modules, name)), { level: 9 }).toString("base64");
}

async function script(entry, engine) {
  const { outputFiles: [file] } = await build({
    entryPoints: [join(here, entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    charset: "utf8",
    legalComments: "none",
    jsx: "automatic",
    jsxImportSource: "preact",
    // The page embeds them as compressed text.
    loader: { ".wasm": "empty" },
    plugins: engine === undefined ? [] : [withEngine(engine)],
    logLevel: "warning",
  });
  // "</script" would end the script, even inside a string.
  return file.text.trim().replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
}

function hash(text) {
  return `'sha256-${createHash("sha256").update(text, "utf8").digest("base64")}'`;
}

/** Writes index.html to a folder. `engine` is a module that replaces the library's. */
export async function buildPlayground(folder, engine) {
  const body = await script("bench/main.ts", engine);
  // A function, so that the page can pass its text to a worker or, without a worker, call it.
  const bench = `function broadsideBench(self){${body}}`;
  const page = licences + await script("main.tsx", engine);
  const { outputFiles: [css] } = await build({
    entryPoints: [join(here, "style/page.css")], bundle: true, minify: true, write: false, charset: "utf8", logLevel: "warning",
  });
  const style = css.text.trim();
  const policy = [
    "default-src 'none'",
    `script-src ${hash(bench)} ${hash(page)} 'wasm-unsafe-eval'`,
    `style-src ${hash(style)}`,
    "worker-src blob:", "img-src data: blob:", "media-src blob:", "base-uri 'none'", "form-action 'none'",
  ].join("; ");
  const html = readFileSync(join(here, "index.html"), "utf8")
    .replace("/*POLICY*/", () => policy)
    .replace("/*STYLE*/", () => style)
    .replace("/*ENGINE*/", () => engine === undefined ? packed("engine.wasm") : nothing)
    .replace("/*OBSERVING*/", () => engine === undefined ? packed("observing.wasm") : nothing)
    .replace("/*BENCH*/", () => bench)
    .replace("/*PAGE*/", () => page);
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "index.html"), html);
  return html.length;
}

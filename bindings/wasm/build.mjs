// Makes the npm package of the modules that CMake has built.
//
//   node build.mjs MODULES PACKAGE           MODULES/2d and so on are CMake's build folders; to PACKAGE
//   node build.mjs --tests FOLDER PACKAGE    the tests of a PACKAGE, to FOLDER/*.test.mjs
import {
  cpSync, mkdirSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync,
} from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../..");
const { build } = createRequire(join(root, "tools/web/package.json"))("esbuild");

/** The library's version, which stands in one place. */
function version() {
  const header = readFileSync(join(root, "include/broadside/version.hpp"), "utf8");
  return /define BROADSIDE_VERSION "([^"]+)"/.exec(header)[1];
}

/** The modules by the names of their files in the package. */
function readModules(folder) {
  const modules = new Map();
  for (const [name, target] of [["broadside", "broadside_wasm"], ["broadside-pairs", "broadside_wasm_pairs"]]) {
    for (const dimension of ["2d", "3d"])
      modules.set(`${name}-${dimension}`, readFileSync(join(folder, dimension, "bindings/wasm", `${target}.wasm`)));
  }
  return modules;
}

/** A module as src/inline.ts reads it. Base64 of what is compressed is a hundredth larger when it is compressed again. */
function script(bytes) {
  return `export default "${gzipSync(bytes, { level: 9 }).toString("base64")}";\n`;
}

/** Leaves `module:NAME` to be imported from NAME.js when it is needed. */
const modulesApart = {
  name: "modules",
  setup({ onResolve }) {
    onResolve({ filter: /^module:/ }, ({ path }) => ({ path: `./${path.slice("module:".length)}.js`, external: true }));
  },
};

/** A file of the package for each entry, and one for each module. */
async function bundle(modules, folder) {
  await build({
    entryPoints: {
      index: join(here, "src/index.ts"),
      pairs: join(here, "src/pairs_entry.ts"),
      external: join(here, "src/external.ts"),
    },
    outdir: folder,
    bundle: true,
    minify: true,
    lineLimit: 200, // Node prints the line that throws before the error
    format: "esm",
    target: "es2022",
    charset: "utf8",
    logLevel: "warning",
    plugins: [modulesApart],
  });
  for (const [name, bytes] of modules) writeFileSync(join(folder, `${name}.js`), script(bytes));
}

const entry = (name) => ({ types: `./${name}.d.ts`, default: `./${name}.js` });

function manifest(modules) {
  return {
    name: "broadside",
    version: version(),
    description: "Every pair of overlapping boxes, in 2D and 3D, in one call or frame after frame: WebAssembly",
    keywords: ["collision", "broad-phase", "aabb", "bounding-box", "overlap", "spatial-index", "wasm", "simd"],
    license: "MIT",
    type: "module",
    sideEffects: false,
    engines: { node: ">=18" },
    main: "./index.js",
    types: "./index.d.ts",
    exports: {
      ".": entry("index"),
      "./pairs": entry("pairs"),
      "./external": entry("external"),
      ...Object.fromEntries([...modules.keys()].map((name) => [`./${name}.wasm`, `./${name}.wasm`])),
      "./package.json": "./package.json",
    },
  };
}

async function makePackage(modulesFolder, packageFolder) {
  const modules = readModules(modulesFolder);
  rmSync(packageFolder, { recursive: true, force: true });
  mkdirSync(packageFolder, { recursive: true });
  await bundle(modules, packageFolder);
  for (const [name, bytes] of modules) writeFileSync(join(packageFolder, `${name}.wasm`), bytes);
  cpSync(join(here, "types"), packageFolder, { recursive: true });
  cpSync(join(here, "README.md"), join(packageFolder, "README.md"));
  cpSync(join(root, "LICENSE"), join(packageFolder, "LICENSE"));
  writeFileSync(join(packageFolder, "package.json"), `${JSON.stringify(manifest(modules), null, 2)}\n`);
  for (const file of readdirSync(packageFolder).filter((name) => /\.(js|wasm)$/.test(name)).sort()) {
    const bytes = readFileSync(join(packageFolder, file));
    console.log(`${file}: ${bytes.length} bytes, ${gzipSync(bytes, { level: 9 }).length} gzipped`);
  }
}

/** Bundles the tests, and puts the package beside them, where Node looks for it. */
async function makeTests(folder, packageFolder) {
  const sources = join(root, "tests/bindings/wasm");
  rmSync(folder, { recursive: true, force: true });
  await build({
    entryPoints: readdirSync(sources).filter((name) => name.endsWith(".test.ts")).map((name) => join(sources, name)),
    outdir: folder,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: "node18",
    external: ["broadside", "broadside/*"],
    logLevel: "warning",
  });
  mkdirSync(join(folder, "node_modules"));
  symlinkSync(resolve(packageFolder), join(folder, "node_modules/broadside"));
}

const paths = process.argv.slice(2);
if (paths.length === 3 && paths[0] === "--tests") await makeTests(paths[1], paths[2]);
else if (paths.length === 2) await makePackage(...paths);
else {
  console.error(`build.mjs: '${paths.join(" ")}'; expected MODULES PACKAGE, or --tests FOLDER PACKAGE`);
  process.exitCode = 2;
}

// Films the playground for the README.
//
// Usage: node tools/docs/film.mjs PAGE FILE.gif
//
// Needs Chromium, ffmpeg and tools/web/node_modules. The page shows the same boxes for the same link, so
// a frame of the film is a link: the time, the box that is dragged, and the algorithm.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const [page_path, film_path] = process.argv.slice(2);
if (film_path === undefined) {
  console.error("film.mjs: expected the playground's page and a file for the film");
  process.exit(2);
}

const per_second = 8;
/** Seconds until the box is taken, let go, and until the other algorithms begin. */
const [taken, let_go, quadtree, end] = [1, 4, 4.5, 6.5];

/** The box that is dragged: its number, and its middle and sides when it is taken. */
let box;

/** How far it has been dragged: along a loop, from rest to rest. */
function way(time) {
  const part = Math.min(1, (time - taken) / (let_go - taken));
  const angle = 2 * Math.PI * part * part * (3 - 2 * part);
  return [50 * Math.sin(angle), 26 * Math.sin(2 * angle)];
}

function link(time) {
  const parts = [`t=${time}`, "paused=1", "n=130", `a=${time < quadtree ? "grid:cell=10" : "quadtree:capacity=12"}`];
  if (time > taken) {
    const [x, y] = way(time);
    parts.push(`edits=${[box.at, taken, box.x + x, box.y + y, box.width, box.height, 0, 0].join("_")}`);
    if (time < let_go) parts.push(`box=${box.at}`);
  }
  return parts.join("&");
}

const web = fileURLToPath(new URL("../web/", import.meta.url));
const { chromium } = createRequire(web)("playwright-core");
const folder = mkdtempSync(join(tmpdir(), "broadside-film-"));
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
try {
  const page = await browser.newPage({ viewport: { width: 1060, height: 720 }, colorScheme: "light" });
  await page.goto(`file://${resolve(page_path)}#${link(0)}`);
  const show = async (time) => {
    // The browser's own event comes later, when the page may have written its address anew.
    await page.evaluate((hash) => {
      location.hash = hash;
      window.dispatchEvent(new HashChangeEvent("hashchange"));
    }, link(time));
    await page.waitForFunction((at) => {
      const { shown, busy } = window.playground ?? { busy: true };
      return !busy && Math.abs(shown.time - at) < 1e-3;
    }, time);
    // The counts are written and the picture is painted in the frames after that.
    await page.waitForTimeout(150);
  };
  await show(taken);
  box = await page.locator(".drag-hint").evaluate(({ dataset }) => {
    const at = Number(dataset.box);
    const [left, top, right, bottom] = window.playground.shown.boxes.slice(4 * at, 4 * at + 4);
    return { at, x: (left + right) / 2, y: (top + bottom) / 2, width: right - left, height: bottom - top };
  });
  for (let frame = 0; frame < end * per_second; ++frame) {
    await show(frame / per_second);
    await page.locator(".panels").screenshot({ path: join(folder, `${frame}.png`) });
  }
  // One palette for the whole film and no dithering, so that what rests costs nothing.
  execFileSync("ffmpeg", ["-v", "error", "-y", "-framerate", String(per_second), "-i", join(folder, "%d.png"), "-vf",
    "scale=600:-1:flags=area,split[a][b];[a]palettegen=max_colors=32[p];[b][p]paletteuse=dither=none:diff_mode=rectangle", film_path]);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}

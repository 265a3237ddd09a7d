// Prints the cost of the built page in headless Chromium, as the table of README.md:
//
//   node tools/web/playground/frame_times.mjs [PAGE]    PAGE: default build/playground/index.html
//
// The script's time is that of the page's own thread; searches run in a worker. Drawing is the
// processor time of the browser's drawing process, because software does the drawing here. Other
// programs on the machine affect these two little, but they affect frames per second much. The
// script's time and, as ratios, the drawing times therefore carry over to other machines.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { cpus } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const web = join(dirname(fileURLToPath(import.meta.url)), "..");
const { chromium } = createRequire(`${web}/`)("playwright-core");
const file = resolve(process.argv[2] ?? join(web, "../../build/playground/index.html"));
if (!existsSync(file)) {
  console.error(`frame_times.mjs: no file '${file}'; expected the page that \`make playground\` builds`);
  process.exit(2);
}

const runs = 5;
const scenes = [
  { name: "as it opens", hash: "", frames: 30 },
  { name: "5,000 moving, grid", hash: "n=5000&moving=1&a=grid", frames: 30 },
  { name: "5,000 moving, quadtree", hash: "n=5000&moving=1&a=quadtree", frames: 30 },
  { name: "5,000 moving, bvh", hash: "n=5000&moving=1&a=bvh", frames: 30 },
  { name: "100,000 moving, grid", hash: "n=100000&moving=1&a=grid", frames: 30 },
  { name: "100,000 moving, bvh", hash: "n=100000&moving=1&a=bvh", frames: 30 },
  { name: "100,000 moving in 3D, grid", hash: "scene=drift3&n=100000&moving=1&a=grid", frames: 30 },
];

const middle = (numbers) => numbers.sort((a, b) => a - b)[numbers.length >> 1];

async function opened(browser, hash) {
  const page = await browser.newPage({ viewport: { width: 1100, height: 700 } });
  await page.goto(`file://${file}#${hash}`);
  await page.waitForFunction(() => window.playground?.frames > 0 && window.playground.firstFrame > 0, undefined,
    { polling: 20, timeout: 60_000 });
  return page;
}

/**
 * Milliseconds from pointer moves that drag a box to the page's answer: the median and the 90th
 * percentile.
 */
async function dragDelays(browser) {
  const page = await opened(browser, "n=100000&moving=1&a=grid");
  await page.evaluate(() => {
    window.delays = [];
    addEventListener("pointermove", ({ timeStamp }) => window.delays.push(performance.now() - timeStamp), true);
  });
  const [x, y] = await page.evaluate(() => window.playground.where(0));
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 0; step < 20; ++step) await page.mouse.move(x + 2 * step, y + step);
  await page.mouse.up();
  const delays = (await page.evaluate(() => window.delays)).sort((a, b) => a - b);
  await page.close();
  return [delays[delays.length >> 1], delays[Math.floor(0.9 * delays.length)]];
}

/**
 * Milliseconds from the page's start to its first frame with boxes and pairs; by then the module is
 * ready, too.
 */
async function firstFrame(browser) {
  const times = [];
  for (let run = 0; run < runs; ++run) {
    const page = await opened(browser, "");
    times.push(await page.evaluate(() => window.playground.firstFrame));
    await page.close();
  }
  return middle(times);
}

/** Milliseconds of processor time of the drawing process. */
async function drawingTime(browser) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  return 1000 * processInfo.find(({ type }) => type === "GPU").cpuTime;
}

async function measure(browser, { hash, frames }) {
  const page = await opened(browser, hash);
  const drawnBefore = await drawingTime(browser);
  const begin = await page.evaluate(() => {
    window.playground.scriptTimes.length = 0;
    return [window.playground.frames, performance.now()];
  });
  await page.waitForFunction((min) => window.playground.frames >= min, begin[0] + frames,
    { polling: 50, timeout: 120_000 });
  const seen = await page.evaluate(() => ({
    script: [...window.playground.scriptTimes], search: window.playground.shown.panels[0].milliseconds,
    frames: window.playground.frames, now: performance.now(),
  }));
  const drawing = (await drawingTime(browser) - drawnBefore) / (seen.frames - begin[0]);
  await page.close();
  const script = seen.script.sort((a, b) => a - b);
  return {
    middle: script[script.length >> 1], p90: script[Math.floor(0.9 * script.length)], search: seen.search, drawing,
    perSecond: (seen.frames - begin[0]) / (seen.now - begin[1]) * 1000,
  };
}

const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
console.log(`Chromium ${browser.version()}, headless, drawn by software; ${cpus()[0].model}, ${cpus().length} cores\n`);
console.log(`First frame with boxes and pairs, from the page's start: ${(await firstFrame(browser)).toFixed(0)} ms ` +
  `(median of ${runs})\n`);
console.log("| scene | script a frame, median | nine in ten up to | search | drawing, processor time | frames a second |");
console.log("|---|---:|---:|---:|---:|---:|");
for (const scene of scenes) {
  const { middle: median, p90, search, drawing, perSecond } = await measure(browser, scene);
  console.log(`| ${scene.name} | ${median.toFixed(1)} ms | ${p90.toFixed(1)} ms | ${search.toFixed(2)} ms | ` +
    `${drawing.toFixed(0)} ms | ${perSecond.toFixed(1)} |`);
}
const [delay, delay90] = await dragDelays(browser);
console.log(`\nA drag among 100,000 moving boxes is answered after ${delay.toFixed(0)} ms (median; nine in ten up to ` +
  `${delay90.toFixed(0)} ms).`);
await browser.close();

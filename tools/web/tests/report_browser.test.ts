// The report in a real browser, as a reader sees it. Needs Chromium and, in BROADSIDE_PROGRAM, the
// program that writes the pages; without either, these tests are skipped.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import type { Browser, Page } from "playwright-core";

import { comparison, doubtful } from "./fixture.ts";

const program = process.env["BROADSIDE_PROGRAM"] ?? "";
const web = process.env["BROADSIDE_WEB"] ?? "";
const chromiumPath = process.env["CHROMIUM"] ?? "/usr/bin/chromium";
const missing = !existsSync(chromiumPath) ? `chromium is missing at ${chromiumPath}`
  : !existsSync(program) ? "BROADSIDE_PROGRAM names no program" : "";
if (missing !== "") console.log(`skipped: ${missing}`);

/** Things that a page must not do. */
interface Watched {
  page: Page;
  problems: string[];
}

const drawing = (scene: string, dimension: number): object => ({
  scene, dimension, boxes: 2, of: 10,
  views: (dimension === 2 ? ["xy"] : ["xy", "xz", "yz"]).map((axes) => ({
    axes, width: 1000, height: 500, boxes: "M10 10h50v50h-50zM40 40h50v50h-50z",
    layers: [{ algorithm: "grid", caption: "2 x 1 cells", levels: ["M500 0v500"] },
      { algorithm: "quadtree", caption: "2 levels", levels: ["M0 0h1000v500h-1000z", "M250 0v250"] }],
  })),
});

/** As many measurements and samples as the quick comparison has. */
function quickComparison(): object {
  const [first] = comparison.measurements;
  const measurements = Array.from({ length: 1050 }, (_, i) => ({
    ...first, scene: `scene_${Math.floor(i / 54)}`, dimension: 2 + Math.floor(i / 27) % 2, algorithm: `algorithm_${i % 27}`,
    median_ms: 0.1 + (i % 27) / 7, seeds: Array.from({ length: 100 }, (_, seed) => seed + 1),
    samples_ms: Array.from({ length: 18 }, (_, at) => 0.123456 * (1 + at + i % 27)),
    explanation: "bvh, since 1000 boxes are too few for cells to pay",
  }));
  return { ...comparison, measurements };
}

describe("the report", { skip: missing !== "" && missing }, () => {
  let folder: string;
  let browser: Browser;

  /** The program's page with another document in it. */
  function pageWith(name: string, report: object): string {
    const page = readFileSync(join(folder, "comparison.html"), "utf8");
    const [begin, end] = [page.indexOf(">", page.indexOf('id="document"')) + 1, page.lastIndexOf("</script>\n<script>")];
    const path = join(folder, name);
    writeFileSync(path, page.slice(0, begin) + JSON.stringify(report) + page.slice(end));
    return path;
  }

  async function open(name: string, options: { width?: number; dark?: boolean } = {}): Promise<Watched> {
    const page = await browser.newPage({
      viewport: { width: options.width ?? 1280, height: 900 }, colorScheme: options.dark === true ? "dark" : "light",
    });
    const problems: string[] = [];
    const path = join(folder, name);
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && problems.push(message.text()));
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("request", (request) => {
      if (request.url() !== `file://${path}` && !/^(blob|data):/.test(request.url())) problems.push(`request: ${request.url()}`);
    });
    await page.goto(`file://${path}`);
    await page.waitForSelector("nav a");
    return { page, problems };
  }

  /** Scrolls through the whole page, so that all of it is drawn. */
  async function read({ page }: Watched): Promise<void> {
    const height = await page.evaluate(() => document.documentElement.scrollHeight);
    for (let y = 0; y < height + 900; y += 500) {
      await page.evaluate((to) => window.scrollTo(0, to), y);
      await page.waitForTimeout(20);
    }
    await page.waitForFunction(() =>
      [...document.querySelectorAll(".chart")].every((chart) => chart.clientWidth === 0 || chart.querySelector("svg path") !== null));
  }

  async function texts(page: Page, selector: string): Promise<string[]> {
    return page.locator(selector).allInnerTexts();
  }

  before(async () => {
    folder = mkdtempSync(join(tmpdir(), "broadside-report-"));
    execFileSync(program, ["compare", "--scenes", "uniform,churn", "-n", "100,1000", "--frames", "5", "--dimension", "2",
      "--algorithms", "grid,bvh,brute_force,paper_grid", "--budget", "2", "--report", join(folder, "comparison.html")]);
    pageWith("fixture.html", {
      date: "2026-11-21", comparison, drawings: [drawing("uniform", 2), drawing("clustered", 3)],
    });
    pageWith("doubtful.html", { date: "2026-11-21", comparison: doubtful, drawings: [] });
    pageWith("quick.html", { date: "2026-11-21", comparison: quickComparison(), drawings: [] });
    const playwright = createRequire(`${web}/`)("playwright-core") as typeof import("playwright-core");
    browser = await playwright.chromium.launch({ executablePath: chromiumPath, args: ["--no-sandbox"] });
  }, { timeout: 300_000 });

  after(async () => {
    await browser?.close();
    rmSync(folder, { recursive: true, force: true });
  });

  for (const name of ["comparison.html", "fixture.html"]) {
    for (const dark of [false, true]) {
      for (const width of [1280, 400]) {
        test(`draws every chart, asks no network, says no error: ${name}, ${dark ? "dark" : "light"}, ${width} px`, async () => {
          const opened = await open(name, { dark, width });
          await read(opened);
          const charts = opened.page.locator(".chart:visible");
          assert.ok(await charts.count() >= 1);
          for (const label of await charts.evaluateAll((all) => all.map((chart) => chart.getAttribute("aria-label"))))
            assert.match(label ?? "", /chart|Map/);
          const [wide, window_width] = await opened.page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth] as const);
          assert.ok(wide <= window_width, `the page is ${wide} px wide in a window of ${window_width}`);
          assert.deepEqual(opened.problems, []);
          await opened.page.close();
        });
      }
    }
  }

  test("filters and searches its measurements, and says how many are left", async () => {
    const { page } = await open("fixture.html");
    const rows = "#measurements tbody tr:not(.remark)";
    assert.equal(await page.locator(rows).count(), comparison.measurements.length);
    await page.getByLabel("Outcome").selectOption("skipped");
    assert.equal(await page.locator(rows).count(), 1);
    assert.match(await page.locator("#said").innerText(), /1 of 11 rows/);
    await page.getByLabel("Outcome").selectOption("");
    await page.getByLabel("Kind").selectOption("peer");
    assert.equal(await page.locator(rows).count(), 3);
    await page.locator("#measurements").getByLabel("Search").fill("churn");
    assert.equal(await page.locator(rows).count(), 1);
    await page.close();
  });

  test("shows each remark whole, within the window", async () => {
    for (const width of [1280, 400]) {
      const { page } = await open("fixture.html", { width });
      const remark = page.locator("#measurements .remark p").first();
      await remark.scrollIntoViewIfNeeded();
      const { x, width: wide } = (await remark.boundingBox())!;
      assert.ok(x >= 0 && x + wide <= width, `from ${x}, ${wide} px wide, in a window of ${width}`);
      await page.close();
    }
  });

  test("says at its top that the machine was busy and times unsteady", async () => {
    const { page } = await open("doubtful.html");
    const notice = page.locator("main .intro .notice");
    assert.match(await notice.innerText(), /^Busy machine\. Other programs had the processor for 42 % .*\n+Unsteady times\. 1 of 10 /);
    const { y, height } = (await notice.boundingBox())!;
    assert.ok(y + height < 900, "below the first screen");
    await page.goto(`file://${join(folder, "fixture.html")}`);
    await page.waitForSelector("nav a");
    assert.equal(await page.locator(".notice").count(), 0);
    await page.close();
  });

  test("shows ratios with their intervals, and those of results of the schema before without", async () => {
    const ratios = async (name: string): Promise<string[]> => {
      const { page, problems } = await open(name);
      await page.locator("#cases select").selectOption({ label: "churn, 2D, 1,000 boxes, 25 % moving" });
      const cells = await texts(page, "#cases tbody td:nth-child(3)");
      assert.deepEqual(problems, []);
      await page.close();
      return cells;
    };
    assert.deepEqual(await ratios("fixture.html"), ["1.0", "1.2 (0.92 to 1.6)", "1.8 (1.7 to 1.9)"]);
  });

  test("sorts by a column, by the keyboard alone, and back", async () => {
    const { page } = await open("fixture.html");
    const head = page.locator("#measurements th", { hasText: "median" });
    await head.getByRole("button").focus();
    await page.keyboard.press("Enter");
    assert.equal(await head.getAttribute("aria-sort"), "ascending");
    const medians = await texts(page, "#measurements tbody td:nth-child(7)");
    assert.equal(medians[0], "50 µs");
    assert.equal(medians[medians.length - 1], "–");
    await page.keyboard.press("Enter");
    assert.equal(await head.getAttribute("aria-sort"), "descending");
    assert.equal((await texts(page, "#measurements tbody td:nth-child(7)"))[0], "20 ms");
    await page.close();
  });

  test("shows another case when one is chosen, with its frames where it moves", async () => {
    const { page } = await open("fixture.html");
    assert.equal(await page.locator("#cases figure:visible").count(), 1);
    await page.locator("#cases select").selectOption({ label: "churn, 2D, 1,000 boxes, 25 % moving" });
    await page.locator("#cases").scrollIntoViewIfNeeded();
    assert.equal(await page.locator("#cases figure:visible").count(), 2);
    await page.waitForSelector("#cases figure:nth-child(2) svg path", { state: "attached" });
    assert.match((await texts(page, "#cases caption"))[0] ?? "", /churn/);
    await page.close();
  });

  test("changes its theme", async () => {
    const { page } = await open("fixture.html");
    const background = (): Promise<string> => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    await page.waitForSelector(".chart svg text");
    const ink = (): Promise<string | null> => page.locator(".chart svg text").first().getAttribute("fill");
    const [before, ink_before] = [await background(), await ink()];
    await page.getByRole("button", { name: "Dark theme" }).click();
    assert.notEqual(await background(), before);
    assert.notEqual(await ink(), ink_before);
    await page.getByRole("button", { name: "Light theme" }).click();
    assert.equal(await background(), before);
    await page.close();
  });

  test("shows scenes, layers and projections, and zooms by keys", async () => {
    const { page } = await open("fixture.html");
    const picture = page.locator(".picture");
    assert.equal(await picture.locator(".level").count(), 1);
    await page.getByText("quadtree", { exact: true }).last().click();
    assert.equal(await picture.locator(".level").count(), 2);
    await page.locator("#scenes").getByRole("combobox", { name: "Scene", exact: true }).selectOption({ label: "clustered, 3D" });
    assert.equal(await page.locator("#scenes").getByRole("radio", { name: /^(x|y) and (y|z)$/ }).count(), 3);
    const view_box = (): Promise<string | null> => picture.locator("svg").getAttribute("viewBox");
    assert.equal(await view_box(), "0.00 0.00 1000.00 500.00");
    await picture.focus();
    await page.keyboard.press("+");
    assert.equal(await view_box(), "100.00 50.00 800.00 400.00");
    await page.keyboard.press("ArrowRight");
    assert.notEqual(await view_box(), "100.00 50.00 800.00 400.00");
    await page.keyboard.press("0");
    assert.equal(await view_box(), "0.00 0.00 1000.00 500.00");
    await page.close();
  });

  test("hands out its data as JSON and CSV", async () => {
    const { page, problems } = await open("fixture.html");
    const save = async (name: string): Promise<string> => {
      const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name }).click()]);
      return readFileSync(await download.path(), "utf8");
    };
    assert.deepEqual(JSON.parse(await save("Save as JSON")), comparison);
    const lines = (await save("Save as CSV")).trim().split("\r\n");
    assert.equal(lines.length, comparison.measurements.length + 1);
    assert.match(lines[0] ?? "", /^scene,scene_parameters,.*,ratio_to_fastest_median,ratio_to_fastest_low,/);
    assert.deepEqual(problems, []);
    await page.close();
  });

  test("hands out each chart as an SVG of its own", async () => {
    const watched = await open("fixture.html");
    await read(watched);
    const { page, problems } = watched;
    const buttons = page.locator("figure:visible").getByRole("button", { name: "Save the chart as SVG" });
    assert.ok(await buttons.count() > 2);
    for (const button of await buttons.all()) {
      const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
      assert.match(download.suggestedFilename(), /^[a-z0-9-]+\.svg$/);
      const svg = readFileSync(await download.path(), "utf8");
      assert.match(svg, /^<svg [^>]*xmlns=[^]*<path [^]*<\/svg>\s*$/);
      assert.equal(await page.evaluate((text) => new DOMParser().parseFromString(text, "image/svg+xml").querySelector("parsererror"), svg), null);
    }
    assert.deepEqual(problems, []);
    await page.close();
  });

  test("is reached by the keyboard: past the head, and each thing that acts is named", async () => {
    const { page } = await open("fixture.html");
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement?.textContent), "Skip to the content");
    await page.keyboard.press("Enter");
    assert.equal(await page.evaluate(() => document.activeElement?.id), "main");
    const nameless = await page.locator("button, select, input, [tabindex='0']").evaluateAll((all) => all
      .filter((one) => !(one.textContent?.trim() || one.getAttribute("aria-label") || one.getAttribute("aria-labelledby") ||
        (one as HTMLInputElement).labels?.length))
      .map((one) => one.outerHTML));
    assert.deepEqual(nameless, []);
    assert.equal(await page.locator("main").count(), 1);
    assert.equal(await page.locator("h1").count(), 1);
    await page.close();
  });

  test("prints in light colours, with every chart", async () => {
    const { page, problems } = await open("fixture.html", { dark: true });
    await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    assert.equal(await page.evaluate(() => document.documentElement.dataset["theme"]), "light");
    const empty = await page.locator(".chart:visible").evaluateAll((all) => all.filter((chart) => chart.querySelector("svg path") === null).length);
    assert.equal(empty, 0);
    await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
    assert.equal(await page.evaluate(() => document.documentElement.dataset["theme"]), "dark");
    const pdf = await page.pdf({ preferCSSPageSize: true });
    assert.ok(pdf.length > 10_000);
    const sizes = [...pdf.toString("latin1").matchAll(/\/MediaBox \[0 0 ([\d.]+)/g)].map(([, width]) => Math.round(Number(width)));
    // The wide table alone is on landscape pages.
    assert.ok(sizes.includes(595) && sizes.includes(842), sizes.join());
    // A head with a button in it would not be repeated on later pages.
    await page.emulateMedia({ media: "print" });
    assert.equal(await page.locator("thead button:visible").count(), 0);
    assert.ok(await page.locator("thead .printed:visible").count() > 16);
    await page.emulateMedia({ media: "screen" });
    assert.deepEqual(problems, []);
    await page.close();
  });

  test("of as much as the quick comparison is under 3 MB and opens at once", async (context) => {
    const megabytes = statSync(join(folder, "quick.html")).size / 1e6;
    const { page } = await open("quick.html");
    const opened = await page.evaluate(() => (performance.getEntriesByType("navigation")[0] as PerformanceNavigationTiming).domComplete);
    context.diagnostic(`${megabytes.toFixed(2)} MB, opened in ${Math.round(opened)} ms`);
    assert.ok(megabytes < 3, `${megabytes} MB`);
    // A sanity check, not a speed limit: other tests run at the same time.
    assert.ok(opened < 30_000, `${opened} ms`);
    await page.close();
  });
});

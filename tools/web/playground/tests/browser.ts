// The page in headless Chromium, for tests.
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import type { Browser, Page } from "playwright-core";

import { asText, pairsByDefinition } from "./law.ts";

const chromiumPath = "/usr/bin/chromium";
const web = process.env["BROADSIDE_WEB"] ?? join(process.cwd(), "web");
export const pagePath = process.env["BROADSIDE_PLAYGROUND_PAGE"] ??
  fileURLToPath(new URL("page/index.html", import.meta.url));
/**
 * Whether the page has the library. Otherwise it has a naive engine, which suffices only to test
 * the page itself.
 */
export const hasLibrary = existsSync(pagePath) && /id="engine">[^<]{1000}/.test(readFileSync(pagePath, "utf8"));

export const missing = !existsSync(chromiumPath) ? "skipped: chromium is missing"
  : !existsSync(pagePath) ? `skipped: ${pagePath} is missing` : false;

export interface Opened {
  page: Page;
  /** Errors, warnings and requests. */
  problems: string[];
}

interface Options {
  width?: number;
  height?: number;
  dark?: boolean;
  /** Text before the hash of the page's address. */
  search?: string;
  /** Runs before the page's own scripts. */
  before?: () => void;
}

export async function launch(): Promise<Browser> {
  const playwright = createRequire(`${web}/`)("playwright-core") as typeof import("playwright-core");
  return playwright.chromium.launch({ executablePath: chromiumPath, args: ["--no-sandbox"] });
}

/** Waits for a condition in the page; on a timeout, reports what the page showed. */
export async function until<Argument>(page: Page, what: (argument: Argument) => boolean, argument?: Argument):
    Promise<void> {
  try {
    // Frames come slowly if software draws them.
    await page.waitForFunction(what as (argument: unknown) => boolean, argument, { polling: 50 });
  } catch (error) {
    const address = await page.evaluate(() => `${window.playground?.address()}, frame ${window.playground?.frames}`);
    throw new Error(`waited in vain for ${String(what)} of ${JSON.stringify(argument)} at ${address}`, { cause: error });
  }
}

export async function open(browser: Browser, hash = "", options: Options = {}): Promise<Opened> {
  const page = await browser.newPage({
    viewport: { width: options.width ?? 1100, height: options.height ?? 700 },
    colorScheme: options.dark === true ? "dark" : "light", acceptDownloads: true,
  });
  page.setDefaultTimeout(60_000);
  const problems: string[] = [];
  page.on("console", (message) => {
    // A software renderer warns that it is slow.
    if (["error", "warning"].includes(message.type()) && !/GL Driver Message|software WebGL/i.test(message.text()))
      problems.push(message.text());
  });
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("request", (request) => {
    if (!/^(blob|data):/.test(request.url()) && !request.url().startsWith(`file://${pagePath}`))
      problems.push(`request: ${request.url()}`);
  });
  if (options.before !== undefined) await page.addInitScript(options.before);
  await page.goto(`file://${pagePath}${options.search ?? ""}#${hash}`);
  await until(page, () => window.playground !== undefined &&
    (window.playground.shown !== null || window.playground.state.mode === "steps"), null);
  return { page, problems };
}

/** The results on screen, as plain numbers. */
export interface Seen {
  time: number;
  dimension: number;
  boxes: number[];
  pairs: number[];
  panels: { spec: string; pairs: number; tests: number; error: string | undefined; late: boolean }[];
}

export async function seen(page: Page): Promise<Seen> {
  const text = await page.evaluate(() => {
    const { time, dimension, boxes, pairs, panels } = window.playground.shown!;
    // JSON has no infinity.
    const numbers = Array.from(boxes, (one) => Number.isFinite(one) ? one : one > 0 ? 1e300 : -1e300);
    return JSON.stringify({
      time, dimension, boxes: numbers, pairs: Array.from(pairs),
      panels: panels.map(({ spec, pairs: count, statistics, error, late }) =>
        ({ spec, pairs: count, tests: statistics.tests, error, late })),
    });
  });
  return JSON.parse(text) as Seen;
}

/** What is wrong with the shown pairs; undefined if they match the definition in each panel. */
export function unlawful({ boxes, pairs, dimension, panels }: Seen): string | undefined {
  const expected = pairsByDefinition(boxes, dimension);
  if (asText(pairs).join() !== expected.join()) return `${pairs.length / 2} pairs; expected ${expected.length}`;
  const other = panels.find((panel) => panel.error !== undefined || (!panel.late && panel.pairs !== expected.length));
  return other === undefined ? undefined : `${other.spec}: ${other.error ?? `${other.pairs} pairs; expected ${expected.length}`}`;
}

/** Waits until the results match the state's scene and panels. */
export async function settled(page: Page): Promise<void> {
  const before = await page.evaluate(() => window.playground.frames);
  await until(page, (count) => window.playground.frames > count + 1 || !window.playground.busy, before);
}

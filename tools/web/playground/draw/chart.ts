// Times against numbers of boxes as an SVG, on the page and to save. Both axes are logarithmic.
import type { Measured } from "../bench/protocol.ts";
import { settingsText, type SceneChoice } from "../scene/catalogue.ts";
import { duration, grouped } from "../ui/numbers.ts";
import { dark, light } from "./colours.ts";
import { escaped } from "./svg.ts";

export interface Series {
  name: string;
  /** By ascending number of boxes. */
  points: readonly Measured[];
}

/** What a saved chart says about itself. */
export interface Description {
  title: string;
  caption: string;
}

/** Five colours that colour-blind people can tell apart (after Okabe and Ito); light and dark. */
const inks: readonly (readonly [string, string])[] = [
  ["#0067a8", "#5cb8f5"], ["#c84a00", "#ff9350"], ["#00806a", "#2fc49a"], ["#9c3f87", "#e08fbe"], ["#7a5200", "#f0b43c"],
];
const dashes = ["", "6 3", "2 3", "8 3 2 3", ""];

const margin = { left: 88, right: 36, bottom: 46 };

/** The widest that a letter of the legend is on average, in pixels; and a line's height. */
const letter = 8;
const lineHeight = 20;

function wrapped(text: string, width: number): string[] {
  const lines: string[] = [];
  for (const word of text.split(" ")) {
    const longer = lines.length === 0 ? word : `${lines.at(-1)} ${word}`;
    if (lines.length > 0 && letter * longer.length <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/** Powers of ten in the range; where these are few, also 2 and 5 times each, or the range's ends. */
function ticks([min, max]: readonly [number, number]): number[] {
  const factors = max / min < 1000 ? [1, 2, 5] : [1];
  const found: number[] = [];
  for (let power = Math.floor(Math.log10(min)); power <= Math.log10(max); ++power)
    found.push(...factors.map((factor) => factor * 10 ** power).filter((one) => one >= min * 0.999 && one <= max * 1.001));
  return found.length > 1 ? found : [min, max];
}

export function chartOf(series: readonly Series[], width: number, theme: "light" | "dark", described?: Description): string {
  const { background, text, muted } = theme === "dark" ? dark : light;
  const all = series.flatMap(({ points }) => points);
  const [xs, ys] = [all.map(({ count }) => count), all.map(({ milliseconds }) => milliseconds)];
  const x = [Math.min(...xs), Math.max(...xs)] as const;
  const y = [Math.min(...ys) / 1.3, 1.3 * Math.max(...ys)] as const;
  const parts: string[] = [];
  const write = (at: readonly [number, number], anchor: string, what: string, ink: string): void =>
    void parts.push(`<text x="${at[0].toFixed(1)}" y="${at[1].toFixed(1)}" text-anchor="${anchor}" fill="${ink}">${escaped(what)}</text>`);
  const inkOf = (one: number): string => inks[one % inks.length]![theme === "dark" ? 1 : 0];
  const dashOf = (one: number): string => dashes[one % dashes.length] === "" ? "" : ` stroke-dasharray="${dashes[one % dashes.length]}"`;
  const textWidth = width - 24;
  const title = described === undefined ? [] : wrapped(described.title, textWidth);
  const caption = described === undefined ? [] : wrapped(described.caption, textWidth);
  title.forEach((one, at) => write([12, 20 + lineHeight * at], "start", one, text));
  let [right, line] = [margin.left, 18 + lineHeight * title.length];
  series.forEach(({ name }, one) => {
    const wide = 44 + letter * name.length;
    if (right > margin.left && right + wide > width) [right, line] = [margin.left, line + lineHeight];
    parts.push(`<path d="M${right} ${line - 4}h26" stroke="${inkOf(one)}" stroke-width="2"${dashOf(one)}/>`);
    write([right + 32, line], "start", name, text);
    right += wide;
  });
  const top = line + 16;
  const bottom = top + Math.round(Math.min(400, Math.max(240, 0.36 * width)));
  const height = bottom + margin.bottom + lineHeight * caption.length;
  const along = (value: number, [min, max]: readonly [number, number]): number =>
    max > min ? Math.log(value / min) / Math.log(max / min) : 0.5;
  const left = (count: number): number => margin.left + along(count, x) * (width - margin.left - margin.right);
  const down = (milliseconds: number): number => bottom - along(milliseconds, y) * (bottom - top);
  const grid: string[] = [];
  for (const count of ticks(x)) {
    grid.push(`M${left(count).toFixed(1)} ${top}V${bottom}`);
    write([left(count), bottom + 18], "middle", grouped(count), muted);
  }
  for (const milliseconds of ticks(y)) {
    grid.push(`M${margin.left} ${down(milliseconds).toFixed(1)}H${width - margin.right}`);
    write([margin.left - 8, down(milliseconds) + 4], "end", duration(milliseconds), muted);
  }
  parts.push(`<path d="${grid.join("")}" fill="none" stroke="${muted}" stroke-opacity=".25"/>`);
  write([(margin.left + width - margin.right) / 2, bottom + 38], "middle", "boxes", muted);
  parts.push(`<text transform="translate(16 ${(top + bottom) / 2}) rotate(-90)" text-anchor="middle" fill="${muted}">time of a search</text>`);
  caption.forEach((one, at) => write([12, bottom + margin.bottom + 12 + lineHeight * at], "start", one, muted));
  series.forEach(({ name, points }, one) => {
    const places = points.map(({ count, milliseconds }) => `${left(count).toFixed(1)} ${down(milliseconds).toFixed(1)}`);
    parts.push(`<path d="M${places.join("L")}" fill="none" stroke="${inkOf(one)}" stroke-width="2"${dashOf(one)}/>`);
    points.forEach(({ count, milliseconds, ofFrames }, at) => parts.push(
      `<circle cx="${places[at]!.replace(" ", '" cy="')}" r="3" stroke="${inkOf(one)}" fill="${ofFrames === true ? background : inkOf(one)}">` +
      `<title>${escaped(`${name}: ${grouped(count)} boxes, ${duration(milliseconds)}`)}</title></circle>`));
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" ` +
    `font-family="system-ui, sans-serif" font-size="13"><rect width="100%" height="100%" fill="${background}"/>` +
    `${parts.join("\n")}</svg>\n`;
}

/** The same as a table. */
export function csvOf(series: readonly Series[], scene: SceneChoice): string {
  const about = `${scene.name},${scene.seed},${settingsText(scene)}`;
  return ["algorithm,boxes,milliseconds,measured_in,scene,seed,settings", ...series.flatMap(({ name, points }) =>
    points.map(({ count, milliseconds, ofFrames }) =>
      `${name},${count},${milliseconds},${ofFrames === true ? "frames" : "batches"},${about}`)), ""].join("\n");
}

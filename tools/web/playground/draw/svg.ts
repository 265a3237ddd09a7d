// The picture as SVG, for papers and slides.
import { projectionOf } from "./canvas_painter.ts";
import { fills, levelColour } from "./colours.ts";
import { overlapStrength, testLines, type Painting } from "./painting.ts";

/** A picture of more boxes than this opens in few programs. */
export const maxSvgBoxes = 20_000;

export function escaped(text: string): string {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");
}

const short = (value: number): string => String(Math.round(value * 100) / 100);

/** The panels side by side, each with its caption above. */
export function svgOf(painting: Painting, captions: readonly string[]): string {
  const { boxes, dimension, palette } = painting;
  const stride = 2 * dimension;
  if (boxes.length / stride > maxSvgBoxes)
    throw new Error(`${boxes.length / stride} boxes; an SVG takes up to ${maxSvgBoxes}. Save a PNG instead.`);
  const width = Math.max(...painting.panels.map(({ place }) => place.x + place.width));
  const height = Math.max(...painting.panels.map(({ place }) => place.y + place.height));
  const parts: string[] = [];
  painting.panels.forEach((panel, one) => {
    const project = projectionOf(painting, panel);
    const path = (list: Float32Array, at: number): string => {
      const [x, y, wide, high] = project(list, at).map(short);
      return `M${x} ${y}h${wide}v${high}h-${wide}z`;
    };
    const { x, y } = panel.place;
    parts.push(`<svg x="${short(x)}" y="${short(y)}" width="${short(panel.place.width)}" ` +
      `height="${short(panel.place.height)}"><title>${escaped(captions[one] ?? "")}</title>`);
    (panel.outline?.levels ?? []).forEach((level, depth) => {
      const paths: string[] = [];
      for (let at = 0; at < level.length; at += stride) paths.push(path(level, at));
      parts.push(`<path fill="none" stroke="${levelColour(palette, depth)}" d="${paths.join("")}"/>`);
    });
    const byMark = new Map<number, string[]>();
    const marks = panel.marks ?? painting.marks;
    for (let box = 0; box < boxes.length / stride; ++box) {
      if (boxes[stride * box]! > boxes[stride * box + dimension]!) continue;
      const mark = marks[box] ?? 0;
      byMark.set(mark, [...byMark.get(mark) ?? [], path(boxes, stride * box)]);
    }
    for (const [mark, paths] of [...byMark].sort(([a], [b]) => a - b)) {
      const ink = palette.marks[mark];
      parts.push(`<g fill="${ink}" fill-opacity="${fills[mark]}" stroke="${ink}">` +
        paths.map((d) => `<path d="${d}"/>`).join("") + "</g>");
    }
    const overlaps: string[] = [];
    for (let at = 0; at < painting.overlaps.length; at += stride) overlaps.push(path(painting.overlaps, at));
    parts.push(`<path fill="${palette.overlap}" fill-opacity="${overlapStrength(painting).toFixed(3)}" d="${overlaps.join("")}"/>`);
    if (panel.tests !== undefined) {
      const lines = testLines(painting, panel.tests.box, panel.tests.others);
      const point = (at: number): string => {
        const place = lines.subarray(at, at + dimension);
        return project(Float32Array.from([...place, ...place]), 0).slice(0, 2).map(short).join(" ");
      };
      let d = "";
      for (let at = 0; at < lines.length; at += 6) d += `M${point(at)}L${point(at + 3)}`;
      parts.push(`<path fill="none" stroke="${palette.marks[2]}" d="${d}"/>`);
    }
    parts.push("</svg>",
      `<text x="${short(x + 8)}" y="${short(y - 8)}" fill="${palette.text}">${escaped(captions[one] ?? "")}</text>`);
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${short(width)} ${short(height)}" ` +
    `font-family="sans-serif" font-size="13"><rect width="100%" height="100%" fill="${palette.background}"/>` +
    `${parts.join("\n")}</svg>\n`;
}

// Why boxes were not compared with the selected one.
import type { Outline } from "../engine/types.ts";
import type { Untested } from "./protocol.ts";

const axisNames = ["x", "y", "z"];

function meets(a: Float32Array, at: number, b: Float32Array, bt: number, dimension: number): boolean {
  for (let axis = 0; axis < dimension; ++axis) {
    if (a[at + axis]! > b[bt + dimension + axis]! || b[bt + axis]! > a[at + dimension + axis]!) return false;
  }
  return true;
}

/**
 * The parts of the lowest level in which each box is looked up; all levels for cells of several
 * sizes.
 */
function partsOf(outline: Outline, boxes: Float32Array, box: number, dimension: number): [number, number][] {
  const found: [number, number][] = [];
  const level = outline.levels.length - 1;
  const parts = outline.levels[level];
  if (parts === undefined) return found;
  for (let at = 0; at < parts.length; at += 2 * dimension) {
    if (meets(parts, at, boxes, 2 * dimension * box, dimension)) found.push([level, at]);
  }
  return found;
}

const partNames: Record<string, string> = { cells: "cell", stripes: "stripe", nodes: "node" };

/**
 * Groups of the boxes that were not compared with a given box. The first group is separated by the
 * algorithm's structure. The others are grouped by the axis on which one box ends before the other
 * begins.
 */
export function reasons(boxes: Float32Array, dimension: number, box: number, tested: ReadonlySet<number>,
                        outline: Outline | undefined): Untested[] {
  const stride = 2 * dimension;
  const swept = outline !== undefined && outline.sweptAxis >= 0 ? outline.sweptAxis : -1;
  const part = outline === undefined ? undefined : partNames[outline.kind];
  const mine = outline === undefined || part === undefined ? [] : partsOf(outline, boxes, box, dimension);
  const apart: number[] = Array<number>(dimension).fill(0);
  let elsewhere = 0;
  let sweptApart = 0;
  let other = 0;
  for (let one = 0; one < boxes.length / stride; ++one) {
    if (one === box || tested.has(one) || boxes[stride * one]! > boxes[stride * one + dimension]!) continue;
    const together = part === undefined || mine.some(([level, at]) =>
      meets(outline!.levels[level]!, at, boxes, stride * one, dimension));
    if (!together) {
      ++elsewhere;
      continue;
    }
    const on = (axis: number): boolean =>
      boxes[stride * one + axis]! > boxes[stride * box + dimension + axis]! ||
      boxes[stride * box + axis]! > boxes[stride * one + dimension + axis]!;
    if (swept >= 0 && on(swept)) ++sweptApart;
    else {
      const axis = Array.from(apart.keys()).find(on);
      if (axis === undefined) ++other;
      else ++apart[axis]!;
    }
  }
  const groups: Untested[] = [];
  if (elsewhere > 0) groups.push({ count: elsewhere, why: `share no ${part} with it` });
  if (sweptApart > 0) {
    groups.push({
      count: sweptApart,
      why: `end before it begins, or begin after it ends, on ${axisNames[swept]}, the axis of the sweep`,
    });
  }
  for (const [axis, count] of apart.entries()) {
    if (count > 0) groups.push({ count, why: `are apart from it on ${axisNames[axis]}, and no test was needed` });
  }
  if (other > 0) groups.push({ count: other, why: "overlap it and were found without a test" });
  return groups;
}

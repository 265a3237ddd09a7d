// What the visitor did to the boxes: moved, threw, added and removed some. In 2D.
import { bounce } from "./motion.ts";
import type { Bounds } from "./scene.ts";

/** From a time on, a box goes its own way: from here at this speed, bouncing at the world's borders. */
export interface Edit {
  /** Its place; those from the scene's number on are added. */
  box: number;
  time: number;
  /** Its centre at that time. */
  x: number;
  y: number;
  /** Its sides; negative: it is removed. */
  width: number;
  height: number;
  vx: number;
  vy: number;
}

/** The edits with one more, which replaces later ones of the same box. */
export function withEdit(edits: readonly Edit[], edit: Edit): Edit[] {
  const kept = edits.filter((one) => one.box !== edit.box || one.time < edit.time);
  return [...kept, edit].sort((a, b) => a.time - b.time);
}

/** How many boxes there are with those that edits add. */
export function countWith(count: number, edits: readonly Edit[]): number {
  return edits.reduce((most, edit) => Math.max(most, edit.box + 1), count);
}

/** Writes one box as an edit has it at a time. */
export function place(boxes: Float32Array, edit: Edit, time: number, bounds: Bounds): void {
  const at = 4 * edit.box;
  if (edit.width < 0) {
    boxes.set([Infinity, Infinity, -Infinity, -Infinity], at);
    return;
  }
  const [left, bottom, right, top] = bounds as [number, number, number, number];
  const passed = time - edit.time;
  const [w, h] = [edit.width / 2, edit.height / 2];
  // What was put beyond the borders, or is larger than the world, stays there unless it was thrown.
  const x = edit.vx === 0 ? edit.x : bounce(edit.x, edit.vx, passed, left + w, right - w);
  const y = edit.vy === 0 ? edit.y : bounce(edit.y, edit.vy, passed, bottom + h, top - h);
  boxes.set([x - w, y - h, x + w, y + h], at);
}

/** The scene's boxes with the edits made up to a time; boxes that are added later are absent. */
export function edited(boxes: Float32Array<ArrayBuffer>, edits: readonly Edit[], time: number,
                       bounds: Bounds): Float32Array<ArrayBuffer> {
  if (edits.length === 0) return boxes;
  const count = boxes.length / 4;
  const all = new Float32Array(4 * countWith(count, edits));
  all.set(boxes);
  for (let at = 4 * count; at < all.length; at += 4)
    all.set([Infinity, Infinity, -Infinity, -Infinity], at);
  for (const edit of edits) {
    if (edit.time <= time) place(all, edit, time, bounds);
  }
  return all;
}

// The visitor's edits: boxes moved, thrown, added and removed. In 2D.
import { bounce } from "./motion.ts";
import type { Bounds } from "./scene.ts";

/**
 * From a given time on, a box moves from this place at this speed and bounces off the world's
 * borders.
 */
export interface Edit {
  /** Its index; indices from the scene's count on are added boxes. */
  box: number;
  time: number;
  /** Its centre at that time. */
  x: number;
  y: number;
  /** Its sides; negative: removed. */
  width: number;
  height: number;
  vx: number;
  vy: number;
}

/** The edits with one more, which replaces later edits of the same box. */
export function withEdit(edits: readonly Edit[], edit: Edit): Edit[] {
  const kept = edits.filter((one) => one.box !== edit.box || one.time < edit.time);
  return [...kept, edit].sort((a, b) => a.time - b.time);
}

/** The number of boxes, including added ones. */
export function countWith(count: number, edits: readonly Edit[]): number {
  return edits.reduce((max, edit) => Math.max(max, edit.box + 1), count);
}

/** Writes one edited box at a given time. */
export function place(boxes: Float32Array, edit: Edit, time: number, bounds: Bounds): void {
  const at = 4 * edit.box;
  if (edit.width < 0) {
    boxes.set([Infinity, Infinity, -Infinity, -Infinity], at);
    return;
  }
  const [left, bottom, right, top] = bounds as [number, number, number, number];
  const passed = time - edit.time;
  const [w, h] = [edit.width / 2, edit.height / 2];
  // A box placed beyond the borders, or larger than the world, stays there unless it was thrown.
  const x = edit.vx === 0 ? edit.x : bounce(edit.x, edit.vx, passed, left + w, right - w);
  const y = edit.vy === 0 ? edit.y : bounce(edit.y, edit.vy, passed, bottom + h, top - h);
  boxes.set([x - w, y - h, x + w, y + h], at);
}

/** The scene's boxes with the edits up to a given time; boxes that are added later are absent. */
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

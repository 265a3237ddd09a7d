// Finds the box under the pointer.

/** The smallest box within a given distance of a point in 2D; -1: none. */
export function pickFlat(boxes: Float32Array, x: number, y: number, reach: number): number {
  let best = -1;
  let minSize = Infinity;
  for (let at = 0; at < boxes.length; at += 4) {
    const [left, bottom, right, top] = [boxes[at]!, boxes[at + 1]!, boxes[at + 2]!, boxes[at + 3]!];
    if (x < left - reach || x > right + reach || y < bottom - reach || y > top + reach) continue;
    // Boxes that contain the point take precedence over boxes near it.
    const inside = x >= left && x <= right && y >= bottom && y <= top;
    const size = (right - left) * (top - bottom) + (inside ? 0 : 1e30);
    if (size < minSize) [best, minSize] = [at / 4, size];
  }
  return best;
}

/** The first box that a ray hits; -1: none. */
export function pickSolid(boxes: Float32Array, origin: readonly number[], direction: readonly number[]): number {
  let best = -1;
  let first = Infinity;
  for (let at = 0; at < boxes.length; at += 6) {
    let [enter, leave] = [0, Infinity];
    for (let axis = 0; axis < 3; ++axis) {
      const one = (boxes[at + axis]! - origin[axis]!) / direction[axis]!;
      const other = (boxes[at + 3 + axis]! - origin[axis]!) / direction[axis]!;
      enter = Math.max(enter, Math.min(one, other));
      leave = Math.min(leave, Math.max(one, other));
    }
    if (enter <= leave && enter < first) [best, first] = [at / 6, enter];
  }
  return best;
}

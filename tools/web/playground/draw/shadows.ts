// The boxes' shadows on an axis: the intervals that a sweep along it sees.

export interface Shadow {
  box: number;
  from: number;
  to: number;
  row: number;
}

/**
 * The shadows of flat boxes, by where they begin. Shadows in the same row do not overlap, and there
 * are as few rows as possible: as many as shadows overlap at one place.
 */
export function shadowsOn(boxes: Float32Array, axis: 0 | 1): Shadow[] {
  const present = Array.from({ length: boxes.length / 4 }, (_, box) => box)
    .filter((box) => boxes[4 * box]! <= boxes[4 * box + 2]!)
    .sort((a, b) => boxes[4 * a + axis]! - boxes[4 * b + axis]!);
  const ends: number[] = [];
  return present.map((box) => {
    const [from, to] = [boxes[4 * box + axis]!, boxes[4 * box + 2 + axis]!];
    const free = ends.findIndex((end) => end < from);
    const row = free < 0 ? ends.length : free;
    ends[row] = to;
    return { box, from, to, row };
  });
}

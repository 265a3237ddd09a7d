// A few boxes, large enough to label, for the step player.
import { randomAt } from "./random.ts";

export const stepWorld = { width: 16, height: 10 } as const;

/** Boxes on a grid of quarter units, so that their coordinates are short. */
export function stepBoxes(count: number, seed: number): Float32Array<ArrayBuffer> {
  const quarters = (value: number): number => Math.round(4 * value) / 4;
  const size = Math.min(3, 5.2 / Math.sqrt(count));
  const boxes = new Float32Array(4 * count);
  for (let box = 0; box < count; ++box) {
    const width = Math.max(0.5, quarters(size * (0.5 + 0.9 * randomAt(seed, box, 0))));
    const height = Math.max(0.5, quarters(size * (0.5 + 0.9 * randomAt(seed, box, 1))));
    const x = quarters(randomAt(seed, box, 2) * (stepWorld.width - width));
    const y = quarters(randomAt(seed, box, 3) * (stepWorld.height - height));
    boxes.set([x, y, x + width, y + height], 4 * box);
  }
  return boxes;
}

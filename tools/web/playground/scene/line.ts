// Boxes along a line: a street along x, or a tower along y. The best case for a sweep along the
// right axis.
import { randomAt } from "./random.ts";
import type { Scene } from "./scene.ts";

const [long, wide] = [160, 10];

export function line(along: 0 | 1, count: number, seed: number): Scene {
  const side = Math.max(0.02, 1.1 * long / count);
  // A street has the usual width; a tower is hardly wider than a box, and its boxes are flat storeys.
  const narrow = along === 0 ? wide : 1.5 * side;
  const bounds = along === 0
    ? [0, -long * 0.25, long, narrow + long * 0.25] : [-long * 0.6, 0, long * 0.6, long];
  return {
    dimension: 2, bounds, duration: Infinity,
    at(time) {
      const boxes = new Float32Array(4 * count);
      for (let box = 0; box < count; ++box) {
        const half = side * (0.3 + 0.4 * randomAt(seed, box, 0));
        const way = randomAt(seed, box, 1) * long + 0.6 * side * Math.sin(time * (1 + randomAt(seed, box, 2)) + box);
        const across = narrow * randomAt(seed, box, 3);
        const [x, y] = along === 0 ? [way, across] : [across, way];
        const [w, h] = along === 0 ? [half, 2 * half] : [9 * half, half];
        boxes.set([x - w, y - h, x + w, y + h], 4 * box);
      }
      return boxes;
    },
  };
}

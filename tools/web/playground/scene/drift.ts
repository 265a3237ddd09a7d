// The scene with sliders: boxes that drift and bounce, with adjustable sizes, clustering, moving
// fraction and speed.
import { bounce } from "./motion.ts";
import { normalAt, randomAt } from "./random.ts";
import type { Dimension, Scene } from "./scene.ts";

export interface Knobs {
  /** Size of the largest box over that of the smallest. */
  ratio: number;
  /** 0: evenly spread; 1: tight clusters. */
  clustering: number;
  /** Fraction of boxes that move. */
  moving: number;
  /** As a factor of the usual speed. */
  speed: number;
}

export const defaultKnobs: Knobs = { ratio: 3, clustering: 0, moving: 1, speed: 1 };

const size = [160, 100, 100] as const;
const clusters = 7;

export function drift(dimension: Dimension, count: number, seed: number, knobs: Knobs): Scene {
  const start = new Float64Array(count * dimension);
  const velocity = new Float64Array(count * dimension);
  const half = new Float64Array(count * dimension);
  // Boxes cover about a twelfth of the world, whatever their number.
  const volume = size.slice(0, dimension).reduce((product, side) => product * side, 1);
  const usual = 0.5 * (0.085 * volume / count) ** (1 / dimension);
  for (let box = 0; box < count; ++box) {
    // Only a few are large.
    const scale = knobs.ratio ** (randomAt(seed, box, 0) ** 4) / knobs.ratio ** 0.2;
    const rests = randomAt(seed, box, 1) >= knobs.moving;
    const cluster = Math.floor(randomAt(seed, box, 2) * clusters);
    for (let axis = 0; axis < dimension; ++axis) {
      const at = box * dimension + axis;
      const width = size[axis]!;
      half[at] = Math.min(0.45 * width, usual * scale * (0.6 + 0.8 * randomAt(seed, box, 4 + axis)));
      const even = randomAt(seed, box, 8 + axis) * width;
      const centre = (0.15 + 0.7 * randomAt(seed, clusters + cluster, 40 + axis)) * width;
      const near = centre + normalAt(seed, box, 12 + 2 * axis) * width * 0.22 * (1.02 - knobs.clustering);
      start[at] = knobs.clustering > 0 ? even + (near - even) * Math.sqrt(knobs.clustering) : even;
      velocity[at] = rests ? 0 : 7 * knobs.speed * normalAt(seed, box, 20 + 2 * axis);
    }
  }
  return {
    dimension,
    bounds: [...[0, 0, 0].slice(0, dimension), ...size.slice(0, dimension)],
    duration: Infinity,
    at(time) {
      const boxes = new Float32Array(count * 2 * dimension);
      for (let box = 0, from = 0, to = 0; box < count; ++box, to += 2 * dimension) {
        for (let axis = 0; axis < dimension; ++axis, ++from) {
          const reach = half[from]!;
          const centre =
            bounce(start[from]!, velocity[from]!, time, reach, size[axis]! - reach);
          boxes[to + axis] = centre - reach;
          boxes[to + dimension + axis] = centre + reach;
        }
      }
      return boxes;
    },
  };
}

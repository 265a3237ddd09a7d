// A scene: boxes as a function of time.

export type Dimension = 2 | 3;

/** Minima, then maxima. */
export type Bounds = readonly number[];

export interface Scene {
  dimension: Dimension;
  /** The camera's initial bounds. */
  bounds: Bounds;
  /** Length in seconds; infinite for endless motion. */
  duration: number;
  /** The camera's bounds once the boxes have moved elsewhere; undefined: always `bounds`. */
  boundsAt?(boxes: Float32Array): Bounds;
  /** The boxes at a given time: minima, then maxima of each. The caller owns the array. */
  at(time: number): Float32Array<ArrayBuffer>;
}

export function numbersPerBox(dimension: Dimension): 4 | 6 {
  return dimension === 2 ? 4 : 6;
}

/**
 * The bounds of boxes, without the outermost 1 % at each end, so that one huge box does not shrink
 * the others.
 */
export function usualBounds(boxes: Float32Array, dimension: Dimension): Bounds {
  const stride = 2 * dimension;
  const low: number[] = [];
  const high: number[] = [];
  for (let axis = 0; axis < dimension; ++axis) {
    const minima: number[] = [];
    const maxima: number[] = [];
    for (let at = 0; at < boxes.length; at += stride) {
      const min = boxes[at + axis]!;
      const max = boxes[at + dimension + axis]!;
      if (min > max) continue;
      if (Number.isFinite(min)) minima.push(min);
      if (Number.isFinite(max)) maxima.push(max);
    }
    minima.sort((a, b) => a - b);
    maxima.sort((a, b) => a - b);
    const cut = Math.floor(minima.length / 100);
    low.push(minima[cut] ?? 0);
    high.push(maxima[maxima.length - 1 - cut] ?? 1);
  }
  for (let axis = 0; axis < dimension; ++axis) {
    const margin = 0.03 * (high[axis]! - low[axis]!) || 0.5;
    low[axis]! -= margin;
    high[axis]! += margin;
  }
  return [...low, ...high];
}

/** The mean centre on an axis of boxes that are present and finite. */
function meanCentre(boxes: Float32Array, dimension: Dimension, axis: number): number {
  let [sum, count] = [0, 0];
  for (let at = axis; at < boxes.length; at += 2 * dimension) {
    const centre = (boxes[at]! + boxes[at + dimension]!) / 2;
    if (!Number.isFinite(centre)) continue;
    sum += centre;
    ++count;
  }
  return count === 0 ? 0 : sum / count;
}

/** Bounds that follow boxes which leave them together, and stay while boxes only move about. */
export function followingBounds(bounds: Bounds, first: Float32Array, dimension: Dimension):
    (boxes: Float32Array) => Bounds {
  const start = Array.from({ length: dimension }, (_, axis) => meanCentre(first, dimension, axis));
  return (boxes) => {
    const shifts = start.map((from, axis) => {
      const shift = meanCentre(boxes, dimension, axis) - from;
      const slack = 0.1 * (bounds[dimension + axis]! - bounds[axis]!);
      return Math.sign(shift) * Math.max(0, Math.abs(shift) - slack);
    });
    return bounds.map((one, at) => one + shifts[at % dimension]!);
  };
}

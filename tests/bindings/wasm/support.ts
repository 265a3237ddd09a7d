// Scenes, and what is right about them by definition.
import type { Dimension, Filters } from "broadside";

/** Numbers from 0 to 1 that a seed fixes: mulberry32. */
export function random(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let bits = Math.imul(state ^ (state >>> 15), state | 1);
    bits ^= bits + Math.imul(bits ^ (bits >>> 7), bits | 61);
    return ((bits ^ (bits >>> 14)) >>> 0) / 2 ** 32;
  };
}

export const at = (numbers: ArrayLike<number>, i: number): number => numbers[i] as number;

/** Whether the box at a place is there. */
const present = (boxes: ArrayLike<number>, dimension: Dimension, i: number): boolean =>
  at(boxes, 2 * dimension * i) <= at(boxes, 2 * dimension * i + dimension);

export function overlap(a: ArrayLike<number>, i: number, b: ArrayLike<number>, j: number,
  dimension: Dimension): boolean {
  if (!present(a, dimension, i) || !present(b, dimension, j)) return false;
  const first = 2 * dimension * i;
  const second = 2 * dimension * j;
  for (let axis = 0; axis < dimension; ++axis) {
    if (at(a, first + axis) > at(b, second + dimension + axis)) return false;
    if (at(b, second + axis) > at(a, first + dimension + axis)) return false;
  }
  return true;
}

export function accepts(filters: Filters | undefined, i: number, j: number): boolean {
  if (filters === undefined) return true;
  const { category, mask, group, isStatic } = filters;
  if (isStatic?.[i] && isStatic[j]) return false;
  const its = group?.[i] ?? 0;
  if (its !== 0 && its === group?.[j]) return its > 0;
  const meets = (a: number, b: number) => ((mask?.[a] ?? ~0) & (category?.[b] ?? 1)) !== 0;
  return meets(i, j) && meets(j, i);
}

/** Every pair of overlapping boxes, sorted. */
export function pairsByDefinition(boxes: ArrayLike<number>, dimension: Dimension, filters?: Filters): number[] {
  const count = boxes.length / (2 * dimension);
  const pairs: number[] = [];
  for (let i = 0; i < count; ++i) {
    for (let j = i + 1; j < count; ++j)
      if (overlap(boxes, i, boxes, j, dimension) && accepts(filters, i, j)) pairs.push(i, j);
  }
  return pairs;
}

export function joinByDefinition(left: ArrayLike<number>, right: ArrayLike<number>, dimension: Dimension): number[] {
  const pairs: number[] = [];
  for (let i = 0; i < left.length / (2 * dimension); ++i) {
    for (let j = 0; j < right.length / (2 * dimension); ++j)
      if (overlap(left, i, right, j, dimension)) pairs.push(i, j);
  }
  return pairs;
}

/** Pairs of one list that another does not have; both sorted. */
export function without(pairs: readonly number[], others: readonly number[]): number[] {
  const key = (a: number, b: number) => `${a},${b}`;
  const known = new Set<string>();
  for (let k = 0; k < others.length; k += 2) known.add(key(at(others, k), at(others, k + 1)));
  const rest: number[] = [];
  for (let k = 0; k < pairs.length; k += 2) {
    const a = at(pairs, k);
    const b = at(pairs, k + 1);
    if (!known.has(key(a, b))) rest.push(a, b);
  }
  return rest;
}

export interface Scene {
  readonly name: string;
  readonly boxes: (count: number, dimension: Dimension, seed: number) => Float32Array;
}

function scene(name: string, side: (rng: () => number, axis: number) => number,
  place: (rng: () => number, axis: number, i: number) => number): Scene {
  return {
    name,
    boxes(count, dimension, seed) {
      const rng = random(seed);
      const boxes = new Float32Array(2 * dimension * count);
      for (let i = 0; i < count; ++i) {
        for (let axis = 0; axis < dimension; ++axis) {
          const begin = place(rng, axis, i);
          boxes[2 * dimension * i + axis] = begin;
          boxes[2 * dimension * i + dimension + axis] = begin + side(rng, axis);
        }
      }
      return boxes;
    },
  };
}

export const scenes: readonly Scene[] = [
  scene("uniform", (rng) => 2 * rng(), (rng) => 60 * rng()),
  scene("clustered", (rng) => rng(), (rng) => 100 * rng() ** 6),
  scene("on a line", () => 1, (rng, axis) => (axis === 0 ? 500 * rng() : rng())),
  scene("of many sizes", (rng) => 30 * rng() ** 12, (rng) => 100 * rng()),
  scene("at one point", () => 1, (rng) => rng()),
  scene("touching cells", () => 1, (rng) => Math.floor(20 * rng())),
  scene("points", () => 0, (rng) => Math.floor(6 * rng())),
  scene("far away", (rng) => 2e6 * rng(), (rng) => 1e9 + 6e7 * rng()),
];

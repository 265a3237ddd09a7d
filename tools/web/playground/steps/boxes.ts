// Packed boxes in 2D, with their sides named as in the draft's listings.
import type { World } from "../engine/types.ts";

export interface Box {
  minX: number;
  minY: number;
  maxX: number;
  maxY: number;
}

/** The boxes, absent ones included. Throws if one is neither a box nor absent. */
export function unpack(packed: Float32Array): Box[] {
  if (packed.length % 4 !== 0)
    throw new Error(`${packed.length} numbers of boxes; expected a multiple of 4, in 2D`);
  const boxes: Box[] = [];
  for (let at = 0; at < packed.length; at += 4) {
    const [minX, minY, maxX, maxY] = packed.subarray(at, at + 4) as unknown as [number, number, number, number];
    boxes.push({ minX, minY, maxX, maxY });
  }
  for (const [id, box] of boxes.entries()) {
    if (!isPresent(box) && !isAbsent(box))
      throw new Error(`box ${id} is [${box.minX}, ${box.maxX}] x [${box.minY}, ${box.maxY}]; expected min <= max`);
  }
  return boxes;
}

export function isPresent(box: Box): boolean {
  return box.minX <= box.maxX && box.minY <= box.maxY;
}

function isAbsent(box: Box): boolean {
  return box.minX === Infinity && box.minY === Infinity && box.maxX === -Infinity && box.maxY === -Infinity;
}

/** The indices of the boxes that are present. */
export function presentIds(boxes: readonly Box[]): number[] {
  return [...boxes.keys()].filter((id) => isPresent(boxes[id]!));
}

export function overlap(a: Box, b: Box): boolean {
  return a.minX <= b.maxX && b.minX <= a.maxX && a.minY <= b.maxY && b.minY <= a.maxY;
}

/**
 * The reference point of a pair: the minimum corner of the intersection. Of several cells or
 * leaves, the one that contains it reports the pair.
 */
export function reportPoint(a: Box, b: Box): [number, number] {
  return [Math.max(a.minX, b.minX), Math.max(a.minY, b.minY)];
}

/**
 * The bounds of the boxes' finite coordinates; at least 1 wide and high if these have no extent.
 */
export function worldAround(boxes: readonly Box[]): World {
  const extent = (coordinates: number[]): [number, number] => {
    const finite = coordinates.filter(Number.isFinite);
    if (finite.length === 0) return [0, 1];
    const min = finite.reduce((a, b) => Math.min(a, b));
    const wide = finite.reduce((a, b) => Math.max(a, b)) - min;
    return [min, wide > 0 ? wide : 1];
  };
  const [left, width] = extent(boxes.flatMap((box) => [box.minX, box.maxX]));
  const [top, height] = extent(boxes.flatMap((box) => [box.minY, box.maxY]));
  return { left, top, width, height };
}

// The input of painters: the same for WebGL, for a 2D canvas and for SVG.
import type { Outline } from "../engine/types.ts";
import type { Bounds, Dimension } from "../scene/scene.ts";
import type { Palette } from "./colours.ts";
import type { View } from "./camera.ts";

/** A rectangle of the picture, in pixels from its top left corner. */
export interface Place {
  x: number;
  y: number;
  width: number;
  height: number;
}

export interface PanelPainting {
  place: Place;
  outline: Outline | undefined;
  /** A mark for each box, if the panel has its own marks. */
  marks: Uint8Array | undefined;
  /** The selected box and the boxes that it was tested against. */
  tests: { box: number; others: Uint32Array } | undefined;
}

export interface Painting {
  dimension: Dimension;
  bounds: Bounds;
  boxes: Float32Array;
  marks: Uint8Array;
  overlaps: Float32Array;
  panels: PanelPainting[];
  view: View;
  palette: Palette;
}

/** The graphics card's work for a picture. */
export interface Drawn {
  vertices: number;
  /** Bytes uploaded for it. */
  bytes: number;
}

export interface Painter {
  /** Work for the last picture, if known. */
  readonly drawn?: Drawn;
  /** Sets the size of the picture in CSS pixels, and the number of device pixels per CSS pixel. */
  resize(width: number, height: number, ratio: number): void;
  paint(painting: Painting): void;
}

/**
 * Opacity of overlaps: lower if many lie on top of each other, so that the boxes below stay
 * visible.
 */
export function overlapStrength({ overlaps, bounds, dimension }: Painting): number {
  const volume = (of: ArrayLike<number>, at: number): number => {
    let product = 1;
    for (let axis = 0; axis < dimension; ++axis) product *= of[at + dimension + axis]! - of[at + axis]!;
    return product;
  };
  const world = volume(bounds, 0);
  let sum = 0;
  for (let at = 0; at < overlaps.length; at += 2 * dimension) sum += Math.min(world, volume(overlaps, at) || 0);
  return (dimension === 2 ? 0.62 : 0.4) / Math.max(1, sum / (0.12 * world));
}

/** Maximum number of lines from a selected box to the boxes that it was tested against. */
export const maxTestLines = 3000;

/** Lines between centres: two points each. An infinite side counts as far as the scene's bounds. */
export function testLines({ boxes, bounds, dimension }: Painting, box: number, others: Uint32Array):
    Float32Array<ArrayBuffer> {
  const stride = 2 * dimension;
  const count = Math.min(maxTestLines, others.length);
  const lines = new Float32Array(6 * count);
  const side = (of: number, at: number): number => {
    const one = boxes[stride * of + at]!;
    return Number.isFinite(one) ? one : bounds[at]!;
  };
  const centre = (of: number, axis: number): number =>
    axis < dimension ? (side(of, axis) + side(of, dimension + axis)) / 2 : 0;
  for (let line = 0; line < count; ++line) {
    for (let axis = 0; axis < 3; ++axis) {
      lines[6 * line + axis] = centre(box, axis);
      lines[6 * line + 3 + axis] = centre(others[line]!, axis);
    }
  }
  return lines;
}

// The part of the world that a panel shows, and conversions between pixels and coordinates.
import { m4, v3 } from "twgl.js";

import type { Bounds } from "../scene/scene.ts";

export interface Size {
  width: number;
  height: number;
}

/** The visitor's view of the boxes: the same in every panel. */
export interface View {
  zoom: number;
  /** Centre of the view, relative to the middle of the bounds, in multiples of their size. */
  x: number;
  y: number;
  /** Angle of the camera in 3D, in radians. */
  turn: number;
  tilt: number;
  /** Whether y grows upwards in 2D. */
  up?: boolean;
}

export const defaultView: View = { zoom: 1, x: 0, y: 0, turn: 0.6, tilt: 0.42 };

/**
 * A flat camera. Pixels of a panel are `x * scale + left` and `y * down * scale + top`, with y of
 * the panel downwards.
 */
export interface Flat {
  scale: number;
  /** 1 if y of the boxes grows downwards; -1: upwards. */
  down: 1 | -1;
  left: number;
  top: number;
}

export function flatCamera(bounds: Bounds, size: Size, view: View): Flat {
  const [x0, y0, x1, y1] = bounds as [number, number, number, number];
  const [wide, high] = [x1 - x0 || 1, y1 - y0 || 1];
  const scale = 0.96 * Math.min(size.width / wide, size.height / high) * view.zoom;
  const [x, y] = [(x0 + x1) / 2 + view.x * wide, (y0 + y1) / 2 + view.y * high];
  const down = view.up === true ? -1 : 1;
  return { scale, down, left: size.width / 2 - x * scale, top: size.height / 2 - y * down * scale };
}

export function toWorld({ scale, down, left, top }: Flat, x: number, y: number): [number, number] {
  return [(x - left) / scale, (y - top) / (down * scale)];
}

/** WebGL matrix from coordinates to the clip space of a panel. */
export function flatMatrix({ scale, down, left, top }: Flat, { width, height }: Size): m4.Mat4 {
  const [x, y] = [2 * scale / width, 2 * scale / height];
  return [x, 0, 0, 0, 0, -down * y, 0, 0, 0, 0, 0, 0, 2 * left / width - 1, 1 - 2 * top / height, 0, 1];
}

export function solidMatrix(bounds: Bounds, { width, height }: Size, view: View): m4.Mat4 {
  const low = bounds.slice(0, 3);
  const high = bounds.slice(3, 6);
  const centre = low.map((one, axis) => (one + high[axis]!) / 2);
  const radius = Math.hypot(...low.map((one, axis) => high[axis]! - one)) / 2 || 1;
  const field = Math.PI / 5;
  // The bounding sphere of the bounds must fit into the narrower side of the panel.
  const narrow = Math.min(1, width / height);
  const away = radius / Math.sin(field / 2) / narrow / view.zoom * 0.8;
  const eye = [
    centre[0]! + away * Math.cos(view.tilt) * Math.sin(view.turn),
    centre[1]! + away * Math.sin(view.tilt),
    centre[2]! + away * Math.cos(view.tilt) * Math.cos(view.turn),
  ];
  const near = Math.max(away - 2 * radius, away / 100);
  const projection = m4.perspective(field, width / height, near, away + 3 * radius);
  const looking = m4.inverse(m4.lookAt(eye, centre, [0, 1, 0]));
  return m4.multiply(projection, looking);
}

/** Origin and direction of the ray through a pixel. */
export function rayAt(matrix: m4.Mat4, { width, height }: Size, x: number, y: number):
    { origin: number[]; direction: number[] } {
  const back = m4.inverse(matrix);
  const at = (depth: number): number[] =>
    Array.from(m4.transformPoint(back, [2 * x / width - 1, 1 - 2 * y / height, depth]));
  const [origin, far] = [at(-1), at(1)];
  return { origin, direction: Array.from(v3.subtract(far, origin)) };
}

// Prepares boxes for a graphics card: boxes of a few pixels as points, the others as shapes;
// invisible boxes are left out.
//
// A box drawn as a shape costs several vertices and two or more triangles, whatever its size. In a
// crowd, nearly all boxes are small enough for a point, which is one vertex.
import type { Bounds, Dimension } from "../scene/scene.ts";
import { between } from "../ui/numbers.ts";

/** How boxes are seen. */
export interface Lens {
  /** To clip space. */
  matrix: ArrayLike<number>;
  /** Half the panel's size, in device pixels. */
  pixels: readonly [number, number];
  /** A box whose longer side has up to this many pixels is drawn as a point. */
  maxPoint: number;
  /** Of the scene. */
  bounds: Bounds;
}

/**
 * Shapes are cut this far from the picture's middle, in halves of the picture, in 3D in sizes of the scene: infinity is
 * no place, and a product of 0 with it no number.
 */
const cutFlat = 4;
const cutSolid = 20;

/** Boxes just beyond the panel's edge may reach into it, because tiny boxes are drawn enlarged. */
const edge = 1.02;

/**
 * Texels in a row of a texture: a power of two. A texel holds two coordinates of a box, or its
 * mark.
 */
export const rowTexels = 2048;

export class Batch {
  /**
   * First the boxes drawn as points, then the others; in whole rows. The end of the last row may
   * hold old data.
   */
  boxes = new Float32Array(0);
  marks = new Uint8Array(0);
  points = 0;
  shapes = 0;
  private large = new Uint32Array(0);
  /** Where shapes are cut. */
  private readonly cut = new Float32Array(6);

  constructor(private readonly dimension: Dimension) {}

  get count(): number {
    return this.points + this.shapes;
  }

  clear(): void {
    this.points = this.shapes = 0;
  }

  /** Replaces the contents. Boxes without marks have mark 0. */
  set(boxes: Float32Array, marks: Uint8Array | undefined, lens: Lens): void {
    const stride = 2 * this.dimension;
    const count = boxes.length / stride;
    this.reserve(count);
    this.clear();
    const large = this.dimension === 2 ? this.addFlat(boxes, marks, lens) : this.addSolid(boxes, marks, lens);
    for (let k = 0; k < large; ++k) {
      const to = this.points + k;
      this.put(to, boxes, marks, this.large[k]!);
      for (let at = 0; at < stride; ++at) {
        const axis = at % this.dimension;
        this.boxes[stride * to + at] = between(this.boxes[stride * to + at]!, this.cut[axis]!, this.cut[axis + 3]!);
      }
    }
    this.shapes = large;
  }

  private reserve(count: number): void {
    if (count <= this.large.length) return;
    const room = Math.ceil(1.5 * count / rowTexels) * rowTexels;
    this.large = new Uint32Array(room);
    this.boxes = new Float32Array(2 * this.dimension * room);
    this.marks = new Uint8Array(room);
  }

  private put(to: number, boxes: Float32Array, marks: Uint8Array | undefined, box: number): void {
    const stride = 2 * this.dimension;
    const mine = this.boxes;
    for (let k = 0; k < stride; ++k) mine[stride * to + k] = boxes[stride * box + k]!;
    this.marks[to] = marks === undefined ? 0 : marks[box]!;
  }

  /** Adds the boxes drawn as points, and returns the number of larger boxes. */
  private addFlat(boxes: Float32Array, marks: Uint8Array | undefined, { matrix, pixels, maxPoint }: Lens): number {
    const { large } = this;
    const [scaleX, scaleY, shiftX, shiftY] = [matrix[0]!, matrix[5]!, matrix[12]!, matrix[13]!];
    const [left, right] = [(-edge - shiftX) / scaleX, (edge - shiftX) / scaleX];
    // The scale is below 0 if y grows downwards in the world.
    const [least, most] = [-Math.sign(scaleY) * edge, Math.sign(scaleY) * edge];
    const [top, bottom] = [(least - shiftY) / scaleY, (most - shiftY) / scaleY];
    const widest = cutFlat / edge;
    const [x, y] = [-shiftX / scaleX, -shiftY / scaleY];
    this.cut.set([x + widest * (left - x), y + widest * (top - y), 0, x + widest * (right - x), y + widest * (bottom - y)]);
    const maxExtent = maxPoint / (scaleX * pixels[0]);
    let [points, found] = [0, 0];
    for (let box = 0, at = 0; at < boxes.length; ++box, at += 4) {
      const x0 = boxes[at]!, y0 = boxes[at + 1]!, x1 = boxes[at + 2]!, y1 = boxes[at + 3]!;
      // Absent boxes have x0 > x1.
      if (!(x0 <= x1 && x0 <= right && x1 >= left && y0 <= bottom && y1 >= top)) continue;
      if (x1 - x0 <= maxExtent && y1 - y0 <= maxExtent) this.put(points++, boxes, marks, box);
      else large[found++] = box;
    }
    this.points = points;
    return found;
  }

  private addSolid(boxes: Float32Array, marks: Uint8Array | undefined, { matrix: m, pixels, maxPoint, bounds }: Lens): number {
    const { large } = this;
    const reach = cutSolid * Math.max(...[0, 1, 2].map((axis) => bounds[axis + 3]! - bounds[axis]!));
    this.cut.set(bounds.map((one, at) => at < 3 ? one - reach : one + reach));
    const norm = (row: number): number => Math.hypot(m[row]!, m[4 + row]!, m[8 + row]!);
    const maxRadius = Math.sqrt(0.75) * maxPoint / (norm(1) * pixels[1]);  // radius of a cube, by its distance
    const [slackX, slackY] = [norm(0) + norm(3), norm(1) + norm(3)];
    let [points, found] = [0, 0];
    for (let box = 0, at = 0; at < boxes.length; ++box, at += 6) {
      const x0 = boxes[at]!, y0 = boxes[at + 1]!, z0 = boxes[at + 2]!;
      const x1 = boxes[at + 3]!, y1 = boxes[at + 4]!, z1 = boxes[at + 5]!;
      if (!(x0 <= x1)) continue;
      const x = 0.5 * (x0 + x1), y = 0.5 * (y0 + y1), z = 0.5 * (z0 + z1);
      const radius = 0.5 * Math.sqrt((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0) + (z1 - z0) * (z1 - z0));
      const w = m[3]! * x + m[7]! * y + m[11]! * z + m[15]!;
      // Infinite boxes have centres of NaN, for which all of these comparisons are false.
      if (w < -radius || Math.abs(m[0]! * x + m[4]! * y + m[8]! * z + m[12]!) > w + slackX * radius ||
        Math.abs(m[1]! * x + m[5]! * y + m[9]! * z + m[13]!) > w + slackY * radius) continue;
      if (radius <= maxRadius * w) this.put(points++, boxes, marks, box);
      else large[found++] = box;
    }
    this.points = points;
    return found;
  }
}

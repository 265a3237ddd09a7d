// Paints on a 2D canvas if there is no WebGL.
import { m4 } from "twgl.js";

import { flatCamera, solidMatrix } from "./camera.ts";
import { fills, levelColour } from "./colours.ts";
import { maxTestLines, overlapStrength, testLines, type Painter, type Painting, type PanelPainting } from "./painting.ts";

/** Projects a box to panel pixels: a rectangle, in 3D the bounding rectangle of its corners. */
export type Projection = (boxes: Float32Array, at: number) => [x: number, y: number, width: number, height: number];

export function projectionOf(painting: Painting, panel: PanelPainting): Projection {
  const { bounds, dimension, view } = painting;
  const size = panel.place;
  if (dimension === 2) {
    const { scale, down, left, top } = flatCamera(bounds, size, view);
    const [wide, high] = [4 * size.width, 4 * size.height];
    return (boxes, at) => {
      const x0 = Math.max(-wide, boxes[at]! * scale + left);
      const y0 = Math.max(-high, boxes[at + (down > 0 ? 1 : 3)]! * down * scale + top);
      const x1 = Math.min(wide, boxes[at + 2]! * scale + left);
      const y1 = Math.min(high, boxes[at + (down > 0 ? 3 : 1)]! * down * scale + top);
      return [x0, y0, x1 - x0, y1 - y0];
    };
  }
  const matrix = solidMatrix(bounds, size, view);
  return (boxes, at) => {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let corner = 0; corner < 8; ++corner) {
      const point = [0, 1, 2].map((axis) => boxes[at + axis + ((corner >> axis) & 1) * 3]!);
      const [x, y] = m4.transformPoint(matrix, point) as unknown as [number, number];
      [x0, x1] = [Math.min(x0, x), Math.max(x1, x)];
      [y0, y1] = [Math.min(y0, -y), Math.max(y1, -y)];
    }
    const [w, h] = [size.width / 2, size.height / 2];
    return [(x0 + 1) * w, (y0 + 1) * h, (x1 - x0) * w, (y1 - y0) * h];
  };
}

export class CanvasPainter implements Painter {
  private readonly context: CanvasRenderingContext2D;
  private ratio = 1;

  constructor(private readonly canvas: HTMLCanvasElement) {
    const context = canvas.getContext("2d");
    if (context === null) throw new Error("this browser has no canvas");
    this.context = context;
  }

  resize(width: number, height: number, ratio: number): void {
    this.ratio = ratio;
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide) this.canvas.width = wide;
    if (this.canvas.height !== high) this.canvas.height = high;
  }

  paint(painting: Painting): void {
    const { context } = this;
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.globalAlpha = 1;
    context.fillStyle = painting.palette.background;
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    for (const panel of painting.panels) {
      context.save();
      const { x, y, width, height } = panel.place;
      context.beginPath();
      context.rect(x, y, width, height);
      context.clip();
      context.translate(x, y);
      this.paintPanel(painting, panel);
      context.restore();
    }
  }

  private paintPanel(painting: Painting, panel: PanelPainting): void {
    const { context } = this;
    const { palette, boxes, dimension } = painting;
    const project = projectionOf(painting, panel);
    const stride = 2 * dimension;
    context.lineWidth = 1;
    (panel.outline?.levels ?? []).forEach((parts, level) => {
      context.strokeStyle = levelColour(palette, level);
      context.globalAlpha = 0.7;
      for (let at = 0; at < parts.length; at += stride) context.strokeRect(...project(parts, at));
    });
    const marks = panel.marks ?? painting.marks;
    for (let box = 0; box < boxes.length / stride; ++box) {
      if (boxes[stride * box]! > boxes[stride * box + dimension]!) continue;
      const mark = marks[box] ?? 0;
      const place = project(boxes, stride * box);
      context.fillStyle = context.strokeStyle = palette.marks[mark]!;
      context.globalAlpha = fills[mark]!;
      context.fillRect(...place);
      context.globalAlpha = 1;
      context.strokeRect(...place);
    }
    context.fillStyle = palette.overlap;
    context.globalAlpha = overlapStrength(painting);
    for (let at = 0; at < painting.overlaps.length; at += stride) context.fillRect(...project(painting.overlaps, at));
    if (panel.tests === undefined) return;
    const others = panel.tests.others.subarray(0, maxTestLines);
    const lines = testLines(painting, panel.tests.box, others);
    context.strokeStyle = palette.marks[2]!;
    context.globalAlpha = 0.8;
    context.beginPath();
    const point = (at: number): [number, number] => {
      const one = lines.subarray(at, at + dimension);
      const [x, y] = project(Float32Array.from([...one, ...one]), 0);
      return [x, y];
    };
    for (let at = 0; at < lines.length; at += 6) {
      context.moveTo(...point(at));
      context.lineTo(...point(at + 3));
    }
    context.stroke();
  }
}

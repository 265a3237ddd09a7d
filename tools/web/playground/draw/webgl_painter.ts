// Paints by WebGL 2. All panels share one canvas; boxes are uploaded again only where panels
// differ.
import {
  createBufferInfoFromArrays, createProgramInfo, drawBufferInfo, setAttribInfoBufferFromArray, setBuffersAndAttributes,
  setUniforms, type BufferInfo, type ProgramInfo,
} from "twgl.js";

import { Mark } from "../bench/protocol.ts";
import type { Outline } from "../engine/types.ts";
import { Batch, type Lens } from "./batch.ts";
import { flatCamera, flatMatrix, solidMatrix } from "./camera.ts";
import { fills, levelColour, rgb } from "./colours.ts";
import {
  overlapStrength, testLines, type Drawn, type Painter, type Painting, type PanelPainting,
} from "./painting.ts";
import {
  flatFragment, flatVertex, lineFragment, lineVertex, solidFragment, solidVertex,
} from "./shaders.ts";
import { Indices, Smooth, Texels } from "./webgl_memory.ts";

/**
 * The triangles or lines of a shape, by its vertices: bit k of a vertex is its position on axis k.
 */
const shapes = {
  flat: { vertices: 4, indices: [0, 1, 2, 2, 1, 3] },
  faces: {
    vertices: 8,
    indices: [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]]
      .flatMap(([a, b, c, d]) => [a!, b!, c!, c!, b!, d!]),
  },
  edges: { vertices: 8, indices: [0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7] },
};

/**
 * Lines and edges of cubes are antialiased up to this number of boxes. In software that takes four
 * times as long.
 */
const maxSmooth = 1000;

/** Above this number of boxes, fewer details are drawn. */
const minCrowd = 20_000;

/** Boxes in graphics memory. */
class Layer {
  readonly boxes: Texels;
  readonly marks: Texels;
  readonly batches = { 2: new Batch(2), 3: new Batch(3) };
  private last: unknown[] = [];

  constructor(gl: WebGL2RenderingContext) {
    this.boxes = new Texels(gl, "coordinates");
    this.marks = new Texels(gl, "marks");
  }

  /**
   * Uploads boxes; returns the number of bytes. Most panels show what the previous panel showed,
   * which costs nothing.
   */
  set(dimension: 2 | 3, boxes: Float32Array, marks: Uint8Array | undefined, lens: Lens): number {
    const now = [boxes, marks, ...Array.from(lens.matrix), ...lens.pixels, lens.maxPoint];
    if (now.every((one, at) => one === this.last[at])) return 0;
    this.last = now;
    const batch = this.batches[dimension];
    batch.set(boxes, marks, lens);
    if (batch.count === 0) return 0;
    return this.boxes.set(batch.boxes, dimension * batch.count) + this.marks.set(batch.marks, batch.count);
  }
}

interface Style {
  inks: number[];
  fills: number[];
  border: number;
  minExtent: number;
  /** The parts of a 3D box to draw. */
  parts: readonly ("faces" | "edges")[];
}

export class WebglPainter implements Painter {
  private readonly gl: WebGL2RenderingContext;
  private readonly flat: ProgramInfo;
  private readonly solid: ProgramInfo;
  private readonly line: ProgramInfo;
  private readonly scene: Layer;
  private readonly overlaps: Layer;
  private readonly structure: Layer;
  private readonly indices: Record<keyof typeof shapes, Indices>;
  private readonly smooth: Smooth;
  private readonly lineInfo: BufferInfo;
  private ratio = 1;
  drawn: Drawn = { vertices: 0, bytes: 0 };

  constructor(private readonly canvas: HTMLCanvasElement) {
    // Flat boxes are antialiased by their own shader. Everything else is drawn to `smooth` first,
    // which needs the same format.
    const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
    if (gl === null) throw new Error("this browser has no WebGL 2");
    this.gl = gl;
    this.flat = createProgramInfo(gl, [flatVertex, flatFragment]);
    this.solid = createProgramInfo(gl, [solidVertex, solidFragment]);
    this.line = createProgramInfo(gl, [lineVertex, lineFragment]);
    this.scene = new Layer(gl);
    this.overlaps = new Layer(gl);
    this.structure = new Layer(gl);
    this.indices = {
      flat: new Indices(gl, shapes.flat), faces: new Indices(gl, shapes.faces), edges: new Indices(gl, shapes.edges),
    };
    this.smooth = new Smooth(gl);
    this.lineInfo = createBufferInfoFromArrays(gl, { point: { numComponents: 3, data: [0, 0, 0], drawType: gl.STREAM_DRAW } });
  }

  resize(width: number, height: number, ratio: number): void {
    this.ratio = ratio;
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide) this.canvas.width = wide;
    if (this.canvas.height !== high) this.canvas.height = high;
  }

  paint(painting: Painting): void {
    const { gl } = this;
    const { dimension, boxes, palette, panels } = painting;
    this.drawn = { vertices: 0, bytes: 0 };
    const smooth = boxes.length / (2 * dimension) <= maxSmooth &&
      (dimension === 3 || panels.some(({ tests }) => tests !== undefined));
    if (smooth) this.smooth.begin(this.canvas.width, this.canvas.height);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...rgb(palette.background), 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    gl.enable(gl.BLEND);
    // Colours are premultiplied by their opacity.
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const strength = overlapStrength(painting);
    for (const panel of panels) this.paintPanel(painting, panel, strength);
    if (smooth) this.smooth.end();
  }

  private paintPanel(painting: Painting, panel: PanelPainting, strength: number): void {
    const { gl, ratio } = this;
    const { dimension, bounds, boxes, overlaps, palette, view } = painting;
    const { x, y, width, height } = panel.place;
    if (width < 1 || height < 1) return;
    const viewport = [x * ratio, this.canvas.height - (y + height) * ratio, width * ratio, height * ratio]
      .map(Math.round) as [number, number, number, number];
    gl.viewport(...viewport);
    gl.scissor(...viewport);
    const matrix = dimension === 2
      ? flatMatrix(flatCamera(bounds, panel.place, view), panel.place) : solidMatrix(bounds, panel.place, view);
    const count = boxes.length / (2 * dimension);
    const isCrowd = count > minCrowd;
    const lens: Lens = { matrix, pixels: [viewport[2] / 2, viewport[3] / 2], maxPoint: (isCrowd ? 16 : 8) * ratio, bounds };
    const draw = (layer: Layer, style: Style): void => this.draw(layer, dimension, matrix, viewport, style);
    if (panel.outline !== undefined && this.setStructure(panel.outline, dimension, lens)) {
      const flat = dimension === 2;
      draw(this.structure, {
        inks: inksOf(palette.levels.length, (level) => [...rgb(levelColour(palette, level)), flat ? 0.75 : 0.4]),
        fills: Array<number>(6).fill(0.05), border: Math.max(1, ratio), minExtent: 0, parts: ["edges"],
      });
    }
    // In a crowd, borders would cover the insides; the selected box and the boxes tested against it
    // keep theirs.
    const strengthOf = (mark: number): number =>
      isCrowd && (mark === Mark.none || mark === Mark.lit || mark === Mark.faded) ? 0.5 : 1;
    const style: Style = {
      inks: palette.marks.flatMap((ink, mark) => [...rgb(ink), strengthOf(mark)]), fills: [...fills],
      border: Math.max(1, ratio), minExtent: (isCrowd ? 0.4 : 0.75) * ratio, parts: ["faces", "edges"],
    };
    const marks = panel.marks?.length === count ? panel.marks : painting.marks;
    this.drawn.bytes += this.scene.set(dimension, boxes, marks, lens);
    draw(this.scene, style);
    if (overlaps.length > 0) {
      this.drawn.bytes += this.overlaps.set(dimension, overlaps, undefined, lens);
      draw(this.overlaps, {
        ...style, inks: inksOf(1, () => [...rgb(palette.overlap), strength]), fills: Array<number>(6).fill(1),
        minExtent: isCrowd ? 0 : style.minExtent, parts: ["faces"],
      });
    }
    if (panel.tests !== undefined && panel.tests.others.length > 0) {
      const lines = testLines(painting, panel.tests.box, panel.tests.others);
      setAttribInfoBufferFromArray(gl, this.lineInfo.attribs!["point"]!, lines);
      gl.useProgram(this.line.program);
      setBuffersAndAttributes(gl, this.line, this.lineInfo);
      setUniforms(this.line, { matrix, ink: [...rgb(palette.marks[2]!).map((one) => one * 0.8), 0.8] });
      drawBufferInfo(gl, this.lineInfo, gl.LINES, lines.length / 3);
    }
  }

  /** All levels at once; a part's mark selects its level's colour. */
  private setStructure({ levels }: Outline, dimension: 2 | 3, lens: Lens): boolean {
    const length = levels.reduce((sum, parts) => sum + parts.length, 0);
    const all = new Float32Array(length);
    const marks = new Uint8Array(length / (2 * dimension));
    let end = 0;
    levels.forEach((parts, level) => {
      all.set(parts, end);
      marks.fill(level % 4, end / (2 * dimension), (end += parts.length) / (2 * dimension));
    });
    this.drawn.bytes += this.structure.set(dimension, all, marks, lens);
    return length > 0;
  }

  private draw({ batches, boxes, marks }: Layer, dimension: 2 | 3, matrix: ArrayLike<number>,
               viewport: readonly number[], style: Style): void {
    const { gl } = this;
    const batch = batches[dimension];
    const shared = {
      boxes: boxes.texture, marks: marks.texture, dimension, matrix, inks: style.inks, fills: style.fills,
    };
    const useFlat = (points: boolean, first: number): void => {
      gl.useProgram(this.flat.program);
      setUniforms(this.flat, { ...shared, viewport, first, points, border: style.border, minExtent: style.minExtent });
    };
    if (batch.points > 0) {
      useFlat(true, 0);
      gl.drawArrays(gl.POINTS, 0, batch.points);
      this.drawn.vertices += batch.points;
    }
    if (batch.shapes === 0) return;
    if (dimension === 2) {
      useFlat(false, batch.points);
      this.drawShapes("flat", batch.shapes);
      return;
    }
    gl.useProgram(this.solid.program);
    for (const shape of style.parts) {
      setUniforms(this.solid, { ...shared, first: batch.points, faces: shape === "faces" });
      this.drawShapes(shape, batch.shapes);
    }
  }

  private drawShapes(name: keyof typeof shapes, count: number): void {
    const { gl } = this;
    const { vertices, indices } = shapes[name];
    this.drawn.bytes += this.indices[name].bind(count);
    this.drawn.vertices += vertices * count;
    gl.drawElements(name === "edges" ? gl.LINES : gl.TRIANGLES, indices.length * count, gl.UNSIGNED_INT, 0);
  }
}

/** Six colours, the number in the shaders; beyond `count` they repeat. */
function inksOf(count: number, ink: (at: number) => number[]): number[] {
  return Array.from({ length: 6 }, (_, at) => ink(at % count)).flat();
}

// Paints by WebGL 2: an instance a box. All panels share one canvas, so boxes are handed over once a frame.
import {
  createBufferInfoFromArrays, createProgramInfo, drawBufferInfo, setBuffersAndAttributes, setUniforms,
  type BufferInfo, type ProgramInfo,
} from "twgl.js";

import type { Outline } from "../engine/types.ts";
import { flatCamera, flatMatrix, solidMatrix } from "./camera.ts";
import { fills, levelColour, rgb, type Palette } from "./colours.ts";
import { overlapStrength, testLines, type Painter, type Painting, type PanelPainting } from "./painting.ts";
import {
  flatFragment, flatVertex, lineFragment, lineVertex, solidFragment, solidVertex,
} from "./shaders.ts";

/** The corners of a unit cube's faces, as triangles, and of its edges, as lines. */
function cube(): { faces: number[]; edges: number[] } {
  const faces: number[] = [];
  const edges: number[] = [];
  for (let axis = 0; axis < 3; ++axis) {
    const point = (a: number, b: number, c: number): number[] => {
      const at = [0, 0, 0];
      at[axis] = a;
      at[(axis + 1) % 3] = b;
      at[(axis + 2) % 3] = c;
      return at;
    };
    for (const side of [0, 1]) {
      for (const [b, c] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]] as const)
        faces.push(...point(side, b, c));
    }
    for (const [b, c] of [[0, 0], [0, 1], [1, 0], [1, 1]] as const)
      edges.push(...point(0, b, c), ...point(1, b, c));
  }
  return { faces, edges };
}

/** A buffer that grows, and is handed data anew. */
class Stream {
  readonly buffer: WebGLBuffer;
  private size = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.buffer = gl.createBuffer()!;
  }

  set(data: Float32Array | Uint8Array): void {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    if (data.byteLength > this.size) {
      this.size = Math.ceil(data.byteLength * 1.5);
      gl.bufferData(gl.ARRAY_BUFFER, this.size, gl.STREAM_DRAW);
    }
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, data);
  }
}

/** A drawing of boxes: a shape, and the buffers of the instances. */
class Instances {
  readonly boxes: Stream;
  readonly marks: Stream;
  private readonly flat: BufferInfo;
  private readonly faces: BufferInfo;
  private readonly edges: BufferInfo;

  constructor(gl: WebGL2RenderingContext) {
    this.boxes = new Stream(gl);
    this.marks = new Stream(gl);
    const { faces, edges } = cube();
    const mark = { buffer: this.marks.buffer, numComponents: 1, type: gl.UNSIGNED_BYTE, divisor: 1, normalize: false };
    const solid = (corners: number[]): BufferInfo => createBufferInfoFromArrays(gl, {
      corner: { numComponents: 3, data: corners },
      low: { buffer: this.boxes.buffer, numComponents: 3, type: gl.FLOAT, stride: 24, offset: 0, divisor: 1 },
      high: { buffer: this.boxes.buffer, numComponents: 3, type: gl.FLOAT, stride: 24, offset: 12, divisor: 1 },
      mark,
    } as Parameters<typeof createBufferInfoFromArrays>[1]);
    this.flat = createBufferInfoFromArrays(gl, {
      corner: { numComponents: 2, data: [0, 0, 1, 0, 0, 1, 1, 1] },
      box: { buffer: this.boxes.buffer, numComponents: 4, type: gl.FLOAT, stride: 16, offset: 0, divisor: 1 },
      mark,
    } as Parameters<typeof createBufferInfoFromArrays>[1]);
    // Their number is that of corners, whatever buffer twgl has counted.
    this.flat.numElements = 4;
    this.faces = solid(faces);
    this.faces.numElements = faces.length / 3;
    this.edges = solid(edges);
    this.edges.numElements = edges.length / 3;
  }

  shape(name: "flat" | "faces" | "edges"): BufferInfo {
    return this[name];
  }
}

interface Style {
  only: number;
  inks: number[];
  fills: number[];
  border: number;
  least: number;
  /** Whether edges are drawn, in 3D. */
  edges: boolean;
}

export class WebglPainter implements Painter {
  private readonly gl: WebGL2RenderingContext;
  private readonly flat: ProgramInfo;
  private readonly solid: ProgramInfo;
  private readonly line: ProgramInfo;
  private readonly scene: Instances;
  private readonly overlaps: Instances;
  private readonly structure: Instances;
  private readonly lines: Stream;
  private readonly lineInfo: BufferInfo;
  private ratio = 1;

  constructor(private readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false, preserveDrawingBuffer: true });
    if (gl === null) throw new Error("this browser has no WebGL 2");
    this.gl = gl;
    this.flat = createProgramInfo(gl, [flatVertex, flatFragment]);
    this.solid = createProgramInfo(gl, [solidVertex, solidFragment]);
    this.line = createProgramInfo(gl, [lineVertex, lineFragment]);
    this.scene = new Instances(gl);
    this.overlaps = new Instances(gl);
    this.structure = new Instances(gl);
    this.lines = new Stream(gl);
    this.lineInfo = createBufferInfoFromArrays(gl, {
      point: { buffer: this.lines.buffer, numComponents: 3, type: gl.FLOAT },
    } as Parameters<typeof createBufferInfoFromArrays>[1]);
  }

  resize(width: number, height: number, ratio: number): void {
    this.ratio = ratio;
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide) this.canvas.width = wide;
    if (this.canvas.height !== high) this.canvas.height = high;
  }

  paint(painting: Painting): void {
    const { gl, ratio } = this;
    const { boxes, marks, overlaps, palette } = painting;
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...rgb(palette.background), 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.SCISSOR_TEST);
    gl.enable(gl.BLEND);
    // Colours are multiplied by their opacity.
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.scene.boxes.set(boxes);
    this.scene.marks.set(marks);
    this.overlaps.boxes.set(overlaps);
    let shared = true;
    for (const panel of painting.panels) {
      const { x, y, width, height } = panel.place;
      if (width < 1 || height < 1) continue;
      const rectangle = [x * ratio, this.canvas.height - (y + height) * ratio, width * ratio, height * ratio] as const;
      gl.viewport(...rectangle);
      gl.scissor(...rectangle);
      const own = panel.marks?.length === boxes.length / (2 * painting.dimension);
      if (own) this.scene.marks.set(panel.marks!);
      else if (!shared) this.scene.marks.set(marks);
      shared = !own;
      this.paintPanel(painting, panel);
    }
  }

  private paintPanel(painting: Painting, panel: PanelPainting): void {
    const { dimension, bounds, boxes, overlaps, palette, view } = painting;
    const size = panel.place;
    const matrix = dimension === 2
      ? flatMatrix(flatCamera(bounds, size, view), size) : solidMatrix(bounds, size, view);
    const pixels = [size.width * this.ratio / 2, size.height * this.ratio / 2];
    const count = boxes.length / (2 * dimension);
    if (panel.outline !== undefined) this.paintStructure(panel.outline, dimension, matrix, pixels, palette);
    // Borders of crowds would cover what is in them.
    const crowd = count > 20_000 ? 0.5 : 1;
    const style: Style = {
      only: -1, inks: palette.marks.flatMap((ink) => [...rgb(ink), crowd]), fills: [...fills],
      border: Math.max(1, this.ratio), least: 0.75 * this.ratio, edges: true,
    };
    this.draw(this.scene, dimension, count, matrix, pixels, style);
    const parts = overlaps.length / (2 * dimension);
    if (parts > 0) {
      this.draw(this.overlaps, dimension, parts, matrix, pixels, {
        ...style, only: 0, inks: repeated([...rgb(palette.overlap), overlapStrength(painting)]),
        fills: Array<number>(6).fill(1), edges: false,
      });
    }
    if (panel.tests !== undefined && panel.tests.others.length > 0) {
      const lines = testLines(boxes, dimension, panel.tests.box, panel.tests.others);
      this.lines.set(lines);
      const { gl } = this;
      gl.useProgram(this.line.program);
      setBuffersAndAttributes(gl, this.line, this.lineInfo);
      setUniforms(this.line, { matrix, ink: [...rgb(palette.marks[2]!).map((one) => one * 0.8), 0.8] });
      drawBufferInfo(gl, this.lineInfo, gl.LINES, lines.length / 3);
    }
  }

  private paintStructure(outline: Outline, dimension: 2 | 3, matrix: ArrayLike<number>, pixels: number[],
                         palette: Palette): void {
    outline.levels.forEach((parts, level) => {
      const count = parts.length / (2 * dimension);
      if (count === 0) return;
      this.structure.boxes.set(parts);
      this.structure.marks.set(new Uint8Array(count));
      const ink = rgb(levelColour(palette, level));
      this.draw(this.structure, dimension, count, matrix, pixels, {
        only: 0, inks: repeated([...ink, dimension === 2 ? 0.75 : 0.4]),
        fills: Array<number>(6).fill(dimension === 2 ? 0.05 : 0.02), border: Math.max(1, this.ratio), least: 0, edges: true,
      });
    });
  }

  private draw(instances: Instances, dimension: 2 | 3, count: number, matrix: ArrayLike<number>, pixels: number[],
               style: Style): void {
    const { gl } = this;
    const { only, inks, border, least } = style;
    const strengths = style.fills;
    if (dimension === 2) {
      gl.useProgram(this.flat.program);
      setBuffersAndAttributes(gl, this.flat, instances.shape("flat"));
      setUniforms(this.flat, { matrix, pixels, only, inks, fills: strengths, border, least });
      drawBufferInfo(gl, instances.shape("flat"), gl.TRIANGLE_STRIP, 4, 0, count);
      return;
    }
    gl.useProgram(this.solid.program);
    for (const shape of style.edges ? ["faces", "edges"] as const : ["faces"] as const) {
      setBuffersAndAttributes(gl, this.solid, instances.shape(shape));
      setUniforms(this.solid, { matrix, only, inks, fills: strengths, faces: shape === "faces" ? 1 : 0 });
      const info = instances.shape(shape);
      drawBufferInfo(gl, info, shape === "faces" ? gl.TRIANGLES : gl.LINES, info.numElements, 0, count);
    }
  }
}

function repeated(ink: number[]): number[] {
  return Array.from({ length: 6 }, () => ink).flat();
}

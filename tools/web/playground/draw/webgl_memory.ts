// Graphics memory of the painter: boxes, vertices of shapes, and a picture before it is copied to
// the canvas.
import { rowTexels } from "./batch.ts";

/** A growing texture of numbers, filled row by row. */
export class Texels {
  readonly texture: WebGLTexture;
  private rows = 0;

  constructor(private readonly gl: WebGL2RenderingContext, private readonly format: "marks" | "coordinates") {
    this.texture = gl.createTexture()!;
    this.bind();
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
  }

  private bind(): void {
    this.gl.bindTexture(this.gl.TEXTURE_2D, this.texture);
  }

  /** Uploads the first texels of an array of whole rows; returns the number of bytes. */
  set(data: Float32Array | Uint8Array, texels: number): number {
    const { gl } = this;
    const [inside, format, type, size] = this.format === "marks"
      ? [gl.R8UI, gl.RED_INTEGER, gl.UNSIGNED_BYTE, 1] as const : [gl.RG32F, gl.RG, gl.FLOAT, 8] as const;
    const rows = Math.ceil(texels / rowTexels);
    this.bind();
    if (rows > this.rows) {
      this.rows = Math.ceil(1.5 * rows);
      gl.texImage2D(gl.TEXTURE_2D, 0, inside, rowTexels, this.rows, 0, format, type, null);
    }
    const width = Math.min(rowTexels, texels);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, rows, format, type, data);
    return size * width * rows;
  }
}

/** The indices of a shape's vertices, for a growing number of boxes. */
export class Indices {
  private readonly buffer: WebGLBuffer;
  private boxes = 0;

  constructor(private readonly gl: WebGL2RenderingContext, readonly shape: { vertices: number; indices: number[] }) {
    this.buffer = gl.createBuffer()!;
  }

  /** Returns the number of bytes uploaded. */
  bind(boxes: number): number {
    const { gl, shape: { vertices, indices } } = this;
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffer);
    if (boxes <= this.boxes) return 0;
    this.boxes = Math.ceil(1.5 * boxes);
    const all = new Uint32Array(indices.length * this.boxes);
    for (let box = 0, at = 0; box < this.boxes; ++box) {
      for (const index of indices) all[at++] = vertices * box + index;
    }
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, all, gl.STATIC_DRAW);
    return all.byteLength;
  }
}

/** An antialiased picture, to be copied to the canvas. */
export class Smooth {
  private readonly frame: WebGLFramebuffer;
  private readonly colours: WebGLRenderbuffer;
  private size: readonly [number, number] = [0, 0];

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.frame = gl.createFramebuffer()!;
    this.colours = gl.createRenderbuffer()!;
  }

  begin(width: number, height: number): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    if (this.size[0] === width && this.size[1] === height) return;
    this.size = [width, height];
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.colours);
    const samples = Math.min(4, gl.getParameter(gl.MAX_SAMPLES) as number);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, gl.RGBA8, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, this.colours);
  }

  end(): void {
    const { gl, size: [width, height] } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.frame);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.disable(gl.SCISSOR_TEST);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }
}

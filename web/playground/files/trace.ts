// Traces, versions 1 and 2 (docs/trace-format.md): boxes of each frame. Recorded pairs are passed over.
import type { Recorded } from "../scene/frames.ts";
import type { Dimension } from "../scene/scene.ts";
import { checkCount, FileProblem } from "./problem.ts";

export const traceMagic = [0x89, 0x42, 0x54, 0x52, 0x0d, 0x0a, 0x1a, 0x0a] as const;

const frameMagic = 0x4d415246;  // "FRAM"

/** The most numbers that all frames together may take. */
const mostNumbers = 60e6;

const table = Uint32Array.from({ length: 256 }, (_, byte) => {
  let value = byte;
  for (let bit = 0; bit < 8; ++bit) value = (value & 1) !== 0 ? (value >>> 1) ^ 0x82f63b78 : value >>> 1;
  return value;
});

/** The bytes in order, with the CRC-32C of all but the checksums. */
class Cursor {
  at = 0;
  private crc = 0xffffffff;
  private readonly view: DataView;

  constructor(private readonly bytes: Uint8Array) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  get left(): number {
    return this.bytes.length - this.at;
  }

  /** Goes on by some bytes and tells where they begin. */
  take(count: number, what: string): number {
    if (this.left < count) throw new FileProblem(`byte ${this.at}: the trace ends in ${what}`);
    for (let end = this.at + count, one = this.at; one < end; ++one)
      this.crc = (this.crc >>> 8) ^ table[(this.crc ^ this.bytes[one]!) & 255]!;
    this.at += count;
    return this.at - count;
  }

  u32(what: string): number {
    return this.view.getUint32(this.take(4, what), true);
  }

  real(at: number, size: number): number {
    return size === 4 ? this.view.getFloat32(at, true) : this.view.getFloat64(at, true);
  }

  u8(at: number): number {
    return this.view.getUint8(at);
  }

  check(what: string): void {
    if (this.left < 4) throw new FileProblem(`byte ${this.at}: the trace ends before the checksum of ${what}`);
    const [found, expected] = [this.view.getUint32(this.at, true), (this.crc ^ 0xffffffff) >>> 0];
    if (found !== expected)
      throw new FileProblem(`byte ${this.at}: the checksum of ${what} is 0x${found.toString(16)}; expected 0x${expected.toString(16)}`);
    this.at += 4;
  }
}

export function readTrace(bytes: Uint8Array): Recorded {
  const cursor = new Cursor(bytes);
  const begin = cursor.take(8, "its header");
  if (traceMagic.some((byte, at) => cursor.u8(begin + at) !== byte)) throw new FileProblem("the file is no trace");
  const version = cursor.u32("its header");
  if (version !== 1 && version !== 2) throw new FileProblem(`version ${version} of the trace format; expected 1 or 2`);
  const about = cursor.take(4, "its header");
  const [dimension, size] = [cursor.u8(about), cursor.u8(about + 1)];
  if (dimension !== 2 && dimension !== 3) throw new FileProblem(`${dimension} axes; expected 2 or 3`);
  if (size !== 4 && size !== 8) throw new FileProblem(`${size} bytes a coordinate; expected 4 or 8`);
  if (version === 2) cursor.take(8, "its header");
  cursor.check("the header");
  const frames: Float32Array<ArrayBuffer>[] = [];
  let boxes = new Float32Array();
  let numbers = 0;
  while (cursor.left > 0) {
    try {
      boxes = frame(cursor, version, dimension, size, boxes);
    } catch (error) {
      // A trace that was cut off gives the frames before.
      if (error instanceof FileProblem && /the trace ends/.test(error.message) && frames.length > 0) break;
      throw error;
    }
    frames.push(boxes);
    numbers += boxes.length;
    if (numbers > mostNumbers)
      throw new FileProblem(`more than ${frames.length} frames of ${boxes.length / (2 * dimension)} boxes; that is more than a page should hold`);
  }
  if (frames.length === 0) throw new FileProblem("the trace holds no frames");
  return { dimension, frames };
}

function frame(cursor: Cursor, version: number, dimension: Dimension, size: number, before: Float32Array<ArrayBuffer>):
    Float32Array<ArrayBuffer> {
  const what = "a frame";
  const magic = cursor.u32(what);
  if (magic !== frameMagic) throw new FileProblem(`byte ${cursor.at - 4}: 0x${magic.toString(16)}; expected a frame ("FRAM")`);
  const [slots, empties, sets] = [cursor.u32(what), cursor.u32(what), cursor.u32(what)];
  const more = version === 2 ? Array.from({ length: 5 }, () => cursor.u32(what)) : [0, 0, 0, 0, 0];
  cursor.check("a frame's header");
  checkCount(slots);
  const stride = 2 * dimension;
  const boxes = new Float32Array(slots * stride);
  boxes.set(before.subarray(0, boxes.length));
  const absent = [...Array<number>(dimension).fill(Infinity), ...Array<number>(dimension).fill(-Infinity)];
  for (let at = before.length; at < boxes.length; at += stride) boxes.set(absent, at);
  const slot = (): number => {
    const one = cursor.u32(what);
    if (one >= slots) throw new FileProblem(`byte ${cursor.at - 4}: slot ${one}; expected less than ${slots}`);
    return one;
  };
  for (let one = 0; one < empties; ++one) boxes.set(absent, stride * slot());
  for (let one = 0; one < sets; ++one) {
    const at = stride * slot();
    const from = cursor.take(stride * size, what);
    for (let number = 0; number < stride; ++number) boxes[at + number] = cursor.real(from + number * size, size);
  }
  const [filters, ...pairs] = more as [number, ...number[]];
  cursor.take(28 * filters + 8 * pairs.reduce((sum, one) => sum + one, 0), what);
  cursor.check("a frame");
  return boxes;
}

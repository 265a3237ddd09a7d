// PLY, as text or in binary: a box for each triangle, or for each vertex where there are no faces.
import type { Recorded } from "../scene/frames.ts";
import { checkCount, FileProblem } from "./problem.ts";

interface Property {
  name: string;
  type: string;
  /** The type of a list's length. */
  length?: string;
}

interface Element {
  name: string;
  count: number;
  properties: Property[];
}

const sizes: Record<string, number> = {
  char: 1, uchar: 1, short: 2, ushort: 2, int: 4, uint: 4, float: 4, double: 8,
  int8: 1, uint8: 1, int16: 2, uint16: 2, int32: 4, uint32: 4, float32: 4, float64: 8,
};

/** Reads one number of a type. */
type Source = (type: string) => number;

function binary(bytes: Uint8Array, from: number, little: boolean): Source {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = from;
  return (type) => {
    const size = sizes[type]!;
    if (at + size > bytes.length) throw new FileProblem(`byte ${at}: the mesh ends before its header says`);
    at += size;
    const begin = at - size;
    if (/^(float|float32)$/.test(type)) return view.getFloat32(begin, little);
    if (/^(double|float64)$/.test(type)) return view.getFloat64(begin, little);
    const unsigned = type.startsWith("u");
    if (size === 1) return unsigned ? view.getUint8(begin) : view.getInt8(begin);
    if (size === 2) return unsigned ? view.getUint16(begin, little) : view.getInt16(begin, little);
    return unsigned ? view.getUint32(begin, little) : view.getInt32(begin, little);
  };
}

function text(bytes: Uint8Array, from: number): Source {
  const words = new TextDecoder().decode(bytes.subarray(from)).split(/\s+/).filter((word) => word !== "");
  let at = 0;
  return () => {
    const word = words[at++];
    if (word === undefined) throw new FileProblem("the mesh ends before its header says");
    const value = Number(word);
    if (Number.isNaN(value)) throw new FileProblem(`"${word}" in the mesh is no number`);
    return value;
  };
}

function headerOf(bytes: Uint8Array): { format: string; elements: Element[]; end: number } {
  const head = new TextDecoder("latin1").decode(bytes.subarray(0, 65_536));
  const match = /\bend_header[ \t]*\r?\n/.exec(head);
  if (match === null) throw new FileProblem('the mesh has no "end_header" in its first 65,536 bytes');
  let format = "";
  const elements: Element[] = [];
  for (const line of head.slice(0, match.index).split(/\r?\n/)) {
    const words = line.trim().split(/\s+/);
    if (words[0] === "format") format = words[1] ?? "";
    else if (words[0] === "element") elements.push({ name: words[1] ?? "", count: Number(words[2]), properties: [] });
    else if (words[0] === "property") {
      const list = words[1] === "list";
      const property = list
        ? { name: words[4] ?? "", type: words[3] ?? "", length: words[2] ?? "" } : { name: words[2] ?? "", type: words[1] ?? "" };
      for (const type of [property.type, property.length ?? "int"]) {
        if (sizes[type] === undefined) throw new FileProblem(`a property of type "${type}"; expected ${Object.keys(sizes).slice(0, 8).join(", ")}`);
      }
      elements[elements.length - 1]?.properties.push(property);
    }
  }
  return { format, elements, end: match.index + match[0].length };
}

export function readPly(bytes: Uint8Array): Recorded {
  const { format, elements, end } = headerOf(bytes);
  if (!["ascii", "binary_little_endian", "binary_big_endian"].includes(format))
    throw new FileProblem(`format "${format}" of a PLY; expected ascii, binary_little_endian or binary_big_endian`);
  const next = format === "ascii" ? text(bytes, end) : binary(bytes, end, format === "binary_little_endian");
  const vertices: number[] = [];
  const triangles: number[] = [];
  for (const { name, count, properties } of elements) {
    const axes = ["x", "y", "z"].map((axis) => properties.findIndex((one) => one.name === axis));
    if (name === "vertex" && axes.some((one) => one < 0)) throw new FileProblem("the vertices have no x, y and z");
    for (let one = 0; one < count; ++one) {
      const row: number[] = [];
      for (const property of properties) {
        if (property.length === undefined) {
          row.push(next(property.type));
          continue;
        }
        const corners = Array.from({ length: next(property.length) }, () => next(property.type));
        row.push(0);
        if (name !== "face" || !/^vertex_ind(ex|ices)$/.test(property.name)) continue;
        // A polygon is a fan around its first corner.
        for (let at = 2; at < corners.length; ++at) triangles.push(corners[0]!, corners[at - 1]!, corners[at]!);
      }
      if (name === "vertex") vertices.push(...axes.map((at) => row[at]!));
      checkCount(Math.max(vertices.length, triangles.length) / 3);
    }
  }
  const corners = triangles.length > 0 ? triangles : Array.from({ length: vertices.length / 3 }, (_, at) => at);
  const each = triangles.length > 0 ? 3 : 1;
  if (corners.length === 0) throw new FileProblem("the mesh has no vertices");
  const boxes = new Float32Array(corners.length / each * 6);
  for (let box = 0; box < corners.length / each; ++box) {
    for (let axis = 0; axis < 3; ++axis) {
      const values = corners.slice(each * box, each * box + each).map((corner) => {
        const value = vertices[3 * corner + axis];
        if (value === undefined || !Number.isFinite(value))
          throw new FileProblem(`vertex ${corner} of ${vertices.length / 3}, which a face names, is missing or not finite`);
        return value;
      });
      boxes[6 * box + axis] = Math.min(...values);
      boxes[6 * box + 3 + axis] = Math.max(...values);
    }
  }
  return { dimension: 3, frames: [boxes] };
}

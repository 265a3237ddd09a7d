// The readers of files: what docs/formats.md and docs/trace-format.md say of them.
import assert from "node:assert/strict";
import { test } from "node:test";

import { readBoxes } from "../files/read.ts";

const utf8 = (text: string): Uint8Array => new TextEncoder().encode(text);
const rows = (frame: Float32Array, stride: number): number[][] =>
  Array.from({ length: frame.length / stride }, (_, at) => [...frame.subarray(stride * at, stride * at + stride)]);
const read = (text: string): ReturnType<typeof readBoxes> => readBoxes(utf8(text), "boxes.csv");
const absent = [Infinity, Infinity, -Infinity, -Infinity];

/** The example of docs/trace-format.md. */
const trace = `
  89 42 54 52 0d 0a 1a 0a 01 00 00 00 02 04 00 00 a1 79 96 6c
  46 52 41 4d 03 00 00 00 01 00 00 00 02 00 00 00 70 e9 81 be 01 00 00 00
  00 00 00 00 00 00 00 00 00 00 00 00 00 00 80 3f 00 00 80 3f
  02 00 00 00 00 00 00 40 00 00 00 3f 00 00 80 40 00 00 40 40 98 da 17 70
  46 52 41 4d 03 00 00 00 01 00 00 00 01 00 00 00 9f 61 07 5b 02 00 00 00
  00 00 00 00 00 00 80 3e 00 00 00 00 00 00 a0 3f 00 00 80 3f ec f2 37 71`;

/** The one with pairs. */
const traceWithPairs = `
  89 42 54 52 0d 0a 1a 0a 02 00 00 00 02 04 00 00 00 00 00 00 00 00 e0 3f b7 23 7d bb
  46 52 41 4d 03 00 00 00 00 00 00 00 03 00 00 00 01 00 00 00 00 00 00 00 02 00 00 00
  00 00 00 00 01 00 00 00 a8 74 f0 c2
  00 00 00 00 00 00 00 00 00 00 00 00 00 00 80 3f 00 00 80 3f
  01 00 00 00 00 00 80 3f 00 00 00 00 00 00 00 40 00 00 80 3f
  02 00 00 00 00 00 80 3f 00 00 80 3f 00 00 40 40 00 00 00 40
  00 00 00 00 02 00 00 00 00 00 00 00 05 00 00 00 00 00 00 00 ff ff ff ff 01 00 00 00
  00 00 00 00 01 00 00 00 01 00 00 00 02 00 00 00 00 00 00 00 02 00 00 00 86 d7 84 7c
  46 52 41 4d 03 00 00 00 00 00 00 00 01 00 00 00 00 00 00 00 01 00 00 00 01 00 00 00
  01 00 00 00 00 00 00 00 e7 1f dd b9
  01 00 00 00 00 00 00 40 00 00 00 00 00 00 40 40 00 00 80 3f
  00 00 00 00 01 00 00 00 01 00 00 00 02 00 00 00 00 00 00 00 02 00 00 00 3f 3b 87 1d`;

export function bytesOf(hex: string): Uint8Array {
  return Uint8Array.from(hex.trim().split(/\s+/), (byte) => Number.parseInt(byte, 16));
}

test("reads the traces that the format's page shows", () => {
  const { dimension, frames } = readBoxes(bytesOf(trace), "a.btrace");
  assert.equal(dimension, 2);
  assert.deepEqual(frames.map((frame) => rows(frame, 4)), [
    [[0, 0, 1, 1], absent, [2, 0.5, 4, 3]],
    [[0.25, 0, 1.25, 1], absent, absent],
  ]);
  const second = readBoxes(bytesOf(traceWithPairs), "b.btrace");
  assert.deepEqual(rows(second.frames[1]!, 4)[1], [2, 0, 3, 1]);
});

test("gives the frames before the one in which a trace was cut off, and refuses a wrong bit", () => {
  const bytes = bytesOf(trace);
  assert.equal(readBoxes(bytes.subarray(0, bytes.length - 7), "a.btrace").frames.length, 1);
  bytes[bytes.length - 12]! ^= 1;
  assert.throws(() => readBoxes(bytes, "a.btrace"), /^Error: a\.btrace: byte \d+: the checksum of a frame is 0x7137f2ec; expected 0x/);
});

test("reads the commonest columns of CSV", () => {
  const expected = [[0, 0, 2, 4], [1, 1, 3, 3]];
  for (const text of [
    "0,0,2,4\n1,1,3,3\n",
    "name;max_y;min_x;min_y;max_x\na;4;0;0;2\n\nb;3;1;1;3\n",
    "# boxes\nx0 y0 x1 y1\n0 0 2 4\n1 1 3 3",
    "cx,cy,width,height\n1,2,2,4\n2,2,2,2\n",
    "x,y,half_width,half_height\n1,2,1,2\n2,2,1,1",
    "left,top,width,height\r\n0,0,2,4\r\n1,1,2,2",
    "\uFEFFWest,South,East,North\n0,0,2,4\n1,1,3,3",
  ]) assert.deepEqual(rows(read(text).frames[0]!, 4), expected, text);
  assert.equal(read("min_x,min_y,min_z,max_x,max_y,max_z\n0,0,0,1,1,1").dimension, 3);
  assert.deepEqual(rows(read("lon,lat\n6.5,50\n").frames[0]!, 4), [[6.5, 50, 6.5, 50]]);
  assert.deepEqual(rows(read("x,y,radius\n6,50,2\n").frames[0]!, 4), [[4, 48, 8, 52]]);
});

test("reads the motion of CSV: changes, and tracks", () => {
  const { frames } = read("frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n0,1,5,5,6,6\n1,0,0.5,0,1.5,1\n2,,,,,\n3,1,,,,\n");
  assert.deepEqual(frames.map((frame) => rows(frame, 4)), [
    [[0, 0, 1, 1], [5, 5, 6, 6]], [[0.5, 0, 1.5, 1], [5, 5, 6, 6]], [[0.5, 0, 1.5, 1], [5, 5, 6, 6]],
    [[0.5, 0, 1.5, 1], absent],
  ]);
  const tracks = read("frame,id,bb_left,bb_top,bb_width,bb_height\n1,7,10,10,4,4\n2,7,11,10,4,4\n2,bus,30,5,9,6\n4,bus,31,5,9,6\n");
  assert.deepEqual(tracks.frames.map((frame) => rows(frame, 4)), [
    [[10, 10, 14, 14], absent], [[11, 10, 15, 14], [30, 5, 39, 11]], [absent, [31, 5, 40, 11]],
  ]);
});

test("says what is wrong with a table, and where", () => {
  assert.throws(() => read("min_x,min_y,max_x,max_y\n0,0,1,one\n"), /boxes\.csv: line 2, column "maxy": "one" is no number/);
  assert.throws(() => read("min_x,min_y,max_x,max_y\n2,0,1,1\n"), /line 2: the box's minimum 2 on x is above its maximum 1/);
  assert.throws(() => read("name,colour\na,red\n"), /the columns name, colour name no boxes/);
  assert.throws(() => read("1,2,3\n"), /3 columns without names; expected 4/);
});

test("reads PLY as text and in binary of both byte orders: a box for a triangle", () => {
  const header = (format: string): string => `ply\nformat ${format} 1.0\ncomment a square\nelement vertex 4\n` +
    "property float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const corners = [[0, 0, 0], [1, 0, 0], [1, 1, 2], [0, 1, 0]];
  const expected = [[0, 0, 0, 1, 1, 2], [0, 0, 0, 1, 1, 2]];
  const text = header("ascii") + corners.map((one) => one.join(" ")).join("\n") + "\n4 0 1 2 3\n";
  assert.deepEqual(rows(readBoxes(utf8(text), "a.ply").frames[0]!, 6), expected);
  for (const little of [true, false]) {
    const body = new DataView(new ArrayBuffer(4 * 12 + 17));
    corners.flat().forEach((value, at) => body.setFloat32(4 * at, value, little));
    body.setUint8(48, 4);
    [0, 1, 2, 3].forEach((corner, at) => body.setInt32(49 + 4 * at, corner, little));
    const bytes = new Uint8Array([...utf8(header(little ? "binary_little_endian" : "binary_big_endian")), ...new Uint8Array(body.buffer)]);
    assert.deepEqual(rows(readBoxes(bytes, "a.ply").frames[0]!, 6), expected);
    assert.throws(() => readBoxes(bytes.subarray(0, bytes.length - 2), "a.ply"), /the mesh ends before its header says/);
  }
});

test("reads GeoJSON: a box for a feature, absent without points", () => {
  const map = {
    type: "FeatureCollection",
    features: [
      { type: "Feature", geometry: { type: "LineString", coordinates: [[1, 2, 9], [3, 1]] } },
      { type: "Feature", geometry: null },
      { type: "Feature", geometry: { type: "GeometryCollection", geometries: [
        { type: "Point", coordinates: [5, 5] }, { type: "MultiPolygon", coordinates: [[[[6, 6], [7, 6], [7, 8], [6, 6]]]] }] } },
    ],
  };
  const { frames } = readBoxes(utf8(JSON.stringify(map)), "a.geojson");
  assert.deepEqual(rows(frames[0]!, 4), [[1, 1, 3, 2], absent, [5, 5, 7, 8]]);
  assert.throws(() => readBoxes(utf8('{"type": "Topology"}'), "a.json"), /"type" is "Topology"; expected a FeatureCollection/);
});

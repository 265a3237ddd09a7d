// Files in each format that the page accepts, read by the engine with the program's readers.
import assert from "node:assert/strict";
import { test } from "node:test";

import { loadEngine } from "../engine/engine.ts";
import { withoutOptions } from "../state/advice.ts";

const engine = await loadEngine();

/** The example of docs/trace-format.md. */
const trace = `
  89 42 54 52 0d 0a 1a 0a 01 00 00 00 02 04 00 00 a1 79 96 6c
  46 52 41 4d 03 00 00 00 01 00 00 00 02 00 00 00 70 e9 81 be 01 00 00 00
  00 00 00 00 00 00 00 00 00 00 00 00 00 00 80 3f 00 00 80 3f
  02 00 00 00 00 00 00 40 00 00 00 3f 00 00 80 40 00 00 40 40 98 da 17 70
  46 52 41 4d 03 00 00 00 01 00 00 00 01 00 00 00 9f 61 07 5b 02 00 00 00
  00 00 00 00 00 00 80 3e 00 00 00 00 00 00 a0 3f 00 00 80 3f ec f2 37 71`;

function bytesOf(hex: string): Uint8Array {
  return Uint8Array.from(hex.trim().split(/\s+/), (byte) => Number.parseInt(byte, 16));
}

function read(text: string | Uint8Array, name = "a file", columns = ""): { frames: number[][][]; warning: string } {
  const { dimension, frames, warning } =
    engine.read(name, typeof text === "string" ? new TextEncoder().encode(text) : text, columns);
  const stride = 2 * dimension;
  const boxes = (frame: Float32Array): number[][] =>
    Array.from({ length: frame.length / stride }, (_, at) => [...frame.subarray(stride * at, stride * at + stride)]);
  return { frames: frames.map(boxes), warning };
}

const absent = [Infinity, Infinity, -Infinity, -Infinity];

test("reads the trace that the format's page shows, and says where one was cut off", () => {
  const expected = [
    [[0, 0, 1, 1], absent, [2, 0.5, 4, 3]],
    [[0.25, 0, 1.25, 1], absent, absent],
  ];
  const bytes = bytesOf(trace);
  assert.deepEqual(read(bytes).frames, expected);
  const cut = read(bytes.subarray(0, bytes.length - 7));
  assert.deepEqual(cut.frames, expected.slice(0, 1));
  assert.match(cut.warning, /is cut off in frame 1/);
  bytes[bytes.length - 12]! ^= 1;
  assert.throws(() => read(bytes, "a.btrace"), /a\.btrace: frame 1, byte \d+: checksum/);
});

test("reads tables, with motion and with numbers of any kind", () => {
  assert.deepEqual(read("name;max_y;min_x;min_y;max_x\na;4;0;0;2\n\nb;3e0;1;+1;3\n").frames,
    [[[0, 0, 2, 4], [1, 1, 3, 3]]]);
  assert.deepEqual(read("cx,cy,width,height\n1,2,2,4\n").frames, [[[0, 0, 2, 4]]]);
  assert.deepEqual(read("frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n1,0,0.5,0,1.5,inf\n2,0,,,,\n").frames,
    [[[0, 0, 1, 1]], [[0.5, 0, 1.5, Infinity]], [absent]]);
  assert.match(read("0.1,0,1,1\n").warning, /read as min_x,min_y,max_x,max_y/);
});

test("says what is wrong with a table as the program does", () => {
  assert.throws(() => read("min_x,min_y,max_x,max_y\n0,0,1,one\n", "a.csv"),
    /^Error: a\.csv:2: column max_y is 'one', text; expected a number/);
  assert.throws(() => read("0,0,10,10\n12,12,6,4\n", "a.csv"), /say --columns=x,y,w,h/);
  assert.throws(() => read("name,colour\na,red\n", "a.csv"), /a\.csv:1: 'name,colour': no columns that give bounds/);
});

test("what the program's options would say is offered as columns, with which the file can be read", () => {
  const adviceFor = (text: string): { text: string; ways: string[] } => {
    try {
      return withoutOptions(read(text, "a.csv").warning);
    } catch (error) {
      return withoutOptions((error as Error).message);
    }
  };
  const table = "x,y,width,height\n1,2,4,6\n";
  const { text, ways } = adviceFor(table);
  assert.equal(text, "a.csv:1: 'x,y,width,height': column 'x' may be a minimum or a centre. But the one row is valid as this:");
  assert.deepEqual(ways.map((columns) => read(table, "a.csv", columns).frames), [[[[1, 2, 5, 8]]], [[[-1, -1, 3, 5]]]]);
  assert.deepEqual(adviceFor("0,0,10,10\n12,12,6,4\n").ways, ["x,y,w,h"]);
  assert.deepEqual(adviceFor("0,0,10,10\n").ways, ["x,y,w,h"]);
  for (const other of ["name,colour\na,red\n", "1,2,3\n", "bbox\n\"0,0,9,9\"\n", "min_x,min_y,max_x,max_y\n3,3,1,1\n"])
    assert.doesNotMatch(adviceFor(other).text, /--/);
});

test("a JSON file that is no map is no table either", () => {
  assert.throws(() => read('[{"x":1,"w":2}]', "club.json"), /club\.json: an array; expected an object of GeoJSON, COCO or/);
});

test("names what the page does not read", () => {
  assert.throws(() => read(Uint8Array.from([0x1f, 0x8b, 0, 0]), "a.gz"), /a\.gz: is compressed by gzip; expected CSV, a/);
  assert.throws(() => read("solid thing\n", "a.stl"), /a\.stl: is a mesh in stl; expected CSV/);
  assert.throws(() => read("SQLite format 3\0", "a.gpkg"), /a\.gpkg: is a GeoPackage .*ogr2ogr/);
});

test("reads meshes and maps", () => {
  const ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 2.5\n3 0 1 2\n";
  assert.deepEqual(read(ply).frames, [[[0, 0, 0, 1, 1, 2.5]]]);
  assert.deepEqual(read("v 0 0 0\nv 1 0 0\nv 0 1 2\nf 1 2 3\n").frames, [[[0, 0, 0, 1, 1, 2]]]);
  const map = {
    type: "FeatureCollection",
    features: [
      { type: "Feature", geometry: { type: "LineString", coordinates: [[1, 2, 9], [3, 1]] } },
      { type: "Feature", geometry: null },
    ],
  };
  assert.deepEqual(read(JSON.stringify(map)).frames, [[[1, 1, 3, 2], absent]]);
  assert.throws(() => read('{"type": "Topology"}', "a.json"), /a\.json: is TopoJSON.*topo2geo/);
});

// A file of boxes, recognised by its first bytes.
import type { Recorded } from "../scene/frames.ts";
import { readCsv } from "./csv.ts";
import { readGeojson } from "./geojson.ts";
import { readPly } from "./ply.ts";
import { FileProblem } from "./problem.ts";
import { readTrace, traceMagic } from "./trace.ts";

export function readBoxes(bytes: Uint8Array, name: string): Recorded {
  try {
    if (traceMagic.every((byte, at) => bytes[at] === byte)) return readTrace(bytes);
    if (/^ply\r?\n/.test(new TextDecoder("latin1").decode(bytes.subarray(0, 5)))) return readPly(bytes);
    if (bytes[0] === 0x1f && bytes[1] === 0x8b)
      throw new FileProblem("the file is compressed by gzip; decompress it, or give it to the program");
    const text = new TextDecoder().decode(bytes);
    return /^\s*[{[]/.test(text) ? readGeojson(text) : readCsv(text);
  } catch (error) {
    if (error instanceof FileProblem) throw new FileProblem(`${name}: ${error.message}`);
    throw error;
  }
}

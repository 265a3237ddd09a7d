// GeoJSON: a box around each feature; absent where it has no points.
import type { Recorded } from "../scene/frames.ts";
import { checkCount, FileProblem } from "./problem.ts";

interface Node {
  type?: unknown;
  features?: unknown;
  geometry?: unknown;
  geometries?: unknown;
  coordinates?: unknown;
}

const mostDepth = 32;

/** Widens a box by all positions within. */
function widen(box: number[], value: unknown, depth: number): void {
  if (depth > mostDepth) throw new FileProblem(`coordinates nested more than ${mostDepth} deep`);
  if (!Array.isArray(value)) return;
  const [x, y] = value as unknown[];
  if (typeof x === "number" && typeof y === "number") {
    box[0] = Math.min(box[0]!, x);
    box[1] = Math.min(box[1]!, y);
    box[2] = Math.max(box[2]!, x);
    box[3] = Math.max(box[3]!, y);
  } else for (const one of value) widen(box, one, depth + 1);
}

function around(geometry: Node | null | undefined, box: number[], depth = 0): number[] {
  if (depth > mostDepth) throw new FileProblem(`collections nested more than ${mostDepth} deep`);
  if (geometry === null || geometry === undefined) return box;
  widen(box, geometry.coordinates, 0);
  if (Array.isArray(geometry.geometries)) for (const one of geometry.geometries) around(one as Node, box, depth + 1);
  return box;
}

const empty = (): number[] => [Infinity, Infinity, -Infinity, -Infinity];

export function readGeojson(text: string): Recorded {
  let root: Node;
  try {
    root = JSON.parse(text) as Node;
  } catch (error) {
    throw new FileProblem(`the file is no JSON: ${error instanceof Error ? error.message : String(error)}`);
  }
  let boxes: number[][];
  if (root.type === "FeatureCollection" && Array.isArray(root.features))
    boxes = root.features.map((feature: Node) => around(feature.geometry as Node, empty()));
  else if (root.type === "Feature") boxes = [around(root.geometry as Node, empty())];
  else if (root.type === "GeometryCollection" && Array.isArray(root.geometries))
    boxes = root.geometries.map((geometry: Node) => around(geometry, empty()));
  else if (Array.isArray(root.coordinates)) boxes = [around(root, empty())];
  else {
    throw new FileProblem(`"type" is ${JSON.stringify(root.type)}; expected a FeatureCollection, a Feature or a geometry ` +
      "of GeoJSON (TopoJSON is read by the program)");
  }
  if (boxes.length === 0) throw new FileProblem("the map has no features");
  checkCount(boxes.length);
  return { dimension: 2, frames: [Float32Array.from(boxes.flat())] };
}

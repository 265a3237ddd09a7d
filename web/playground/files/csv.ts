// Boxes as text: the commonest of the columns that the program reads (docs/formats.md), and frames of them.
import type { Dimension } from "../scene/scene.ts";
import type { Recorded } from "../scene/frames.ts";
import { checkCount, FileProblem } from "./problem.ts";

type Field = (row: readonly string[], line: number) => number;

const axisNames = ["x", "y", "z"] as const;

/** Names for the bounds of each axis; in the order of the axes. */
const words: Record<"min" | "max" | "size" | "centre" | "half", readonly string[][]> = {
  min: [["left", "west"], ["bottom", "south"], []],
  max: [["right", "east"], ["top", "north"], []],
  size: [["width", "w"], ["height", "h"], ["depth", "d"]],
  centre: [[], [], []],
  half: [["halfwidth"], ["halfheight"], ["halfdepth"]],
};

const patterns: Record<keyof typeof words, readonly string[]> = {
  min: ["min#", "#min", "lower#", "low#", "lo#", "minimum#", "#0"],
  max: ["max#", "#max", "upper#", "high#", "hi#", "maximum#", "#1"],
  size: ["size#", "length#", "d#"],
  centre: ["center#", "centre#", "mid#", "c#"],
  half: ["half#", "halfsize#", "halfextent#", "h#"],
};

function cells(line: string, separator: string | undefined): string[] {
  const parts: string[] = [];
  if (separator === undefined) return line.trim().split(/\s+/);
  let [part, quoted] = ["", false];
  for (const letter of line) {
    if (letter === '"') quoted = !quoted;
    else if (letter === separator && !quoted) {
      parts.push(part);
      part = "";
    } else part += letter;
  }
  return [...parts, part].map((one) => one.trim());
}

function separatorOf(line: string): string | undefined {
  return [";", ",", "\t"].find((one) => line.includes(one));
}

function plain(name: string): string {
  return name.toLowerCase().replace(/[\s_.-]/g, "").replace(/^bb(ox)?(?=left|top|width|height|right|bottom)/, "");
}

/** Columns by name, as fields that give minima and maxima. */
class Columns {
  private readonly names: string[];

  constructor(names: readonly string[]) {
    this.names = names.map(plain);
  }

  find(...wanted: readonly string[]): number {
    for (const name of wanted) {
      const at = this.names.indexOf(name);
      if (at >= 0) return at;
    }
    return -1;
  }

  field(of: keyof typeof words, axis: number): Field | undefined {
    const letter = axisNames[axis]!;
    const at = this.find(...patterns[of].map((one) => one.replace("#", letter)), ...words[of][axis]!);
    return at < 0 ? undefined : numberAt(at, this.names[at]!);
  }

  /** Minimum and maximum on an axis; undefined where its columns are not there. */
  bounds(axis: number): [Field, Field] | undefined {
    const [min, max] = [this.field("min", axis), this.field("max", axis)];
    if (min !== undefined && max !== undefined) return [min, max];
    const [centre, half, size] = [this.field("centre", axis), this.field("half", axis), this.field("size", axis)];
    // Beside half a size, "x" alone is a centre; beside a size it might be a corner.
    const plainCentre = centre ?? this.point(axis);
    if (plainCentre !== undefined && half !== undefined) return around(plainCentre, half, 1);
    if (centre !== undefined && size !== undefined) return around(centre, size, 0.5);
    if (min !== undefined && size !== undefined) return [min, (row, line) => min(row, line) + size(row, line)];
    // On a screen y grows downwards, and the top is where a box begins.
    if (axis === 1 && max !== undefined && size !== undefined && this.find("top") >= 0)
      return [max, (row, line) => max(row, line) + size(row, line)];
    const radius = this.find("radius", "r");
    if (radius < 0) return undefined;
    return plainCentre === undefined ? undefined : around(plainCentre, numberAt(radius, "radius"), 1);
  }

  point(axis: number): Field | undefined {
    const at = this.find(axisNames[axis]!, ...(axis === 0 ? ["lon", "longitude", "lng"] : axis === 1 ? ["lat", "latitude"] : []));
    return at < 0 ? undefined : numberAt(at, this.names[at]!);
  }
}

function around(centre: Field, reach: Field, factor: number): [Field, Field] {
  return [
    (row, line) => centre(row, line) - factor * reach(row, line),
    (row, line) => centre(row, line) + factor * reach(row, line),
  ];
}

function numberAt(at: number, name: string): Field {
  return (row, line) => {
    const text = row[at] ?? "";
    const value = /^[+-]?inf(inity)?$/i.test(text) ? (text.startsWith("-") ? -Infinity : Infinity) : Number(text);
    if (text === "" || Number.isNaN(value))
      throw new FileProblem(`line ${line}, column "${name}": "${text}" is no number`);
    return value;
  };
}

interface Layout {
  bounds: [Field, Field][];
  frame: Field | undefined;
  /** The column of the box's number, or of its track's id. */
  box: number;
  tracks: boolean;
}

function layoutOf(header: readonly string[]): Layout {
  const columns = new Columns(header);
  const bounds = [0, 1, 2].map((axis) => columns.bounds(axis));
  const frame = columns.find("frame");
  const box = columns.find("box");
  const track = box >= 0 ? box : columns.find("trackid", "track", "objectid", "object", "id");
  const motion = {
    frame: frame < 0 || track < 0 ? undefined : numberAt(frame, "frame"), box: track, tracks: box < 0,
  };
  if (bounds[0] !== undefined && bounds[1] !== undefined)
    return { bounds: bounds.filter((one) => one !== undefined) as [Field, Field][], ...motion };
  const points = [0, 1, 2].map((axis) => columns.point(axis));
  if (points[0] === undefined || points[1] === undefined) {
    throw new FileProblem(`the columns ${header.join(", ")} name no boxes; ` +
      "expected min_x, min_y, max_x, max_y, or x and y with sizes, for example");
  }
  return { bounds: points.flatMap((one) => one === undefined ? [] : [[one, one] as [Field, Field]]), ...motion };
}

/** Columns without names. */
function layoutWithout(columns: number): Layout {
  if (columns !== 4 && columns !== 6)
    throw new FileProblem(`${columns} columns without names; expected 4 (min_x, min_y, max_x, max_y) or 6`);
  const half = columns / 2;
  const names = ["min_x", "min_y", "min_z"].slice(0, half).concat(["max_x", "max_y", "max_z"].slice(0, half));
  return {
    bounds: Array.from({ length: half }, (_, axis) =>
      [numberAt(axis, names[axis]!), numberAt(half + axis, names[half + axis]!)]),
    frame: undefined, box: -1, tracks: false,
  };
}

export function readCsv(text: string): Recorded {
  const lines = text.replace(/^\uFEFF/, "").split(/\r\n|\r|\n/);
  let first = lines.findIndex((line) => line.trim() !== "" && !line.startsWith("#"));
  if (first < 0) throw new FileProblem("the file holds no table");
  const separator = separatorOf(lines[first]!);
  const header = cells(lines[first]!, separator);
  const named = header.some((one) => one !== "" && Number.isNaN(Number(one)) && !/^[+-]?inf/i.test(one));
  const layout = named ? layoutOf(header) : layoutWithout(header.length);
  if (named) ++first;
  const dimension = layout.bounds.length as Dimension;
  const rows = new Map<number, { box: string; numbers: number[] }[]>();
  let count = 0;
  for (let at = first; at < lines.length; ++at) {
    if (lines[at]!.trim() === "" || lines[at]!.startsWith("#")) continue;
    const row = cells(lines[at]!, separator);
    const frame = layout.frame?.(row, at + 1) ?? 0;
    const box = layout.frame === undefined ? String(count) : row[layout.box] ?? "";
    const list = rows.get(frame) ?? [];
    rows.set(frame, list);
    // A frame in which nothing happens.
    if (layout.frame !== undefined && box === "") continue;
    list.push({ box, numbers: boxOf(row, layout, dimension, at + 1) });
    checkCount(++count);
  }
  if (count === 0) throw new FileProblem("the table has no rows");
  return { dimension, frames: framesOf(rows, layout, dimension) };
}

function boxOf(row: readonly string[], { bounds }: Layout, dimension: number, line: number): number[] {
  // All fields of bounds are empty: an absent box.
  if (row.filter((one) => one !== "").length <= 2 && row.length > 3)
    return [...Array<number>(dimension).fill(Infinity), ...Array<number>(dimension).fill(-Infinity)];
  const numbers = [...bounds.map(([min]) => min(row, line)), ...bounds.map(([, max]) => max(row, line))];
  for (let axis = 0; axis < dimension; ++axis) {
    if (numbers[axis]! > numbers[dimension + axis]! && numbers[axis] !== Infinity)
      throw new FileProblem(`line ${line}: the box's minimum ${numbers[axis]} on ${axisNames[axis]} is above its maximum ${numbers[dimension + axis]}`);
  }
  return numbers;
}

/** Frames of what changes, or, of tracks, frames of all that is there. */
function framesOf(rows: ReadonlyMap<number, { box: string; numbers: number[] }[]>, { tracks }: Layout,
                  dimension: Dimension): Float32Array<ArrayBuffer>[] {
  const stride = 2 * dimension;
  const places = new Map<string, number>();
  const order = [...rows.keys()].sort((a, b) => a - b);
  for (const frame of order) {
    for (const { box } of rows.get(frame)!) {
      if (!places.has(box)) places.set(box, places.size);
    }
  }
  const absent = [...Array<number>(dimension).fill(Infinity), ...Array<number>(dimension).fill(-Infinity)];
  const empty = (): Float32Array<ArrayBuffer> => {
    const boxes = new Float32Array(places.size * stride);
    for (let at = 0; at < boxes.length; at += stride) boxes.set(absent, at);
    return boxes;
  };
  let boxes = empty();
  const numbers = tracks || order.length === 1
    ? order : Array.from({ length: order[order.length - 1]! - order[0]! + 1 }, (_, at) => order[0]! + at);
  return numbers.map((frame) => {
    boxes = tracks ? empty() : boxes.slice();
    for (const row of rows.get(frame) ?? []) boxes.set(row.numbers, stride * places.get(row.box)!);
    return boxes;
  });
}

// Algorithms 7 to 10 of the draft, mended, step by step. The rules of
// paper/listings/quadtree_listing.cpp limit the depth.
import type { QuadtreeNode, QuadtreeState, StepOptions, Steps, World } from "../engine/types.ts";
import { isPresent, presentIds, reportPoint, worldAround, type Box } from "./boxes.ts";
import { Listing } from "./listing.ts";
import { Recorder } from "./recorder.ts";
import { Versions } from "./versions.ts";

type Line = "add" | "down" | "store" | "full" | "split" | "move" | "empty" | "quadrant" | "traverse" | "leaf";

const listing = new Listing<Line | "test" | "report">([
  ["add", "function Add Element(e)"],
  ["", "  if QI != nil then"],
  ["down", "    Spanning Add Element(e)"],
  ["", "  else"],
  ["store", "    E.Add(e)"],
  ["full", "    if Count + 1 > Count Max and a split may help then"],
  ["", "      Split; Count <- 0"],
  ["", "    else"],
  ["", "      Count <- Count + 1"],
  ["", "    end if"],
  ["", "  end if"],
  ["", "end function"],
  ["", ""],
  ["", "function Split"],
  ["split", "  QI, QII, QIII, QIV <- new nodes half as wide and high"],
  ["", "  for i = 0 to E.length - 1 do"],
  ["move", "    Spanning Add Element(E[i])"],
  ["", "  end for"],
  ["empty", "  E <- empty"],
  ["", "end function"],
  ["", ""],
  ["", "function Spanning Add Element(e)"],
  ["quadrant", "  add e to each of QI, QII, QIII, QIV that it touches"],
  ["", "end function"],
  ["", ""],
  ["traverse", "function Traverse(q)"],
  ["", "  Traverse QI, QII, QIII and QIV of q, if there are any"],
  ["leaf", "  Brute Force(E)"],
  ["", "end function"],
  ["", ""],
  ["", "function Brute Force(E)"],
  ["", "  for i = 0 to E.length - 1 do"],
  ["", "    for j = i + 1 to E.length - 1 do"],
  ["test", "      if Test Collide(E[i], E[j]) then"],
  ["report", "        if this leaf holds their greater MINX and MINY then report E[i] and E[j]"],
  ["", "      end if"],
  ["", "    end for"],
  ["", "  end for"],
  ["", "end function"],
]);

const quadrants = ["QI", "QII", "QIII", "QIV"] as const;

/** The side of the origin on which each quadrant lies; y grows downwards. */
const sides = [[1, -1], [-1, -1], [-1, 1], [1, 1]] as const;

const deepest = 48;
const referencesOfBox = 16;

/** The region of a leaf: begin <= x < end on both axes; unbounded at the world's border. */
interface Region {
  begin: readonly [number, number];
  end: readonly [number, number];
}

function holds({ begin, end }: Region, [x, y]: readonly [number, number]): boolean {
  return begin[0] <= x && begin[1] <= y && (x < end[0] || end[0] === Infinity) && (y < end[1] || end[1] === Infinity);
}

/** The greatest depth at which leaves cannot hold more than 16 references per box. */
function chosenDepth(boxes: readonly Box[], world: World): number {
  const referencesAt = (depth: number, box: Box): number => {
    const nodes = 2 ** depth;
    const node = (x: number, begin: number, length: number): number =>
      Math.min(Math.max(Math.floor((x - begin) / length * nodes), 0), nodes - 1);
    return (node(box.maxX, world.left, world.width) - node(box.minX, world.left, world.width) + 1) *
      (node(box.maxY, world.top, world.height) - node(box.minY, world.top, world.height) + 1);
  };
  let fits = 0;
  let beyond = deepest + 1;
  while (beyond - fits > 1) {
    const depth = Math.floor((fits + beyond) / 2);
    const references = boxes.reduce((sum, box) => sum + referencesAt(depth, box), 0);
    if (references <= referencesOfBox * boxes.length) fits = depth;
    else beyond = depth;
  }
  return fits;
}

class Quadtree {
  readonly #recorder = new Recorder<Line, QuadtreeState>(listing);
  readonly #boxes: readonly Box[];
  readonly #world: World;
  readonly #capacity: number;
  readonly #depthMax: number;
  readonly #regions: Region[];
  readonly #nodes = new Versions<QuadtreeNode>();

  constructor(boxes: readonly Box[], capacity: number) {
    this.#boxes = boxes;
    this.#capacity = capacity;
    const present = boxes.filter(isPresent);
    const world = worldAround(present);
    this.#world = world;
    this.#depthMax = chosenDepth(present, world);
    this.#regions = [{ begin: [-Infinity, -Infinity], end: [Infinity, Infinity] }];
    this.#nodes.set(0, {
      depth: 0,
      parent: -1,
      box: [world.left, world.top, world.left + world.width, world.top + world.height],
      origin: [world.left + world.width * 0.5, world.top + world.height * 0.5],
      boxes: [],
      count: 0,
    });
  }

  search(): Steps {
    for (const id of presentIds(this.#boxes)) this.#addElement(0, id);
    this.#traverse(0);
    return this.#recorder.finish();
  }

  /** Algorithm 7. */
  #addElement(node: number, e: number): void {
    this.#step("add", `Box ${e} comes to ${this.#nameOf(node)}`, [e], node);
    if (this.#node(node).children !== undefined) return this.#spanningAddElement(node, e, "down");
    const { boxes, count } = this.#node(node);
    this.#set(node, { boxes: [...boxes, e] });
    this.#step("store", `It is a leaf, and now holds ${boxes.length + 1}`, [e], node);
    const isFull = count + 1 > this.#capacity;
    if (isFull && this.#canSplit(node)) {
      this.#step("full", `More than ${this.#capacity}: it splits`, [...this.#node(node).boxes], node);
      this.#split(node);
      this.#set(node, { count: 0 });
      return;
    }
    if (isFull)
      this.#step("full", `More than ${this.#capacity}, but a split would not part them`, [...boxes, e], node);
    this.#set(node, { count: count + 1 });
  }

  /** Algorithm 8. */
  #split(node: number): void {
    const { box, depth, origin, boxes } = this.#node(node);
    const region = this.#regions[node]!;
    const [width, height] = [(box[2] - box[0]) * 0.5, (box[3] - box[1]) * 0.5];
    const half = this.#halfExtent(depth + 1);
    const children = sides.map(([xSide, ySide]) => {
      const center = [origin[0] + xSide * half[0], origin[1] + ySide * half[1]] as const;
      this.#regions.push({
        begin: [xSide < 0 ? region.begin[0] : origin[0], ySide < 0 ? region.begin[1] : origin[1]],
        end: [xSide < 0 ? origin[0] : region.end[0], ySide < 0 ? origin[1] : region.end[1]],
      });
      const left = xSide < 0 ? box[0] : box[0] + width;
      const top = ySide < 0 ? box[1] : box[1] + height;
      const child: QuadtreeNode =
        { depth: depth + 1, parent: node, box: [left, top, left + width, top + height], origin: center, boxes: [], count: 0 };
      const place = this.#nodes.items.length;
      this.#nodes.set(place, child);
      return place;
    });
    this.#set(node, { children: children as unknown as [number, number, number, number] });
    this.#step("split", `${this.#nameOf(node)} gets four subnodes`, [...boxes], node);
    for (const e of boxes) this.#spanningAddElement(node, e, "move");
    this.#set(node, { boxes: [] });
    this.#step("empty", `${this.#nameOf(node)} is emptied: its boxes are in the subnodes`, [], node);
  }

  /** Algorithm 9. */
  #spanningAddElement(node: number, e: number, from: "down" | "move"): void {
    const { origin: [x, y], children } = this.#node(node);
    const box = this.#boxes[e]!;
    const [right, left, above, below] = [box.maxX >= x, box.minX < x, box.minY < y, box.maxY >= y];
    const touched = [right && above, left && above, left && below, right && below];
    const names = quadrants.filter((_, quadrant) => touched[quadrant]);
    this.#step(from, `Box ${e} goes on to ${names.join(", ")}`, [e], node);
    for (const [quadrant, isTouched] of touched.entries()) {
      if (!isTouched) continue;
      this.#step("quadrant", `Box ${e} touches ${quadrants[quadrant]!}`, [e], node);
      this.#addElement(children![quadrant]!, e);
    }
  }

  /** Algorithm 10. */
  #traverse(node: number): void {
    const { children, boxes: e } = this.#node(node);
    this.#step("traverse", `${this.#nameOf(node)} is ${children === undefined ? "a leaf" : "split"}`, [...e], node);
    for (const child of children ?? []) this.#traverse(child);
    if (children !== undefined) return;
    this.#step("leaf", `The leaf has ${e.length} ${e.length === 1 ? "box" : "boxes"}`, [...e], node);
    const state = this.#state(node);
    for (let i = 0; i < e.length; ++i) {
      for (let j = i + 1; j < e.length; ++j) {
        const [a, b] = [e[i]!, e[j]!];
        const point = reportPoint(this.#boxes[a]!, this.#boxes[b]!);
        const refusal = (): string | undefined => holds(this.#regions[node]!, point) ? undefined :
          `Boxes ${a} and ${b} overlap, but the leaf that holds the point reports their pair`;
        this.#recorder.test(this.#boxes, a, b, state, refusal, this.#state(node, { point }));
      }
    }
  }

  /** False if all boxes share a point: some child would get all of them. */
  #canSplit(node: number): boolean {
    const { depth, boxes: ids } = this.#node(node);
    if (depth === this.#depthMax) return false;
    const boxes = ids.map((id) => this.#boxes[id]!);
    const minOf = (side: (box: Box) => number): number => boxes.reduce((min, box) => Math.min(min, side(box)), Infinity);
    const common = {
      minX: -minOf((box) => -box.minX), minY: -minOf((box) => -box.minY),
      maxX: minOf((box) => box.maxX), maxY: minOf((box) => box.maxY),
    };
    return !isPresent(common);
  }

  /** Half the width and height of a node: halved level by level, as in C++. */
  #halfExtent(depth: number): [number, number] {
    return [this.#world.width * 0.5 ** (depth + 1), this.#world.height * 0.5 ** (depth + 1)];
  }

  #nameOf(node: number): string {
    const { parent } = this.#node(node);
    if (parent < 0) return "the root";
    const quadrant = quadrants[this.#node(parent).children?.indexOf(node) ?? 0];
    return parent === 0 ? `${quadrant} of the root` : `${quadrant} of a node on level ${this.#node(parent).depth}`;
  }

  #node(node: number): QuadtreeNode {
    return this.#nodes.items[node]!;
  }

  #set(node: number, change: Partial<QuadtreeNode>): void {
    this.#nodes.set(node, { ...this.#node(node), ...change });
  }

  #state(current: number, more: Partial<QuadtreeState> = {}): QuadtreeState {
    const nodes = this.#nodes;
    const version = nodes.latest;
    return {
      kind: "quadtree", world: this.#world, capacity: this.#capacity, current, ...more,
      get nodes() { return nodes.at(version); },
    };
  }

  #step(line: Line, text: string, boxes: number[], node: number): void {
    this.#recorder.step(line, text.charAt(0).toUpperCase() + text.slice(1), boxes, this.#state(node));
  }
}

export function quadtreeSteps(boxes: readonly Box[], { capacity = 8 }: StepOptions): Steps {
  if (!Number.isInteger(capacity) || capacity < 1)
    throw new Error(`capacity is ${capacity}; expected a whole number of at least 1`);
  if (!boxes.some(isPresent)) return { listing: listing.lines, steps: [], pairs: [], tests: 0 };
  return new Quadtree(boxes, capacity).search();
}

// A bounding volume hierarchy step by step: packed, then joined with itself. It is Algorithm 12 of
// the paper with leaves small enough to draw, and with pairs of nodes in place of its lists of nodes.
import type { BvhNode, BvhState, StepOptions, Steps } from "../engine/types.ts";
import { presentIds, type Box } from "./boxes.ts";
import { Listing } from "./listing.ts";
import { Recorder } from "./recorder.ts";

type Line = "build" | "sort" | "leaf" | "node" | "root" | "join" | "apart" | "leaves" | "down";

const listing = new Listing<Line | "test" | "report">([
  ["build", "function Build(E)"],
  ["", "  sort E by MINX, and cut it into slabs"],
  ["sort", "  sort each slab by MINY, and cut it into leaves"],
  ["", "  for each leaf do"],
  ["leaf", "    leaf.Bounds <- bounds of its boxes"],
  ["", "  end for"],
  ["", "  while there are several nodes do"],
  ["node", "    give neighbours a parent, with the bounds of all of them"],
  ["", "  end while"],
  ["root", "  Join(root, root)"],
  ["", "end function"],
  ["", ""],
  ["join", "function Join(a, b)"],
  ["apart", "  if not Test Collide(a.Bounds, b.Bounds) then return"],
  ["", "  if a and b are leaves then"],
  ["leaves", "    for each box e of a, f of b (if a = b, after e) do"],
  ["test", "      if Test Collide(e, f) then"],
  ["report", "        report e and f"],
  ["", "      end if"],
  ["", "    end for"],
  ["", "  else"],
  ["down", "    for each child c of a, d of b (if a = b, from c on) do"],
  ["", "      Join(c, d)"],
  ["", "    end for"],
  ["", "  end if"],
  ["", "end function"],
]);

type Bounds = BvhNode["box"];

function around(all: readonly Bounds[]): Bounds {
  return all.reduce((a, b) =>
    [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])]);
}

function touch(a: Bounds, b: Bounds): boolean {
  return a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
}

/** Parts of up to `size` elements. */
function parts<T>(all: readonly T[], size: number): T[][] {
  return Array.from({ length: Math.ceil(all.length / size) }, (_, part) => all.slice(part * size, (part + 1) * size));
}

class Bvh {
  readonly #recorder = new Recorder<Line, BvhState>(listing);
  readonly #boxes: readonly Box[];
  readonly #size: number;
  #order: readonly number[] = [];
  #nodes: readonly BvhNode[] = [];

  constructor(boxes: readonly Box[], size: number) {
    this.#boxes = boxes;
    this.#size = size;
  }

  search(): Steps {
    const ids = presentIds(this.#boxes);
    this.#step("build", `E has ${ids.length} boxes`, ids, []);
    let level = this.#makeLeaves(ids);
    while (level.length > 1) level = parts(level, this.#size).map((children) => this.#makeParent(children));
    this.#step("root", "The tree is joined with itself, from its root on", [], level);
    this.#join(level[0]!, level[0]!);
    return this.#recorder.finish();
  }

  #makeLeaves(ids: readonly number[]): number[] {
    const sorted = (all: readonly number[], key: (box: Box) => number): number[] =>
      [...all].sort((a, b) => {
        const [x, y] = [key(this.#boxes[a]!), key(this.#boxes[b]!)];
        return x < y ? -1 : x > y ? 1 : a - b;
      });
    const leaves = Math.ceil(ids.length / this.#size);
    const slabs = parts(sorted(ids, (box) => box.minX), Math.ceil(leaves / Math.ceil(Math.sqrt(leaves))) * this.#size)
      .map((slab) => sorted(slab, (box) => box.minY));
    this.#order = slabs.flat();
    this.#step("sort", `${slabs.length} slabs, cut into leaves of up to ${this.#size} boxes`, [], []);
    return slabs.flatMap((slab) => parts(slab, this.#size)).map((boxes) => {
      const box = around(boxes.map((id) => {
        const { minX, minY, maxX, maxY } = this.#boxes[id]!;
        return [minX, minY, maxX, maxY] as const;
      }));
      return this.#add("leaf", { box, boxes, children: [] }, `The leaf ${this.#nodes.length} bounds the boxes ${boxes.join(", ")}`);
    });
  }

  #makeParent(children: readonly number[]): number {
    return this.#add("node", { box: around(children.map((child) => this.#nodes[child]!.box)), boxes: [], children },
                     `The node ${this.#nodes.length} bounds the nodes ${children.join(", ")}`);
  }

  #add(line: Line, node: BvhNode, text: string): number {
    const at = this.#nodes.length;
    this.#nodes = [...this.#nodes, node];
    this.#step(line, text, [...node.boxes], [at]);
    return at;
  }

  #join(a: number, b: number): void {
    const [first, second] = [this.#nodes[a]!, this.#nodes[b]!];
    const both = a === b ? [a] : [a, b];
    if (a !== b) {
      const meet = touch(first.box, second.box);
      this.#step("join", `The bounds of node ${a} are tested against those of node ${b}`, [], both);
      this.#step("apart", meet ? `They overlap: a box of ${a} may overlap one of ${b}` :
        `They are apart, so no box of ${a} overlaps one of ${b}`, [], both);
      if (!meet) return;
    }
    if (first.children.length > 0) {
      this.#step("down", a === b ? `The children of node ${a} are compared with each other` :
        `The children of node ${a} are compared with those of node ${b}`, [], both);
      first.children.forEach((c, at) => {
        for (const d of a === b ? first.children.slice(at) : second.children) this.#join(c, d);
      });
      return;
    }
    this.#step("leaves", a === b ? `The boxes of leaf ${a} are tested against each other` :
      `The boxes of leaf ${a} are tested against those of leaf ${b}`, [], both);
    first.boxes.forEach((e, at) => {
      for (const f of a === b ? first.boxes.slice(at + 1) : second.boxes)
        this.#recorder.test(this.#boxes, e, f, this.#state(both));
    });
  }

  #state(current: readonly number[]): BvhState {
    return { kind: "bvh", size: this.#size, order: this.#order, nodes: this.#nodes, current };
  }

  #step(line: Line, text: string, boxes: number[], current: readonly number[]): void {
    this.#recorder.step(line, text, boxes, this.#state(current));
  }
}

export function bvhSteps(boxes: readonly Box[], { capacity = 16 }: StepOptions): Steps {
  if (!Number.isInteger(capacity) || capacity < 2)
    throw new Error(`capacity is ${capacity}; expected a whole number of at least 2`);
  if (presentIds(boxes).length === 0) return { listing: listing.lines, steps: [], pairs: [], tests: 0 };
  return new Bvh(boxes, capacity).search();
}

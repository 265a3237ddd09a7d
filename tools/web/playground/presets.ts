// Scenes from real life that break algorithms: each names an algorithm and the reason, and a test
// verifies it.
//
// A scene is a function of the number of boxes, a seed and the time in seconds, so that time can be
// scrubbed and a link shows the same boxes to everyone.
import { bounce } from "./scene/motion.ts";
import { normalAt, randomAt } from "./scene/random.ts";

/** Positions of the playground's sliders for a preset, where they apply. */
export interface PresetSettings {
  count: number;
  ratio: number;       // size of the largest box over that of the smallest
  clustering: number;  // 0: evenly spread; 1: in one place
  moving: number;      // fraction of boxes that move
  speed: number;       // world widths per second, of a typical mover
  cell?: number;       // of the broken algorithm
  capacity?: number;
}

export interface Preset {
  name: string;
  summary: string;
  dimension: 2 | 3;
  count: number;  // initial number of boxes: settings.count
  /**
   * The broken algorithm: a spec of a search or, if `follows`, of a tracker that follows every
   * frame.
   */
  breaks: string;
  follows: boolean;
  why: string;
  settings: PresetSettings;
  boxes(count: number, seed: number, time: number): Float32Array<ArrayBuffer>;
}

/** The region in which most boxes stay. */
const size = [160, 100, 100] as const;

/** Writes one box: the centre and half the extent on each axis. */
type PlaceBox = (box: number, centre: number[], half: number[]) => void;

function packed(dimension: 2 | 3, count: number, place: PlaceBox): Float32Array<ArrayBuffer> {
  const boxes = new Float32Array(2 * dimension * count);
  for (let box = 0; box < count; ++box) {
    const centre = Array<number>(dimension).fill(0);
    const half = Array<number>(dimension).fill(0.5);
    place(box, centre, half);
    for (let axis = 0; axis < dimension; ++axis) {
      boxes[2 * dimension * box + axis] = centre[axis]! - half[axis]!;
      boxes[2 * dimension * box + dimension + axis] = centre[axis]! + half[axis]!;
    }
  }
  return boxes;
}

/** Half the extent at which `count` boxes of that size cover a given part of the world. */
function halfFor(count: number, dimension: 2 | 3, part: number): number {
  const volume = size.slice(0, dimension).reduce((product, side) => product * side, 1);
  return 0.5 * (part * volume / Math.max(1, count)) ** (1 / dimension);
}

/** A box that drifts through the world and bounces off its borders. */
function drift(seed: number, box: number, time: number, speed: number, centre: number[], half: readonly number[]): void {
  for (let axis = 0; axis < centre.length; ++axis) {
    const start = randomAt(seed, box, axis) * size[axis]!;
    const velocity = speed * normalAt(seed, box, 10 + 2 * axis);
    centre[axis] = bounce(start, velocity, time, half[axis]!, size[axis]! - half[axis]!);
  }
}

/** Sides of a box: about `usual`, with some random variation. */
function vary(seed: number, box: number, usual: number, half: number[]): void {
  for (let axis = 0; axis < half.length; ++axis) half[axis] = usual * (0.6 + 0.8 * randomAt(seed, box, 20 + axis));
}

function make(preset: Omit<Preset, "count" | "boxes" | "follows"> & { follows?: boolean },
              place: (box: number, context: Context) => void): Preset {
  const { dimension, settings } = preset;
  return {
    follows: false,
    ...preset,
    count: settings.count,
    boxes: (count, seed, time) => packed(dimension, count, (box, centre, half) =>
      place(box, { count, seed, time, centre, half })),
  };
}

interface Context {
  count: number;
  seed: number;
  time: number;
  centre: number[];
  half: number[];
}

const driftingCrowd = make({
  name: "drifting_crowd",
  summary: "People on a square: some hundred boxes drift about, none near most others.",
  dimension: 2,
  breaks: "brute_force",
  why: "Brute force compares each box with all others, though nearly all of them are far away.",
  settings: { count: 400, ratio: 2.3, clustering: 0, moving: 1, speed: 0.04 },
}, (box, { count, seed, time, centre, half }) => {
  vary(seed, box, halfFor(count, 2, 0.09), half);
  drift(seed, box, time, 6, centre, half);
});

const hugeFloor = make({
  name: "huge_floor",
  summary: "A platform game: a floor as wide as the whole level, and everyone on a small part of it.",
  dimension: 2,
  breaks: "paper_quadtree",
  why: "Nodes have the shape of the world, and so of the floor: they are still wider than the crowd when they are lower than a box.",
  settings: { count: 400, ratio: 8000, clustering: 0, moving: 1, speed: 0.04 },
}, (box, { count, seed, time, centre, half }) => {
  if (box === 0) {
    centre.splice(0, 2, 80, 102);
    half.splice(0, 2, 8000, 2);
    return;
  }
  vary(seed, box, halfFor(count, 2, 0.05), half);
  const start = randomAt(seed, box, 0) * size[0];
  centre[0] = bounce(start, 6 * normalAt(seed, box, 10), time, half[0]!, size[0] - half[0]!);
  // Half of them walk on the ground; the others jump.
  const height = randomAt(seed, box, 2) < 0.5 ? 0 : 60 * randomAt(seed, box, 3);
  centre[1] = 100 - half[1]! - height * Math.abs(Math.sin(time + 6 * randomAt(seed, box, 4)));
});

const onePoint = make({
  name: "one_point",
  summary: "A bug that every game has once: all things are created at the same place.",
  dimension: 2,
  breaks: "paper_grid:cell=2",
  why: "Every box overlaps every other. Cells smaller than the boxes only test each pair again, in each cell they share.",
  settings: { count: 150, ratio: 2.3, clustering: 1, moving: 1, speed: 0.01, cell: 2 },
}, (box, { seed, time, centre, half }) => {
  vary(seed, box, 10, half);
  for (let axis = 0; axis < 2; ++axis) {
    centre[axis] = size[axis]! / 2 +
      3 * Math.sin(time * (0.3 + randomAt(seed, box, 5 + axis)) + 6 * randomAt(seed, box, axis));
  }
});

const sortedLine = make({
  name: "sorted_line",
  summary: "A queue at the gate: boxes in order behind each other, along a line that happens to go up.",
  dimension: 2,
  breaks: "paper_sweep_and_prune",
  why: "It sweeps along x, where all of the queue stand at the same place.",
  settings: { count: 1000, ratio: 1, clustering: 0, moving: 1, speed: 0.01 },
}, (box, { count, time, centre, half }) => {
  const step = size[1] / count;
  half.fill(0.3 * step);
  centre[0] = size[0] / 2 + 0.2 * step * Math.sin(time + 2 * box);
  centre[1] = (box + 0.5 + 0.3 * Math.sin(2 * time + box)) * step;
});

const teleporting = make({
  name: "teleporting",
  summary: "A match that restarts five times a second: everyone is at another place each time.",
  dimension: 2,
  breaks: "sweep_and_prune:update=follow",
  follows: true,
  why: "Following boxes pays where they move a little. These are elsewhere: each is searched for anew, one by one.",
  settings: { count: 400, ratio: 2.3, clustering: 0, moving: 1, speed: 5 },
}, (box, { count, seed, time, centre, half }) => {
  vary(seed, box, halfFor(count, 2, 0.09), half);
  const jump = Math.floor(5 * time);
  drift(seed + 7919 * jump, box, 0, 0, centre, half);
});

const oneHuge = make({
  name: "one_huge_among_many",
  summary: "The sky is a box, too: one is a hundred times as wide as the world of all the others.",
  dimension: 2,
  breaks: "paper_grid",
  why: "The grid lays its cells over all of the sky, so that everyone stands in the same cell.",
  settings: { count: 400, ratio: 10000, clustering: 0, moving: 1, speed: 0.04 },
}, (box, { count, seed, time, centre, half }) => {
  if (box === 0) {
    centre.splice(0, 2, 80, 50);
    half.splice(0, 2, 8000, 5000);
    return;
  }
  vary(seed, box, halfFor(count, 2, 0.09), half);
  drift(seed, box, time, 6, centre, half);
});

const fallingForEver = make({
  name: "falling_for_ever",
  summary: "Nobody built a floor: boxes fall out of the world, the wind drives them, and they go on.",
  dimension: 2,
  breaks: "paper_grid:update=reinsert",
  follows: true,
  why: "A grid that is kept keeps the world of its first frame: all that is beyond it is in the cell at its corner.",
  settings: { count: 400, ratio: 2.3, clustering: 0, moving: 1, speed: 1.2 },
}, (box, { count, seed, time, centre, half }) => {
  vary(seed, box, halfFor(count, 2, 0.09), half);
  drift(seed, box, 0, 0, centre, half);
  centre[0]! += 120 * time;
  centre[1]! += 150 * time * (1 + 0.1 * randomAt(seed, box, 6));
});

const clustered = make({
  name: "clustered",
  summary: "A map of towns: boxes crowd in a few places, with nothing between them.",
  dimension: 2,
  breaks: "paper_grid",
  why: "One size of cells is too large for the towns and too small for the land between them.",
  settings: { count: 1500, ratio: 2.3, clustering: 0.95, moving: 1, speed: 0.002 },
}, (box, { seed, time, centre, half }) => {
  vary(seed, box, 0.03, half);
  const town = Math.floor(randomAt(seed, box, 0) * 6);
  for (let axis = 0; axis < 2; ++axis) {
    const heart = (0.1 + 0.8 * randomAt(seed, town, 30 + axis)) * size[axis]!;
    centre[axis] = heart + 0.35 * normalAt(seed, box, 1 + 2 * axis) +
      0.2 * Math.sin(time * (0.5 + randomAt(seed, box, 7 + axis)) + box);
  }
});

const pileAtRest = make({
  name: "pile_at_rest",
  summary: "A pile of crates that has come to rest: in most frames nothing moves at all.",
  dimension: 2,
  breaks: "sweep_and_prune:update=rebuild",
  follows: true,
  why: "A search that starts anew in each frame finds out each time what it knew before.",
  settings: { count: 420, ratio: 1.2, clustering: 0, moving: 0, speed: 0 },
}, (box, { count, seed, time, centre, half }) => {
  // Rows of a triangle with the longest at the bottom; the topmost crate wobbles once per second.
  const crate = 90 / Math.sqrt(2 * count + 1);
  const fromTop = Math.floor((Math.sqrt(8 * box + 1) - 1) / 2);
  const inRow = box - fromTop * (fromTop + 1) / 2;
  half.fill(0.5 * crate * (0.98 + 0.04 * randomAt(seed, box, 0)));
  centre[0] = size[0] / 2 + (inRow - fromTop / 2) * 1.04 * crate;
  centre[1] = 98 - (Math.sqrt(2 * count + 0.25) - 0.5 - fromTop - 0.5) * crate;
  if (box === 0 && time % 1 > 0.9) centre[0] += 0.2 * crate;
});

const scaffold = make({
  name: "scaffold",
  summary: "A scaffold or a truss: long thin bars along all three axes.",
  dimension: 3,
  breaks: "sweep_and_prune:axes=1",
  why: "On each axis a third of the bars reach across the whole building, so that a sweep along one passes few of them.",
  settings: { count: 600, ratio: 225, clustering: 0, moving: 1, speed: 0.005 },
}, (box, { seed, time, centre, half }) => {
  const along = Math.floor(3 * randomAt(seed, box, 9));
  for (let axis = 0; axis < 3; ++axis) {
    half[axis] = axis === along ? 45 : 0.2;
    centre[axis] = axis === along ? 50 : 5 + 90 * randomAt(seed, box, axis) +
      Math.sin(time * (0.2 + randomAt(seed, box, 3 + axis)) + box);
  }
});

const flatCity = make({
  name: "flat_city",
  summary: "Cars and houses: a world of three dimensions in which everything stands on the ground.",
  dimension: 3,
  breaks: "sweep_and_prune:axis=y:axes=1",
  why: "All stand on the ground, so that on the axis that points up they all overlap and a sweep along it tests them all.",
  settings: { count: 600, ratio: 10, clustering: 0, moving: 0.7, speed: 0.03 },
}, (box, { seed, time, centre, half }) => {
  const isHouse = randomAt(seed, box, 40) < 0.3;
  vary(seed, box, isHouse ? 1.6 : 0.6, half);
  drift(seed, box, isHouse ? 0 : time, isHouse ? 0 : 4, centre, half);
  half[1] = isHouse ? 2 + 10 * randomAt(seed, box, 41) : 0.6;
  centre[1] = half[1];
});

/** The playground opens with the first one. */
export const presets: readonly Preset[] = [
  driftingCrowd, hugeFloor, onePoint, sortedLine, teleporting, oneHuge, fallingForEver, clustered, pileAtRest, scaffold,
  flatCity,
];

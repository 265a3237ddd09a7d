// The libraries of the comparison, each used as its documentation says.
//
// A library's entry runs one set of boxes: `fill` makes the library's own objects from a Float32Array (if it has any),
// and `pairs` finds all pairs, `a0, b0, a1, b1, ...` in any order. `motion` follows an array from frame to frame: its
// update takes the boxes and the indices of those that moved, and returns the begun and the ended pairs.
import boxIntersect from "box-intersect";
import { System } from "detect-collisions";
import Flatbush from "flatbush";
import RBush from "rbush";
import { RBush3D } from "rbush-3d";

/** The sum of what a query at each box gives. */
function sumOf(asked, query) {
  let sum = 0;
  for (let i = 0; i < asked.length; i += 4) sum += query(i);
  return sum;
}

function idsSum(ids) {
  let sum = 0;
  for (const id of ids) sum += id + 1;
  return sum;
}

/** The obvious loop over all pairs. */
export function naivePairs2(boxes) {
  const pairs = [];
  for (let a = 0; a < boxes.length; a += 4) {
    const minX = boxes[a], minY = boxes[a + 1], maxX = boxes[a + 2], maxY = boxes[a + 3];
    for (let b = a + 4; b < boxes.length; b += 4) {
      if (boxes[b] <= maxX && minX <= boxes[b + 2] && boxes[b + 1] <= maxY && minY <= boxes[b + 3])
        pairs.push(a / 4, b / 4);
    }
  }
  return pairs;
}

export function naivePairs3(boxes) {
  const pairs = [];
  for (let a = 0; a < boxes.length; a += 6) {
    const minX = boxes[a], minY = boxes[a + 1], minZ = boxes[a + 2];
    const maxX = boxes[a + 3], maxY = boxes[a + 4], maxZ = boxes[a + 5];
    for (let b = a + 6; b < boxes.length; b += 6) {
      if (boxes[b] <= maxX && minX <= boxes[b + 3] && boxes[b + 1] <= maxY && minY <= boxes[b + 4] &&
          boxes[b + 2] <= maxZ && minZ <= boxes[b + 5])
        pairs.push(a / 6, b / 6);
    }
  }
  return pairs;
}

/** Begun and ended pairs, from the overlaps of each moved box before and now. */
class Changes {
  begun = [];
  ended = [];

  /**
   * `was` and `is`: ids that overlap a moved box before and now. If both boxes of a pair moved, the one with the lower
   * id reports it.
   */
  add(id, was, is, moved) {
    for (const other of is) if (other !== id && !(moved[other] && other < id) && !was.includes(other)) this.begun.push(id, other);
    for (const other of was) if (other !== id && !(moved[other] && other < id) && !is.includes(other)) this.ended.push(id, other);
  }
}

/** Flags by id, from a list of moved boxes. */
function flagsOf(count, list) {
  const flags = new Uint8Array(count);
  for (const id of list) flags[id] = 1;
  return flags;
}

/** Motion by searching each frame for all pairs and comparing them with the previous frame's. */
function byAllPairs(findPairs) {
  return (boxes) => {
    const count = boxes.length / 4;
    const keysOf = (pairs) => {
      const keys = new Float64Array(pairs.length / 2);
      for (let k = 0; k < keys.length; ++k) {
        const a = pairs[2 * k], b = pairs[2 * k + 1];
        keys[k] = a < b ? a * count + b : b * count + a;
      }
      return keys.sort();
    };
    let before = keysOf(findPairs(boxes));
    return (now) => {
      const keys = keysOf(findPairs(now));
      const begun = [], ended = [];
      let i = 0, j = 0;
      while (i < keys.length || j < before.length) {
        if (j === before.length || keys[i] < before[j]) begun.push(Math.floor(keys[i] / count), keys[i++] % count);
        else if (i === keys.length || before[j] < keys[i]) ended.push(Math.floor(before[j] / count), before[j++] % count);
        else ++i, ++j;
      }
      before = keys;
      return { begun, ended };
    };
  };
}

function fillFlatbush(boxes) {
  const index = new Flatbush(boxes.length / 4);
  for (let i = 0; i < boxes.length; i += 4) index.add(boxes[i], boxes[i + 1], boxes[i + 2], boxes[i + 3]);
  index.finish();
  return index;
}

function flatbushPairs(boxes, index = fillFlatbush(boxes)) {
  const pairs = [];
  let a = 0;
  const take = (b) => {
    if (b > a) pairs.push(a, b);
    return false;
  };
  for (let i = 0; i < boxes.length; i += 4, ++a)
    index.search(boxes[i], boxes[i + 1], boxes[i + 2], boxes[i + 3], take);
  return pairs;
}

const flatbush = {
  name: "flatbush",
  dimension: 2,
  fill: fillFlatbush,
  pairs: flatbushPairs,
  queries(boxes) {
    const index = fillFlatbush(boxes);
    const nearest = (k) => (asked) => sumOf(asked, (i) => idsSum(index.neighbors(asked[i], asked[i + 1], k)));
    return {
      search: (asked) => sumOf(asked, (i) => idsSum(index.search(asked[i], asked[i + 1], asked[i + 2], asked[i + 3]))),
      nearest1: nearest(1),
      nearest10: nearest(10),
    };
  },
  // The library does not move boxes, so its index is rebuilt; moved boxes are looked up in the old and the new one.
  motion(boxes) {
    let index = fillFlatbush(boxes);
    let before = boxes.slice();
    return (now, list) => {
      const next = fillFlatbush(now);
      const moved = flagsOf(now.length / 4, list);
      const changes = new Changes();
      for (const id of list) {
        const i = 4 * id;
        changes.add(id, index.search(before[i], before[i + 1], before[i + 2], before[i + 3]),
          next.search(now[i], now[i + 1], now[i + 2], now[i + 3]), moved);
      }
      index = next;
      before = now.slice();
      return changes;
    };
  },
};

const itemOf = (boxes, i) =>
  ({ minX: boxes[4 * i], minY: boxes[4 * i + 1], maxX: boxes[4 * i + 2], maxY: boxes[4 * i + 3], id: i });

function fillRbush(boxes) {
  const items = Array.from({ length: boxes.length / 4 }, (_, i) => itemOf(boxes, i));
  return { tree: new RBush().load(items), items };
}

function treePairs({ tree, items }) {
  const pairs = [];
  for (const item of items) for (const other of tree.search(item)) if (other.id > item.id) pairs.push(item.id, other.id);
  return pairs;
}

const rbush = {
  name: "rbush",
  dimension: 2,
  fill: fillRbush,
  queries(boxes) {
    const { tree } = fillRbush(boxes);
    return {
      search: (asked) => sumOf(asked, (i) => tree.search(itemOf(asked, i / 4)).reduce((sum, { id }) => sum + id + 1, 0)),
    };
  },
  pairs: (boxes, filled = fillRbush(boxes)) => treePairs(filled),
  motion(boxes) {
    const { tree, items } = fillRbush(boxes);
    return (now, list) => {
      const moved = flagsOf(items.length, list);
      const was = list.map((id) => tree.search(items[id]).map((item) => item.id));
      for (const id of list) {
        tree.remove(items[id]);
        tree.insert(items[id] = itemOf(now, id));
      }
      const changes = new Changes();
      list.forEach((id, k) => changes.add(id, was[k], tree.search(items[id]).map((item) => item.id), moved));
      return changes;
    };
  },
};

function fillRbush3d(boxes) {
  const items = Array.from({ length: boxes.length / 6 }, (_, i) => ({
    minX: boxes[6 * i], minY: boxes[6 * i + 1], minZ: boxes[6 * i + 2],
    maxX: boxes[6 * i + 3], maxY: boxes[6 * i + 4], maxZ: boxes[6 * i + 5], id: i,
  }));
  return { tree: new RBush3D().load(items), items };
}

const rbush3d = {
  name: "rbush-3d",
  dimension: 3,
  maxCount: 200_000,  // a million boxes would take minutes
  fill: fillRbush3d,
  pairs: (boxes, filled = fillRbush3d(boxes)) => treePairs(filled),
};

/** Boxes as arrays of arrays. */
function fillBoxIntersect(boxes, dimension) {
  const size = 2 * dimension;
  return Array.from({ length: boxes.length / size }, (_, i) => [...boxes.subarray(size * i, size * (i + 1))]);
}

function boxIntersectPairs(arrays) {
  const pairs = [];
  boxIntersect(arrays, (a, b) => {
    pairs.push(a, b);
  });
  return pairs;
}

const boxIntersects = [2, 3].map((dimension) => ({
  name: "box-intersect",
  dimension,
  fill: (boxes) => fillBoxIntersect(boxes, dimension),
  pairs: (boxes, arrays = fillBoxIntersect(boxes, dimension)) => boxIntersectPairs(arrays),
  motion: dimension === 2 ? byAllPairs((boxes) => boxIntersectPairs(fillBoxIntersect(boxes, 2))) : undefined,
}));

function fillSystem(boxes) {
  const system = new System();
  for (let i = 0; i < boxes.length; i += 4) {
    const box = system.createBox({ x: boxes[i], y: boxes[i + 1] }, boxes[i + 2] - boxes[i], boxes[i + 3] - boxes[i + 1]);
    box.id = i / 4;
  }
  return system;
}

const detectCollisions = {
  name: "detect-collisions",
  dimension: 2,
  maxCount: 20_000,
  // It computes penetration depths in float 64 from sizes and does not count touching as a contact.
  isOther: true,
  fill: fillSystem,
  pairs(boxes, system = fillSystem(boxes)) {
    const pairs = [];
    system.checkAll(({ a, b }) => {
      if (a.id < b.id) pairs.push(a.id, b.id);
    });
    return pairs;
  },
};

/** Our library: `entry` is a loaded module. */
export function ours(broadside, name = "broadside") {
  const queries = (boxes, ofEach) => {
    const index = broadside.index(boxes);
    const nearest = (k) => (ofEach ?
      (asked) => idsSum(index.nearestOfEach(asked, k).ids) :
      (asked) => sumOf(asked, (i) => idsSum(index.nearest([asked[i], asked[i + 1]], k).ids)));
    return {
      search: ofEach ? undefined : (asked) =>
        sumOf(asked, (i) => idsSum(index.overlapping([asked[i], asked[i + 1], asked[i + 2], asked[i + 3]]))),
      nearest1: nearest(1),
      nearest10: nearest(10),
    };
  };
  const all = [2, 3].map((dimension) => ({
    name,
    dimension,
    pairs: dimension === 2 ? (boxes) => broadside.pairs(boxes) : (boxes) => broadside.pairs(boxes, of3),
    // After filling, the boxes are in the module's memory.
    fill(boxes) {
      const kept = broadside.boxes(boxes.length / (2 * dimension), dimension);
      kept.data.set(boxes);
      return kept;
    },
    pairsOfFilled: (kept) => broadside.pairs(kept, { dimension }),
    free: (kept) => kept.free(),
    motion(boxes) {
      const tracker = broadside.tracker({ dimension });
      tracker.update(boxes);
      return (now, list) => tracker.update(now, { changed: list });
    },
    queries: dimension === 2 ? (boxes) => queries(boxes, false) : undefined,
  }));
  return [...all, { name: "broadside, nearestOfEach", queries: (boxes) => queries(boxes, true) }];
}
const of3 = { dimension: 3 };

export const others = [
  { name: "naive", dimension: 2, maxCount: 20_000, pairs: naivePairs2, motion: byAllPairs(naivePairs2) },
  { name: "naive", dimension: 3, maxCount: 20_000, pairs: naivePairs3 },
  flatbush, rbush, rbush3d, ...boxIntersects, detectCollisions,
];

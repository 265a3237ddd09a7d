// Measures all libraries in the same rounds, in Node and in browsers, and checks their results.

/** Seeded random numbers from 0 to 1: mulberry32. */
function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let bits = Math.imul(seed ^ (seed >>> 15), seed | 1);
    bits ^= bits + Math.imul(bits ^ (bits >>> 7), bits | 61);
    return ((bits ^ (bits >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Uniformly distributed boxes; a box overlaps about one other, whatever the count. */
export function uniform(count, dimension, seed = 1) {
  const rng = random(seed);
  const side = count ** (1 / dimension);
  const boxes = new Float32Array(2 * dimension * count);
  for (let i = 0; i < count; ++i) {
    for (let axis = 0; axis < dimension; ++axis) {
      const begin = side * rng();
      boxes[2 * dimension * i + axis] = begin;
      boxes[2 * dimension * i + dimension + axis] = begin + rng();
    }
  }
  return boxes;
}

/** Moves a tenth of the boxes; returns their indices. */
function move(boxes, dimension, rng) {
  const list = [];
  for (let i = 0; i < boxes.length / (2 * dimension); ++i) {
    if (rng() >= 0.1) continue;
    list.push(i);
    for (let axis = 0; axis < dimension; ++axis) {
      const distance = (rng() - 0.5) / 2;
      boxes[2 * dimension * i + axis] += distance;
      boxes[2 * dimension * i + dimension + axis] += distance;
    }
  }
  return list;
}

/** A set of pairs as a text: the count, and a sum that does not depend on their order. */
export function digest(pairs) {
  let sum = 0;
  for (let k = 0; k < pairs.length; k += 2) {
    const a = Math.min(pairs[k], pairs[k + 1]), b = Math.max(pairs[k], pairs[k + 1]);
    let bits = Math.imul(a + 1, 0x9e3779b1) ^ Math.imul(b + 0x7f4a7c15, 0x85ebca6b);
    bits = Math.imul(bits ^ (bits >>> 15), 0x2c1b3c6d);
    sum = (sum + ((bits ^ (bits >>> 12)) >>> 0)) % 2 ** 48;
  }
  return `${pairs.length / 2}:${sum}`;
}

/** How many calls together take `milliseconds`. */
function repeats(clock, call, milliseconds) {
  call();
  let count = 1;
  for (;;) {
    const begin = clock();
    for (let k = 0; k < count; ++k) call();
    const took = clock() - begin;
    if (took >= milliseconds / 4 || count >= 1e7)
      return Math.max(1, Math.round(count * Math.min(100, milliseconds / Math.max(took, 1e-3))));
    count *= 4;
  }
}

/** Times calls in alternating rounds; returns the median of each, in milliseconds per call. */
function inRounds(clock, calls, rounds, milliseconds) {
  const counts = calls.map((call) => repeats(clock, call, milliseconds));
  const times = calls.map(() => []);
  for (let round = 0; round < rounds; ++round) {
    calls.forEach((call, i) => {
      const begin = clock();
      for (let k = 0; k < counts[i]; ++k) call();
      times[i].push((clock() - begin) / counts[i]);
    });
  }
  return times.map((of) => of.sort((a, b) => a - b)[Math.floor(of.length / 2)]);
}

/** All pairs of boxes at rest. `fills` has the libraries with a separately timed fill. */
export function compareStill({ clock, libraries, dimension, count, rounds = 5, milliseconds = 20 }) {
  const boxes = uniform(count, dimension);
  const rows = [];
  let expected;
  for (const library of libraries) {
    if (library.dimension !== dimension || library.pairs === undefined || count > (library.maxCount ?? Infinity)) continue;
    const found = digest(library.pairs(boxes));
    expected ??= found;
    rows.push({ name: library.name, library, agrees: found === expected });
  }
  const calls = rows.map(({ library }) => () => library.pairs(boxes));
  inRounds(clock, calls, rounds, milliseconds).forEach((time, i) => (rows[i].whole = time));
  const filled = rows.filter(({ library }) => library.fill !== undefined);
  const things = filled.map(({ library }) => library.fill(boxes));
  const searches = filled.map(({ library }, i) => library.pairsOfFilled === undefined ?
    () => library.pairs(boxes, things[i]) : () => library.pairsOfFilled(things[i]));
  inRounds(clock, searches, rounds, milliseconds).forEach((time, i) => (filled[i].search = time));
  filled.forEach(({ library }, i) => library.free?.(things[i]));
  return rows.map(({ library: _, ...row }) => ({ dimension, count, ...row }));
}

/** Begun and ended pairs when a tenth of the boxes moves in each frame. All libraries get the same frames. */
export function compareMoving({ clock, libraries, count, frames = 12, dimension = 2 }) {
  const first = uniform(count, dimension);
  const rng = random(99);
  const boxes = first.slice();
  const steps = Array.from({ length: frames }, () => {
    const list = move(boxes, dimension, rng);
    return { list, boxes: boxes.slice() };
  });
  const rows = [];
  let expected;
  for (const library of libraries) {
    if (library.dimension !== dimension || library.motion === undefined || count > (library.maxCount ?? Infinity)) continue;
    // One warm-up run, so that the JIT compilers have optimised the code.
    const warming = library.motion(first.slice());
    for (const { list, boxes: now } of steps) warming(now, list);
    warming.free?.();
    rows.push({ name: library.name, update: library.motion(first.slice()), times: [], agrees: true });
  }
  for (const { list, boxes: now } of steps) {
    expected = undefined;
    for (const row of rows) {
      const begin = clock();
      const events = row.update(now, list);
      row.times.push(clock() - begin);
      const found = `${digest(events.begun)} ${digest(events.ended)}`;
      expected ??= found;
      row.agrees &&= found === expected;
    }
  }
  return rows.map(({ name, times, agrees, update }) => {
    update.free?.();
    // The first frames still include compilation.
    const rest = times.slice(Math.floor(frames / 3)).sort((a, b) => a - b);
    return { dimension, count, name, agrees, whole: rest[Math.floor(rest.length / 2)] };
  });
}

/** The boxes' minima as boxes, of which hardly any two are as near to a point. */
function pointsOf(boxes) {
  const points = boxes.slice();
  for (let i = 0; i < points.length; i += 4) points.copyWithin(i + 2, i, i + 2);
  return points;
}

/**
 * Queries to an index that is built before, in an order that has nothing to do with space: the boxes that overlap a box,
 * and the points nearest to a point. Times are of one query.
 */
export function compareQueries({ clock, libraries, count, queries = 2000, rounds = 5 }) {
  const boxes = uniform(count, 2);
  const all = uniform(count, 2, 5).subarray(0, 4 * Math.min(queries, count));
  const rows = [];
  for (const kind of ["search", "nearest1", "nearest10"]) {
    const [indexed, asked] = kind === "search" ? [boxes, all] : [pointsOf(boxes), pointsOf(all)];
    let expected;
    for (const library of libraries) {
      const ask = library.queries?.(indexed)[kind];
      if (ask === undefined) continue;
      const sum = ask(asked);
      expected ??= sum;
      rows.push({ name: library.name, kind, count, ask: () => ask(asked), agrees: sum === expected });
    }
  }
  inRounds(clock, rows.map(({ ask }) => ask), rounds, 30).forEach((time, i) => (rows[i].whole = time / (all.length / 4)));
  return rows.map(({ ask: _, ...row }) => row);
}

/** The table of some rows: a line for each number of boxes, a column for each library. */
export function table(title, rows, key = "whole") {
  const names = [...new Set(rows.map((row) => row.name))];
  const counts = [...new Set(rows.map((row) => row.count))];
  const cell = (count, name) => {
    const row = rows.find((one) => one.count === count && one.name === name);
    if (row?.[key] === undefined) return "";
    const time = row[key] < 0.001 ? `${(row[key] * 1e6).toFixed(0)} ns` : row[key] < 1 ?
      `${(row[key] * 1000).toPrecision(3)} µs` : row[key] < 1000 ? `${row[key].toPrecision(3)} ms` :
      `${(row[key] / 1000).toPrecision(3)} s`;
    return time + (row.agrees ? "" : " (other pairs)");
  };
  const lead = (count) => {
    const of = (row) => row?.[key];
    const ours = of(rows.find((row) => row.count === count && row.name === "broadside"));
    const rest = rows.filter((row) => row.count === count && !row.name.startsWith("broadside") && row[key] !== undefined);
    return ours === undefined || rest.length === 0 ? "" : `${(Math.min(...rest.map(of)) / ours).toPrecision(3)}x`;
  };
  return [
    `| ${title} | ${names.join(" | ")} | lead |`,
    `| ---: |${" ---: |".repeat(names.length + 1)}`,
    ...counts.map((count) => `| ${count} | ${names.map((name) => cell(count, name)).join(" | ")} | ${lead(count)} |`),
  ].join("\n");
}

/** Runs all comparisons. `minCount` and `maxCount` limit the number of boxes. */
export function compareAll({ clock, libraries, say, minCount = 1, maxCount = Infinity }) {
  const some = (all) => all.filter((count) => count >= minCount && count <= maxCount);
  const still = [1, 2, 3, 4, 6, 8, 10, 12, 13, 15, 20, 30, 50, 100, 1000, 10_000, 100_000, 1_000_000];
  for (const dimension of [2, 3]) {
    const rows = some(still).flatMap((count) => compareStill({
      clock, libraries, dimension, count, rounds: count > 50_000 ? 3 : 7, milliseconds: count > 5000 ? 30 : 10,
    }));
    say(table(`${dimension}D boxes, all pairs`, rows));
    say(table(`${dimension}D boxes, filled before`, rows.filter((row) => row.search !== undefined && row.count >= 100),
      "search"));
  }
  const asked = some([1000, 20_000, 200_000, 1_000_000]).flatMap((count) => compareQueries({ clock, libraries, count }));
  for (const [kind, what] of [["search", "boxes that overlap a box"], ["nearest1", "the nearest box"], ["nearest10", "the 10 nearest"]])
    say(table(`2D, one query: ${what}`, asked.filter((row) => row.kind === kind)));
  for (const dimension of [2]) {
    const rows = some([15, 100, 1000, 10_000, 100_000])
      .flatMap((count) => compareMoving({ clock, libraries, count, dimension, frames: count < 5000 ? 60 : count < 50_000 ? 30 : 12 }));
    say(table(`${dimension}D boxes, a tenth moves`, rows));
  }
}

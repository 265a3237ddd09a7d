// Measures times: of searches by number of boxes, and of `auto` against the library's other
// algorithms.
import type { Engine } from "../engine/types.ts";
import { fileScene, makeScene, type SceneChoice } from "../scene/catalogue.ts";
import type { Dimension } from "../scene/scene.ts";
import { refusal } from "./budget.ts";
import type { Duel, Measured } from "./protocol.ts";
import { batchesOf, median, spread, timeOf } from "./times.ts";

/** Budget of one measurement, in ms. */
const budget = 25;

/** Rounds of a race, and the budget of all of them, in ms. */
const rounds = 15;
const raceBudget = 4000;

/** What takes this many times as long as the fastest has lost, and runs in no further round. */
const hopeless = 8;

/** Above this spread of a racer's rounds, the machine is busy. */
const maxSpread = 0.2;

/** A copy in random order. */
function shuffled<Item>(items: readonly Item[]): Item[] {
  const mixed = [...items];
  for (let at = mixed.length - 1; at > 0; --at) {
    const other = Math.floor(Math.random() * (at + 1));
    [mixed[at], mixed[other]] = [mixed[other]!, mixed[at]!];
  }
  return mixed;
}

function pause(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, 0));
}

/** Yields the time of each spec at each number of boxes as soon as it is known. */
export async function* measure(engine: Engine, choice: SceneChoice, counts: readonly number[],
                               specs: readonly string[]): AsyncGenerator<Measured> {
  if (choice.name === fileScene) throw new Error("a file has the boxes that it has; choose another scene to measure");
  const slow = new Set<string>();
  for (const count of counts) {
    const scene = makeScene({ ...choice, count });
    const boxes = scene.at(0);
    for (const spec of specs) {
      if (slow.has(spec) || refusal(spec, count) !== undefined) continue;
      const milliseconds = timeOf(engine, spec, boxes, scene.dimension, budget);
      // The next number of boxes may take ten times as long.
      if (milliseconds > 200) slow.add(spec);
      yield { spec, count, milliseconds };
      await pause();
    }
  }
}

/**
 * Times `auto` and the others in the same rounds, so that a slow moment slows all of them, and returns medians. Each
 * round draws an order, because a search takes longer after a pause or after one that used much memory.
 */
export async function duel(engine: Engine, boxes: Float32Array, dimension: Dimension): Promise<Duel> {
  const count = boxes.length / (2 * dimension);
  const specs = engine.algorithms()
    .filter(({ name, kind, dimensions }) => kind === "own" && name !== "auto" && dimensions.includes(dimension))
    .map(({ name }) => name)
    .filter((name) => refusal(name, count) === undefined);
  const begin = performance.now();
  const { explanation } = engine.find("auto", boxes, dimension);
  const racers = ["auto", ...specs].map((spec) =>
    ({ spec, batch: batchesOf(engine, spec, boxes, dimension), times: [] as number[] }));
  for (let round = 0; round < rounds; ++round) {
    const best = Math.min(...racers.flatMap(({ times }) => times));
    for (const { batch, times } of shuffled(racers)) {
      // The least: one round may have been interrupted.
      if (round < 2 || Math.min(...times) < (round < 4 ? 10 : 1) * hopeless * best) times.push(batch());
    }
    await pause();
    if (performance.now() - begin > raceBudget) break;
  }
  const [auto, ...others] = racers.map(({ spec, times }) => ({ spec, milliseconds: median(times), spread: spread(times) }));
  others.sort((a, b) => a.milliseconds - b.milliseconds);
  return {
    auto: auto!.milliseconds,
    chosen: specs.find((spec) => explanation.startsWith(`${spec},`)) ?? "",
    explanation,
    unsteady: [auto!, ...others.slice(0, 1)].some((one) => one.spread > maxSpread),
    others: others.map(({ spec, milliseconds }) => ({ spec, milliseconds })),
  };
}

// The face of the smaller modules: pairs, trackers and worlds.
import type {
  BoxArray, Boxes, ComponentsOptions, CountJoinOptions, CountOptions, Dimension, JoinOptions,
  NeighbourLists, NeighboursOptions, PairFinding, PairsOptions, Tracker, TrackerOptions, Uint32s, World,
  WorldOptions,
} from "../types/types.d.ts";
import { type Given, KeptBoxes } from "./boxes.ts";
import { Cores } from "./core.ts";
import { Pairs, neighboursOf } from "./pairs.ts";
import { KeptTracker } from "./tracker.ts";
import { KeptWorld } from "./world.ts";

export class PairFindingFace implements PairFinding {
  protected readonly cores: Cores;
  readonly #main: Pairs;
  readonly #plane: Pairs | undefined;
  readonly #space: Pairs | undefined;
  readonly version: string;

  constructor(cores: Cores) {
    const { main } = cores;
    this.cores = cores;
    this.#main = new Pairs(main);
    const { plane, space } = cores;
    this.#plane = plane === main ? this.#main : undefined;
    this.#space = space === main ? this.#main : space && new Pairs(space);
    main.exports.version();
    this.version = main.text(0);
  }

  /** What finds the pairs of boxes of a dimension. */
  #of(options: CountOptions | undefined): Pairs {
    const dimension = options?.dimension;
    const pairs = dimension === 3 ? this.#space : dimension === 2 ? this.#plane : undefined;
    if (pairs !== undefined) return pairs;
    this.cores.of(dimension);  // throws if there is none
    return this.#main;
  }

  pairs(boxes: BoxArray, options?: PairsOptions): Uint32s {
    if (options === undefined) return this.#main.pairs(boxes as Given, undefined);
    // Not by #of(): for a box or two, another call would be felt.
    const space = options?.dimension === 3 ? this.#space : undefined;
    return (space ?? this.#of(options)).pairs(boxes as Given, options);
  }

  join(left: BoxArray, right: BoxArray, options?: JoinOptions): Uint32s {
    return this.#of(options).join(left as Given, right as Given, options);
  }

  count(boxes: BoxArray, options?: CountOptions): number {
    return this.#of(options).count(boxes as Given, options);
  }

  components(boxes: BoxArray, options?: ComponentsOptions): Uint32s {
    return this.#of(options).components(boxes as Given, options);
  }

  neighbours(pairs: ArrayLike<number>, count: number, options?: NeighboursOptions): NeighbourLists {
    return neighboursOf(pairs, count, options);
  }

  countJoin(left: BoxArray, right: BoxArray, options?: CountJoinOptions): number {
    return this.#of(options).countJoin(left as Given, right as Given, options);
  }

  boxes(count: number, dimension?: Dimension): Boxes {
    return new KeptBoxes(this.cores.of(dimension), count);
  }

  tracker(options?: TrackerOptions): Tracker {
    return new KeptTracker(this.cores, options);
  }

  world(options?: WorldOptions): World {
    return new KeptWorld(this.cores, options);
  }

  algorithms(): string[] {
    return [...this.cores.main.algorithms];
  }
}

export async function pairFindingOf(wasms: readonly WebAssembly.Module[]): Promise<PairFinding> {
  return new PairFindingFace(await Cores.make(wasms));
}

// Trackers of arrays of boxes.
import type {
  BoxArray, Dimension, Events, FrameOptions, Tracker, TrackerOptions, TrackerUpdateOptions, Uint32s,
} from "../types/types.d.ts";
import {
  type Given, bytesOf, bytesOfFilter, checkFilters, copyOf, countOf, countOfNumbers, put, putFilters, putWords,
} from "./boxes.ts";
import type { Core, Cores } from "./core.ts";
import { asksForView, checkOptions, checkSwitch, refuse } from "./error.ts";
import { Kept } from "./kept.ts";

/** The module and the spec of an object that is made with options, checked. */
export function specOf(cores: Cores, options: TrackerOptions): { core: Core; algorithm: string } {
  checkOptions(options, ["dimension", "algorithm", "touching"]);
  checkSwitch("touching", options.touching);
  const core = cores.of(options.dimension);
  const algorithm = core.algorithmFor(Infinity, options.algorithm);
  if (typeof algorithm !== "string") refuse("algorithm", algorithm, "a text such as 'auto'");
  return { core, algorithm };
}

export const frameOptions = ["changed", "filters"];

/** Puts a frame's arguments into the module. */
export function putFrame(core: Core, boxes: Given, options: FrameOptions, listName = "changed") {
  const { changed, filters } = options;
  const count = countOf(core, boxes);
  const changedCount = changed === undefined ? 0 : countOfNumbers(changed, 1, listName);
  if (filters !== undefined) checkFilters(filters, count);
  core.stage(bytesOf(boxes) + 4 * changedCount + (filters === undefined ? 0 : bytesOfFilter * (count + 1)));
  return {
    at: put(core, boxes),
    count,
    changed: changed === undefined ? 0 : putWords(core, changed),
    changedCount,
    filters: putFilters(core, filters, count),
  };
}

const noOptions: TrackerUpdateOptions = {};
const updateOptions = [...frameOptions, "view"];

/** The ids, or pairs of them, in the `number`-th array of the module's reply: a copy, or a view of its memory. */
export function idsOf(core: Core, number: number, each: number, view: boolean): Uint32s {
  const { u32, reply } = core;
  const address = u32[reply + 2 * number] as number;
  const count = each * (u32[reply + 2 * number + 1] as number);
  return view ? new Uint32Array(u32.buffer, address, count) : copyOf(u32, address / 4, count, Uint32Array);
}

export class KeptTracker extends Kept implements Tracker {
  readonly #core: Core;
  readonly dimension: Dimension;

  constructor(cores: Cores, options: TrackerOptions = {}) {
    const { core, algorithm } = specOf(cores, options);
    const { exports, dimension } = core;
    super(core.make(algorithm, (spec, size) => exports.tracker_make(spec, size, options.touching !== false)),
      (address) => exports.tracker_free(address));
    this.#core = core;
    this.dimension = dimension;
  }

  update(boxes: BoxArray, options: TrackerUpdateOptions = noOptions): Events<Uint32s> {
    const core = this.#core;
    const tracker = this.address;
    countOf(core, boxes);
    checkOptions(options, updateOptions);
    const view = asksForView(options);
    const frame = putFrame(core, boxes as Given, options);
    core.check(core.exports.tracker_update(tracker, frame.at, frame.count, frame.changed, frame.changedCount,
      frame.filters));
    return { begun: idsOf(core, 0, 2, view), ended: idsOf(core, 1, 2, view) };
  }
}

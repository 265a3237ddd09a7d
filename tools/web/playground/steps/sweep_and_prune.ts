// Algorithms 5 and 6 of the draft, mended, step by step: one sweep along the x axis.
import type { Steps, SweepState } from "../engine/types.ts";
import { presentIds, type Box } from "./boxes.ts";
import { Listing } from "./listing.ts";
import { Recorder } from "./recorder.ts";

type Line = "begin" | "sort" | "empty" | "next" | "prune" | "remove" | "add";

const listing = new Listing<Line | "test" | "report">([
  ["begin", "function Sweep(E)"],
  ["sort", "  sort E by MINX"],
  ["empty", "  F <- empty"],
  ["next", "  for i = 0 to E.length - 1 do"],
  ["", "    Prune(F, E[i])"],
  ["", "    for each f in F do"],
  ["test", "      if Test Collide(f, E[i]) then"],
  ["report", "        report f and E[i]"],
  ["", "      end if"],
  ["", "    end for"],
  ["add", "    F.Add(E[i])"],
  ["", "  end for"],
  ["", "end function"],
  ["", ""],
  ["prune", "function Prune(F, e)"],
  ["", "  i <- 0"],
  ["", "  while i < F.length do"],
  ["", "    if F[i].MAXX < e.MINX then"],
  ["remove", "      F.Remove(i): the last of F takes its place"],
  ["", "    else"],
  ["", "      i <- i + 1"],
  ["", "    end if"],
  ["", "  end while"],
  ["", "end function"],
]);

export function sweepSteps(boxes: readonly Box[]): Steps {
  const recorder = new Recorder<Line, SweepState>(listing);
  const ids = presentIds(boxes);
  let state: SweepState =
    { kind: "sweep_and_prune", order: [], next: -1, position: NaN, active: [] };
  recorder.step("begin", `E has ${ids.length} boxes`, [...ids], state);

  // Insertion sort: the result does not depend on the sorting algorithm, and this one is easy to
  // watch.
  const isBefore = (a: number, b: number): boolean =>
    boxes[a]!.minX < boxes[b]!.minX || (boxes[a]!.minX === boxes[b]!.minX && a < b);
  for (const id of ids) {
    const place = state.order.findIndex((other) => isBefore(id, other));
    const order = [...state.order];
    order.splice(place < 0 ? order.length : place, 0, id);
    state = { ...state, order };
    recorder.step("sort", `Box ${id} goes to place ${order.indexOf(id)} of the order`, [id], state);
  }

  recorder.step("empty", "No box is active", [], state);
  for (const [next, id] of state.order.entries()) {
    state = { ...state, next, position: boxes[id]!.minX };
    recorder.step("next", `The sweep comes to box ${id}`, [id], state);
    state = prune(recorder, boxes, state, id);
    for (const active of state.active) recorder.test(boxes, active, id, state);
    state = { ...state, active: [...state.active, id] };
    recorder.step("add", `Box ${id} is active until the sweep has passed it`, [id], state);
  }
  return recorder.finish();
}

/**
 * Algorithm 6. The last box fills the gap of a removed one, as in C++, so tests come in the same
 * order.
 */
function prune(recorder: Recorder<Line, SweepState>, boxes: readonly Box[], state: SweepState, e: number): SweepState {
  const ends = state.active.filter((active) => boxes[active]!.maxX < boxes[e]!.minX).length;
  recorder.step("prune", `${ends} of ${state.active.length} active boxes end before box ${e} begins`,
                [...state.active], state);
  for (let i = 0; i < state.active.length;) {
    const active = state.active[i]!;
    if (!(boxes[active]!.maxX < boxes[e]!.minX)) {
      ++i;
      continue;
    }
    const kept = state.active.slice(0, -1);
    if (i < kept.length) kept[i] = state.active.at(-1)!;
    state = { ...state, active: kept };
    recorder.step("remove", `Box ${active} is no longer active`, [active], state);
  }
  return state;
}

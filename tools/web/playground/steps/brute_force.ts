// Algorithm 1 of the draft, mended, step by step.
import type { BruteForceState, Steps } from "../engine/types.ts";
import { presentIds, type Box } from "./boxes.ts";
import { Listing } from "./listing.ts";
import { Recorder } from "./recorder.ts";

const listing = new Listing<"begin" | "first" | "second" | "test" | "report">([
  ["begin", "function Brute Force(E)"],
  ["first", "  for i = 0 to E.length - 1 do"],
  ["second", "    for j = i + 1 to E.length - 1 do"],
  ["test", "      if Test Collide(E[i], E[j]) then"],
  ["report", "        report E[i] and E[j]"],
  ["", "      end if"],
  ["", "    end for"],
  ["", "  end for"],
  ["", "end function"],
]);

export function bruteForceSteps(boxes: readonly Box[]): Steps {
  const recorder = new Recorder<"begin" | "first" | "second", BruteForceState>(listing);
  const e = presentIds(boxes);
  const state = (i: number, j: number): BruteForceState => ({ kind: "brute_force", i, j });
  recorder.step("begin", `E has ${e.length} boxes`, [...e], state(-1, -1));
  for (let i = 0; i < e.length; ++i) {
    recorder.step("first", `Box ${e[i]!} is tested against all that come after it: ${e.length - 1 - i}`, [e[i]!],
                  state(i, -1));
    for (let j = i + 1; j < e.length; ++j) recorder.test(boxes, e[i]!, e[j]!, state(i, j));
  }
  return recorder.finish();
}

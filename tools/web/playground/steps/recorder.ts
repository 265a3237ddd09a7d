// Records the steps of a search, its pairs and its tests.
import type { Step, Steps, StepState } from "../engine/types.ts";
import { overlap, type Box } from "./boxes.ts";
import type { Listing } from "./listing.ts";

/** Nobody looks at more steps, and the page would run out of memory. */
const maxSteps = 300_000;

/** The lines of Algorithm 1, which the other algorithms call on each of their collections. */
export type TestLine = "test" | "report";

export class Recorder<Line extends string, State extends StepState> {
  readonly #listing: Listing<Line | TestLine>;
  readonly #steps: Step[] = [];
  readonly #pairs: [number, number][] = [];
  #tests = 0;

  constructor(listing: Listing<Line | TestLine>) {
    this.#listing = listing;
  }

  step(line: Line | TestLine, text: string, boxes: number[], state: State, more: Partial<Step> = {}): void {
    if (this.#steps.length === maxSteps)
      throw new Error(`the search takes more than ${maxSteps} steps; expected fewer boxes`);
    this.#steps.push({ line: this.#listing.line(line), text, boxes, state, ...more });
  }

  /**
   * One test of the boxes `a` and `b`, and its outcome: `refusal` says why a hit is not reported
   * here.
   */
  test(boxes: readonly Box[], a: number, b: number, state: State, refusal?: () => string | undefined,
       hitState: State = state): void {
    ++this.#tests;
    const pair: [number, number] = [a, b];
    const at = (line: TestLine, text: string, outcome: NonNullable<Step["outcome"]>, shown: State): void =>
      this.step(line, text, [a, b], shown, { pair, outcome });
    at("test", `Box ${a} is tested against box ${b}`, "test", state);
    if (!overlap(boxes[a]!, boxes[b]!)) return at("test", `Boxes ${a} and ${b} are apart`, "miss", state);
    const refused = refusal?.();
    if (refused !== undefined) return at("report", refused, "hit", hitState);
    at("test", `Boxes ${a} and ${b} overlap`, "hit", hitState);
    at("report", `The pair of ${a} and ${b} is reported`, "reported", hitState);
    this.#pairs.push(a < b ? [a, b] : [b, a]);
  }

  finish(): Steps {
    return { listing: this.#listing.lines, steps: this.#steps, pairs: this.#pairs, tests: this.#tests };
  }
}

// Numbers of figures and sources. Both are known once everything was named, so the paper is filled twice.
import { listed, Problem } from "./problem.ts";

export class Numbering {
  private order: string[] = [];
  private known: string[] = [];

  /** `what` is what errors call one of these: "figure". */
  constructor(readonly what: string) {}

  /** Ends a pass: what was numbered in it can be referred to in the next one. */
  endPass(): void {
    this.known = this.order;
    this.order = [];
  }

  /** The number of the next one. */
  next(name: string): number {
    if (this.order.includes(name)) throw new Problem(`${this.what} '${name}' stands in the paper already`);
    return this.order.push(name);
  }

  /** The numbers of `names`, as far as they stand in the paper; none in the first pass. */
  numbersOf(names: readonly string[]): number[] {
    return this.known.flatMap((name, i) => (names.includes(name) ? [i + 1] : []));
  }

  /** The number of one; 0 in the first pass. */
  numberOf(name: string): number {
    if (this.known.length > 0 && !this.known.includes(name))
      throw new Problem(`no ${this.what} '${name}'; there are ${listed([...this.known].sort())}`);
    return this.known.indexOf(name) + 1;
  }

  /** All of the last pass. */
  all(): readonly string[] {
    return this.known;
  }
}

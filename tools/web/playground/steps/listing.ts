// A listing with named lines, so that a step can refer to its line.

export class Listing<Line extends string> {
  readonly lines: string[];
  readonly #numbers: Map<string, number>;

  /** The lines in order. A line that no step refers to may have an empty name. */
  constructor(lines: readonly (readonly [name: Line | "", text: string])[]) {
    this.lines = lines.map(([, text]) => text);
    this.#numbers = new Map(lines.map(([name], number) => [name, number]));
  }

  line(name: Line): number {
    return this.#numbers.get(name)!;
  }
}

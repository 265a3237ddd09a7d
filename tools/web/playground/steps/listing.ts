// A listing with named lines, so that a step can say where it is.

export class Listing<Line extends string> {
  readonly lines: string[];
  readonly #numbers: Map<string, number>;

  /** The lines in order. The name of one that no step is at may be empty. */
  constructor(lines: readonly (readonly [name: Line | "", text: string])[]) {
    this.lines = lines.map(([, text]) => text);
    this.#numbers = new Map(lines.map(([name], number) => [name, number]));
  }

  line(name: Line): number {
    return this.#numbers.get(name)!;
  }
}

// An array with a version for each step. It stores changes, not copies, and can restore each
// version.

export class Versions<T> {
  readonly #items: T[] = [];
  readonly #changes: [place: number, item: T][] = [];

  /** The items of the latest version. */
  get items(): readonly T[] {
    return this.#items;
  }

  /** The number of the latest version. */
  get latest(): number {
    return this.#changes.length;
  }

  set(place: number, item: T): void {
    this.#items[place] = item;
    this.#changes.push([place, item]);
  }

  /** The items of a version. Cost: all changes up to it. */
  at(version: number): T[] {
    const items: T[] = [];
    for (const [place, item] of this.#changes.slice(0, version)) items[place] = item;
    return items;
  }
}

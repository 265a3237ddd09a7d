// Kept: an object in the module's memory that is freed by hand or, if that is forgotten, with its JavaScript object.
import { BroadsideError } from "./error.ts";

// Not every host has it.
const registry = typeof FinalizationRegistry === "undefined" ? undefined :
  new FinalizationRegistry<() => void>((free) => free());

export abstract class Kept {
  #address: number;
  readonly #free: () => void;

  constructor(address: number, free: (address: number) => void) {
    this.#address = address;
    this.#free = () => free(address);
    registry?.register(this, this.#free, this);
  }

  get address(): number {
    if (this.#address === 0)
      throw new BroadsideError("INVALID_ARGUMENT", "an object was used after free(); expected one that is not freed");
    return this.#address;
  }

  free(): void {
    if (this.#address === 0) return;
    this.#address = 0;
    registry?.unregister(this);
    this.#free();
  }

  [Symbol.dispose](): void {
    this.free();
  }
}

// Numbers as the paper's sentences have them.
import { grouped, rounded } from "../charts/numbers.ts";

/** Whole numbers as they are, others with three significant digits. */
export function shown(number: number): string {
  return Number.isInteger(number) ? grouped(number) : rounded(number);
}

/** A size with the unit that suits it, as in the program's tables: 1 kB is 1,000 bytes. */
export function bytes(count: number): string {
  if (count < 1000) return `${Math.round(count)} B`;
  if (count < 999.5e3) return `${rounded(count / 1e3)} kB`;
  if (count < 999.5e6) return `${rounded(count / 1e6)} MB`;
  return `${rounded(count / 1e9)} GB`;
}

/** A number and its unit: "31 %", "4.21 ms", "2.76 MB", "12,000 boxes". */
export function with_unit(number: number, unit: string): string {
  if (unit === "bytes") return bytes(number);
  if (unit === "boxes" && number >= 10) return `${grouped(Math.round(number))} boxes`;
  return unit === "" ? shown(number) : `${shown(number)} ${unit}`;
}

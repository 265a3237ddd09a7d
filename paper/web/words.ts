// Numbers as the paper's sentences have them.
import type { Machine } from "../../web/charts/data.ts";
import { bytesText, grouped, rounded } from "../../web/charts/numbers.ts";

/** Without the marks that makers add to it. */
export function processorName({ cpu }: Machine): string {
  return (cpu ?? "an unknown processor").replace(/\((R|TM)\)/g, "");
}

/** Whole numbers as they are, others with three significant digits. */
export function shown(number: number): string {
  return Number.isInteger(number) ? grouped(number) : rounded(number);
}

/** A number and its unit: "31 %", "4.21 ms", "2.76 MB", "12,000 boxes". */
export function withUnit(number: number, unit: string): string {
  if (unit === "bytes") return bytesText(number);
  if (unit === "boxes" && number >= 10) return `${grouped(Math.round(number))} boxes`;
  return unit === "" ? shown(number) : `${shown(number)} ${unit}`;
}

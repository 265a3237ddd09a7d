// Saves the page's data, which is generated here without network access.
import type { Comparison, Measurement, RatioName } from "../charts/data.ts";
import { el } from "./dom.ts";

export function save(name: string, type: string, text: string): void {
  const address = URL.createObjectURL(new Blob([text], { type }));
  const link = el("a", { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

export function downloadButton(label: string, name: string, type: "application/json" | "text/csv", text: () => string): HTMLElement {
  return el("button", { type: "button", onclick: () => save(name, type, text()) }, label);
}

function field(value: unknown): string {
  if (value === null || value === undefined) return "";
  const text = Array.isArray(value) ? value.join(" ") : typeof value === "object" ? JSON.stringify(value) : String(value);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

function csvOfRows(heads: readonly string[], rows: readonly (readonly unknown[])[]): string {
  return [heads, ...rows].map((row) => row.map(field).join(",") + "\r\n").join("");
}

const ratioParts = ["of", "median", "low", "high", "rounds"] as const;

/**
 * A line for each measurement. Its samples are one field, separated by spaces; a ratio is five
 * fields.
 */
export function csvOfComparison({ measurements }: Comparison): string {
  const names = Object.keys(measurements[0] ?? {}) as (keyof Measurement)[];
  const isRatio = (name: keyof Measurement): name is RatioName => name.startsWith("ratio_to_");
  const heads = names.flatMap((name) => (isRatio(name) ? ratioParts.map((part) => `${name}_${part}`) : [name]));
  return csvOfRows(heads, measurements.map((measurement) => names.flatMap((name) =>
    (isRatio(name) ? ratioParts.map((part) => measurement[name]?.[part]) : [measurement[name]]))));
}

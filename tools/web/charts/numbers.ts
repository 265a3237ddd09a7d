// Formats numbers for readers: three significant digits, with separators of thousands.

/** 1234567 as "1,234,567". */
export function grouped(value: number): string {
  const [whole = "", fraction] = String(value).split(".");
  const sign = whole.startsWith("-") ? "-" : "";
  const digits = whole.slice(sign.length).replace(/\B(?=(\d{3})+$)/g, ",");
  return sign + digits + (fraction === undefined ? "" : "." + fraction);
}

/** Three significant digits; whole numbers from 100 on in full. */
export function rounded(value: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 100) return grouped(Math.round(value));
  if (size < 1e-6) return value.toExponential(2);
  const digits = 2 - Math.floor(Math.log10(size));
  const text = value.toFixed(Math.min(digits, 8));
  return Number.isInteger(value) ? String(value) : text;
}

/** Short, for the ticks of an axis: 100k, 0.01. */
export function short(value: number): string {
  const size = Math.abs(value);
  for (const [unit, name] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]] as const) {
    if (size >= unit) return trimmed(value / unit) + name;
  }
  return trimmed(value);
}

/** A time in a suitable unit. */
export function timeText(milliseconds: number): string {
  if (milliseconds >= 1000) return rounded(milliseconds / 1000) + " s";
  if (milliseconds < 0.001) return rounded(milliseconds * 1e6) + " ns";
  return milliseconds < 1 ? rounded(milliseconds * 1000) + " µs" : rounded(milliseconds) + " ms";
}

/** A size in a suitable unit, as in the program's tables: 1 kB is 1,000 bytes. */
export function bytesText(bytes: number): string {
  if (bytes < 1000) return `${Math.round(bytes)} B`;
  if (bytes < 999.5e3) return `${rounded(bytes / 1e3)} kB`;
  if (bytes < 999.5e6) return `${rounded(bytes / 1e6)} MB`;
  return `${rounded(bytes / 1e9)} GB`;
}

export function geometricMean(values: readonly number[]): number {
  return Math.exp(values.reduce((sum, value) => sum + Math.log(value), 0) / values.length);
}

/**
 * A ratio of two times to two significant digits, as precise as intervals allow: "0.97", "1.0",
 * "19", "1,300".
 */
export function ratioText(ratio: number): string {
  const roundedOff = ratio.toPrecision(2);
  return Number(roundedOff) < 10 ? roundedOff : grouped(Number(roundedOff));
}

function trimmed(value: number): string {
  return String(Number(value.toPrecision(4)));
}

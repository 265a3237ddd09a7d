// Numbers and their formats on the page.

export function between(value: number, min: number, max: number): number {
  return Math.max(min, Math.min(max, value));
}

export function grouped(value: number): string {
  return Math.round(value).toLocaleString("en");
}

/** Three significant digits. */
function digits(value: number): string {
  if (value >= 100) return grouped(value);
  return value.toPrecision(3).replace(/\.?0+$/, "");
}

/** A dash for no time: NaN, or 0 by a clock too coarse for it. */
export function duration(milliseconds: number): string {
  if (!(milliseconds > 0)) return "–";
  if (milliseconds >= 1000) return `${digits(milliseconds / 1000)} s`;
  if (milliseconds >= 1) return `${digits(milliseconds)} ms`;
  return `${digits(milliseconds * 1000)} µs`;
}

export function bytes(count: number): string {
  if (count >= 1e6) return `${digits(count / 1e6)} MB`;
  return count >= 1e3 ? `${digits(count / 1e3)} kB` : `${count} B`;
}

export function plural(count: number, one: string, many = `${one}${one.endsWith("x") ? "es" : "s"}`): string {
  return `${grouped(count)} ${count === 1 ? one : many}`;
}

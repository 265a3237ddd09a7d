// Pages that quote the results: README.md and docs/results.md hold passages that are filled from templates.
//
//   <!-- quote: leads -->
//   what paper/templates/quotes/leads.md gives
//   <!-- end of quote -->
import { listed, Problem } from "./problem.ts";

const passage = /(<!-- quote: ([a-z_]+) -->\n)([\s\S]*?)(<!-- end of quote -->)/g;

/** A page whose passages are filled by name. Throws Problem for a passage that has no template, or no end. */
export function quoted(file: string, page: string, quotes: ReadonlyMap<string, string>): string {
  const begins = page.match(/<!-- quote: /g)?.length ?? 0;
  const filled = page.replace(passage, (_all, begin: string, name: string, _old: string, end: string) => {
    const text = quotes.get(name);
    if (text === undefined) throw new Problem(`${file}: no quote '${name}'; there are ${listed([...quotes.keys()])}`);
    return `${begin}${text}\n\n${end}`;  // a table ends at an empty line
  });
  const whole = page.match(passage)?.length ?? 0;
  if (begins === 0 || whole !== begins)
    throw new Problem(`${file}: ${begins} quotes begin and ${whole} end; expected at least one, and as many ends`);
  return filled;
}

/** What a page says by itself, line by line: lines of quotes are empty. */
export function withoutQuotes(page: string): string {
  return page.replace(passage, (all) => all.replace(/[^\n]/g, ""));
}

/** The names of the quotes on a page. */
export function quotesOn(page: string): string[] {
  return [...page.matchAll(passage)].map((found) => found[2]!);
}

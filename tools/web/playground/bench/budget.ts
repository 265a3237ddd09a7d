// Searches that would take too long are not begun: their number of tests is known beforehand.

/** The tests of a search of all pairs, one at a time or sixteen at once. */
const mostTests = 400e6;

/** Why a search of these many boxes is not begun; undefined where it may. */
export function refusal(spec: string, count: number): string | undefined {
  if (!/^(paper_)?brute_force\b/.test(spec)) return undefined;
  const tests = count * (count - 1) / 2;
  const most = spec.startsWith("paper_") ? mostTests / 8 : mostTests;
  if (tests <= most) return undefined;
  return `Brute force would make ${Math.round(tests / 1e6).toLocaleString("en")} million tests a frame. ` +
    "That would stop the page, so it is left out.";
}

/** The most tests that an observation may record: eight bytes each. */
export const mostObserved = 2_000_000;

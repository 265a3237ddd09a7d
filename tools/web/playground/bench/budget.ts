// Refuses searches that would take too long, by their number of tests, which is known beforehand.

/** Maximum number of tests for a search of all pairs, whether one at a time or sixteen at once. */
const maxTests = 400e6;

/** Why a search of this many boxes is refused; undefined if it may run. */
export function refusal(spec: string, count: number): string | undefined {
  if (!/^(paper_)?brute_force\b/.test(spec)) return undefined;
  const tests = count * (count - 1) / 2;
  const max = spec.startsWith("paper_") ? maxTests / 8 : maxTests;
  if (tests <= max) return undefined;
  return `Brute force would make ${Math.round(tests / 1e6).toLocaleString("en")} million tests a frame. ` +
    "That would stop the page, so it is left out.";
}

/** Maximum number of tests of an observation, at eight bytes each. */
export const maxObserved = 2_000_000;

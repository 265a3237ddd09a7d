// Comparisons of the schema before, "broadside.results/1", as those of today.
import { cases_of } from "./comparison.ts";
import type { Comparison, Measurement, Ratio, RatioName } from "./data.ts";

/** Has no rounds and no ratios, and a field that was always null. */
type OldMeasurement = Omit<Measurement, "rounds" | RatioName> & { search_ms?: null };

export interface OldComparison extends Omit<Comparison, "schema" | "date" | "processor_share" | "busy" | "measurements"> {
  schema: "broadside.results/1";
  measurements: OldMeasurement[];
}

/** To the fastest of `others`, by their medians: old results have no pairs of times, hence no interval. */
function ratioTo(others: readonly Measurement[], measurement: Measurement): Ratio | null {
  const [best] = others
    .filter((other) => other.median_ms !== null)
    .sort((a, b) => Number(a.median_ms) - Number(b.median_ms));
  if (best === undefined || best === measurement || measurement.median_ms === null) return null;
  return { of: best.algorithm, median: measurement.median_ms / Number(best.median_ms), low: null, high: null, rounds: null };
}

/** The same comparison in the shape of "broadside.results/2"; one that is in it already is handed back. */
export function inTodaysShape(comparison: Comparison | OldComparison): Comparison {
  if (comparison.schema !== "broadside.results/1") return comparison;
  const measurements = comparison.measurements.map(({ search_ms: _, ...old }): Measurement => ({
    ...old, rounds: null, ratio_to_fastest: null, ratio_to_best_own: null, ratio_to_fastest_peer: null,
  }));
  for (const { measurements: all } of cases_of(measurements)) {
    const own = all.filter(({ kind, algorithm }) => kind === "own" && algorithm.split(":")[0] !== "auto");
    const peers = all.filter(({ kind }) => kind === "peer");
    for (const measurement of all) {
      measurement.ratio_to_fastest = ratioTo(all, measurement);
      measurement.ratio_to_best_own = ratioTo(own, measurement);
      measurement.ratio_to_fastest_peer = ratioTo(peers, measurement);
    }
  }
  return {
    ...comparison, schema: "broadside.results/2", date: null, processor_share: null, busy: null, measurements,
  };
}

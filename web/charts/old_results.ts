// Comparisons of the schema before, "broadside.results/1", as those of today.
import { bestOwn, casesOf, ranking } from "./comparison.ts";
import type { Comparison, Measurement, Ratio, RatioName } from "./data.ts";

/** Has no rounds and no ratios, and a field that was always null. */
type OldMeasurement = Omit<Measurement, "rounds" | RatioName> & { search_ms?: null };

export interface OldComparison extends Omit<Comparison, "schema" | "date" | "processor_share" | "busy" | "measurements"> {
  schema: "broadside.results/1";
  measurements: OldMeasurement[];
}

/** Over the time of another by their medians: old results have no pairs of times, hence no interval. */
function ratioTo(other: Measurement | undefined, { median_ms }: Measurement): Ratio | null {
  if (other === undefined || other.median_ms === null || median_ms === null) return null;
  return { of: other.algorithm, median: median_ms / other.median_ms, low: null, high: null, rounds: null };
}

/** The same comparison in the shape of "broadside.results/2"; one that is in it already is handed back. */
export function inTodaysShape(comparison: Comparison | OldComparison): Comparison {
  if (comparison.schema !== "broadside.results/1") return comparison;
  const measurements = comparison.measurements.map(({ search_ms: _, ...old }): Measurement => ({
    ...old, rounds: null, ratio_to_fastest: null, ratio_to_best_own: null, ratio_to_fastest_peer: null,
  }));
  for (const of of casesOf(measurements)) {
    const [fastest] = ranking(of);
    const own = bestOwn(of);
    const peer = ranking(of).find(({ kind }) => kind === "peer");
    for (const measurement of of.measurements) {
      measurement.ratio_to_fastest = ratioTo(fastest, measurement);
      measurement.ratio_to_best_own = ratioTo(own, measurement);
      measurement.ratio_to_fastest_peer = ratioTo(peer, measurement);
    }
  }
  return {
    ...comparison, schema: "broadside.results/2", date: null, processor_share: null, busy: null, measurements,
  };
}

// What the comparison with other libraries comes to.
import { casesOf, leadOf, ranking, standings, type Case, type Standing, type Timed } from "../../web/charts/comparison.ts";
import type { Comparison, Ratio } from "../../web/charts/data.ts";
import { isFaster, isLevel } from "../../web/charts/ratios.ts";
import { Problem } from "./problem.ts";

/** A case that both ours and a peer have a time in. */
export interface Lead {
  of: Case;
  /** The time of the fastest peer over that of our fastest. */
  ratio: Ratio;
  own: Timed;
  peer: Timed;
}

/** The time of `auto` in a case over that of the fastest of our others. */
export interface Choice {
  of: Case;
  ratio: Ratio;
}

export interface Facts {
  cases: Case[];
  /** Cases of boxes that rest, and of boxes that move. */
  still: Case[];
  moving: Case[];
  leads: Lead[];
  /** Leads that a peer has on us, and those in which nothing tells the two apart. */
  lost: Lead[];
  level: Lead[];
  choices: Choice[];
  standings: Standing[];
  timed: number;
  skipped: number;
}

function choiceIn(of: Case): Choice[] {
  const ratio = ranking(of).find((measurement) => measurement.algorithm === "auto")?.ratio_to_best_own;
  return ratio ? [{ of, ratio }] : [];
}

/** The leads of some cases. */
export function leadsOf(cases: readonly Case[]): Lead[] {
  return cases.flatMap((of) => {
    const lead = leadOf(of);
    return lead ? [{ of, ...lead }] : [];
  });
}

/** The one with the least ratio of at least one. */
export function least<Thing extends { ratio: Ratio }>(all: readonly Thing[]): Thing {
  return all.reduce((a, b) => (b.ratio.median < a.ratio.median ? b : a));
}

export function greatest<Thing extends { ratio: Ratio }>(all: readonly Thing[]): Thing {
  return all.reduce((a, b) => (b.ratio.median > a.ratio.median ? b : a));
}

/** Throws Problem if there is nothing to compare, or nothing that moves. */
export function factsOf(comparison: Comparison, file: string): Facts {
  const { measurements } = comparison;
  const cases = casesOf(measurements).filter((of) => ranking(of).length > 0);
  const still = cases.filter((of) => of.mode === "find");
  const moving = cases.filter((of) => of.mode === "track");
  for (const [group, what] of [[still, "rest"], [moving, "move"]] as const) {
    if (leadsOf(group).length === 0)
      throw new Problem(`${file}: no case of boxes that ${what} with times of ours and of a peer; expected at least one`);
  }
  const choices = cases.flatMap(choiceIn);
  if (choices.length === 0) throw new Problem(`${file}: no case with a time of auto; expected at least one`);
  const leads = leadsOf(cases);
  return {
    cases,
    still,
    moving,
    leads,
    lost: leads.filter((lead) => isFaster(lead.ratio)),
    level: leads.filter((lead) => isLevel(lead.ratio)),
    choices,
    standings: standings(cases),
    timed: measurements.filter((measurement) => measurement.median_ms !== null).length,
    skipped: measurements.filter((measurement) => measurement.skipped !== null).length,
  };
}

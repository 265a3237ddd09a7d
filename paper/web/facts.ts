// What the comparison with other libraries comes to.
import { casesOf, leadOf, leadOver, ranking, standings, type Case, type LeadOf, type Standing, type Timed } from "../../web/charts/comparison.ts";
import type { Comparison, Ratio } from "../../web/charts/data.ts";
import { inverse, isFaster, isLevel } from "../../web/charts/ratios.ts";
import { Problem } from "./problem.ts";

/** A case that both ours and a peer have a time in. */
export interface Lead extends LeadOf {
  of: Case;
}

/** The time of `auto` in a case over that of the fastest of our others. */
export interface Choice {
  of: Case;
  ratio: Ratio;
}

/** Cases of one kind, and how far ahead we are in them. */
export interface Group {
  /** As sentences name it. */
  name: string;
  cases: Case[];
  leads: Lead[];
  /** Likewise of `auto`, in place of our fastest. */
  autoLeads: Lead[];
  /** Of our fastest over the fastest of the literature's. */
  literature: Lead[];
  /** Of our fastest over the fastest peer that was compiled as it is released, without assertions. */
  released: Lead[];
}

/** One of the literature's algorithms against the fastest peer, in the cases that both do. */
export interface Rival {
  algorithm: string;
  /** In how many of these it takes less time, beyond noise. */
  faster: number;
  /** The time of the fastest peer over its own. */
  ratios: Ratio[];
}

export interface Facts {
  cases: Case[];
  /** Cases of boxes that rest, and of boxes that move. */
  still: Case[];
  moving: Case[];
  /** All cases, each in one group: at rest in 2D and in 3D, moving by a scene's rule, recorded from an engine. */
  groups: Record<"rest_2d" | "rest_3d" | "moving" | "recorded", Group>;
  autoLeads: Lead[];
  /** Cases in which an algorithm by the literature has a time, and the lead over the fastest of these. */
  literature: Lead[];
  leads: Lead[];
  released: Lead[];
  /** The literature's algorithm that is faster than the fastest peer in the most cases. */
  rival: Rival | undefined;
  /** Cases in which a mended listing is faster than the fastest peer. */
  listings: Case[];
  choices: Choice[];
  standings: Standing[];
  timed: number;
  skipped: number;
  unsteady: number;
}

function isAuto({ algorithm }: Timed): boolean {
  return algorithm === "auto";
}

function choiceIn(of: Case): Choice[] {
  const ratio = ranking(of).find(isAuto)?.ratio_to_best_own;
  return ratio ? [{ of, ratio }] : [];
}

/** The leads of some cases. */
export function leadsOf(cases: readonly Case[]): Lead[] {
  return cases.flatMap((of) => {
    const lead = leadOf(of);
    return lead ? [{ of, ...lead }] : [];
  });
}

/** The leads of `auto` over the fastest peer in some cases. */
function autoLeadsOf(cases: readonly Case[]): Lead[] {
  return cases.flatMap((of) => {
    const own = ranking(of).find(isAuto);
    const peer = leadOf(of)?.peer;
    const ratio = own?.ratio_to_fastest_peer;
    if (!own || !peer || !ratio) return [];
    return [{ of, own, peer, ratio: inverse(ratio), own_ms: ratio.ms ?? own.median_ms, peer_ms: ratio.of_ms ?? peer.median_ms }];
  });
}

/** The leads of our fastest over the fastest of those that `counts` accepts. */
function leadsOver(cases: readonly Case[], counts: (measurement: Timed) => boolean): Lead[] {
  return cases.flatMap((of) => {
    const leads = ranking(of).filter(counts).flatMap((measurement) => {
      const lead = leadOver(of, measurement);
      return lead ? [{ of, ...lead }] : [];
    });
    return leads.length > 0 ? [least(leads)] : [];
  });
}

/** Debian compiles these with assertions (docs/peers.md). */
const withAssertions = ["box2d", "embree", "fcl"];

export function hasAssertions({ algorithm }: Timed): boolean {
  return withAssertions.includes(algorithm.split("_", 1)[0]!);
}

function rivalIn(cases: readonly Case[]): Rival | undefined {
  const rivals = new Map<string, Rival>();
  for (const { algorithm, kind, ratio_to_fastest_peer: ratio } of cases.flatMap(ranking)) {
    if (kind !== "literature" || ratio === null) continue;
    const rival = rivals.get(algorithm) ?? { algorithm, faster: 0, ratios: [] };
    rivals.set(algorithm, rival);
    rival.ratios.push(inverse(ratio));
    if (isFaster(ratio)) ++rival.faster;
  }
  return [...rivals.values()].sort((a, b) => b.faster - a.faster)[0];
}

function isListingFaster(of: Case): boolean {
  const ratio = ranking(of).find((measurement) => measurement.kind === "paper")?.ratio_to_fastest_peer;
  return ratio != null && isFaster(ratio);
}

/** The leads that the other has on us, and those in which nothing tells the two apart. */
export const lostOf = (leads: readonly Lead[]): Lead[] => leads.filter(({ ratio }) => isFaster(ratio));
export const levelOf = (leads: readonly Lead[]): Lead[] => leads.filter(({ ratio }) => isLevel(ratio));

/** Whether a scene is one that a physics engine made, which its name says. */
function isRecorded({ scene }: Case): boolean {
  return /^(box2d|bullet|jolt|rapier)_/.test(scene);
}

function groupOf(name: string, cases: Case[]): Group {
  return {
    name,
    cases,
    leads: leadsOf(cases),
    autoLeads: autoLeadsOf(cases),
    literature: leadsOver(cases, ({ kind }) => kind === "literature"),
    released: leadsOver(cases, (one) => one.kind === "peer" && !hasAssertions(one)),
  };
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
  const groups = {
    rest_2d: groupOf("2D, at rest", still.filter((of) => of.dimension === 2)),
    rest_3d: groupOf("3D, at rest", still.filter((of) => of.dimension === 3)),
    moving: groupOf("moving, generated", moving.filter((of) => !isRecorded(of))),
    recorded: groupOf("moving, recorded from engines", moving.filter(isRecorded)),
  };
  const choices = cases.flatMap(choiceIn);
  if (choices.length === 0) throw new Problem(`${file}: no case with a time of auto; expected at least one`);
  const leads = leadsOf(cases);
  return {
    cases,
    still,
    moving,
    groups,
    autoLeads: autoLeadsOf(cases),
    literature: leadsOver(cases, ({ kind }) => kind === "literature"),
    leads,
    released: leadsOver(cases, (one) => one.kind === "peer" && !hasAssertions(one)),
    rival: rivalIn(cases),
    listings: cases.filter(isListingFaster),
    choices,
    standings: standings(cases),
    timed: measurements.filter((measurement) => measurement.median_ms !== null).length,
    skipped: measurements.filter((measurement) => measurement.skipped !== null).length,
    unsteady: measurements.filter((measurement) => measurement.unsteady === true).length,
  };
}

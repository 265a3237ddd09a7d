// What templates may name of the comparison with other libraries.
import { bestOwn, leadOf, ranking, type Case, type Timed } from "../../web/charts/comparison.ts";
import {
  drawLeads,
  drawLibraries,
  drawMeanLeads,
  drawScaling,
  drawStandings,
  drawWinners,
  scaledScenes,
} from "../../web/charts/comparison_charts.ts";
import type { Comparison, Ratio } from "../../web/charts/data.ts";
import type { Drawn, Place } from "../../web/charts/frame.ts";
import { geometricMean, ratioText, rounded } from "../../web/charts/numbers.ts";
import { intervalOf, intervalText, isFaster, isLevel, meanRatio } from "../../web/charts/ratios.ts";
import { greatest, least, leadsOf, type Facts, type Lead } from "./facts.ts";
import { plain, tableText } from "./markdown.ts";
import { listed, Problem } from "./problem.ts";
import { processorName, shown } from "./words.ts";

const mean = (all: readonly { ratio: Ratio }[]) => rounded(geometricMean(all.map(({ ratio }) => ratio.median)));

/** "7.14 (7.05 to 7.23)": a mean of ratios with its interval, as far as it is known. */
function meanText(all: readonly { ratio: Ratio }[]): string {
  const found = meanRatio(all.map(({ ratio }) => ratio));
  const interval = intervalOf(found);
  return interval ? `${rounded(found.median)} (${interval.map(rounded).join(" to ")})` : rounded(found.median);
}

/** What templates may name of a group of leads; where there are none, `any` is false and the texts are not there. */
function leadData(leads: readonly Lead[]): Record<string, unknown> {
  if (leads.length === 0) return { any: false, cases: "0", mean: "-", mean_interval: "-", least: "-", least_case: "-", least_peer: "-" };
  const worst = least(leads);
  return {
    any: true,
    cases: shown(leads.length),
    mean: mean(leads),
    mean_interval: meanText(leads),
    least: ratioText(worst.ratio.median),
    least_interval: intervalText(worst.ratio),
    least_case: worst.of.name,
    least_peer: worst.peer.algorithm,
  };
}

export function comparisonData(facts: Facts, comparison: Comparison): Record<string, unknown> {
  const { command, build, busy, measurements } = comparison;
  const { cases, leads, choices } = facts;
  const worst = greatest(choices);
  const peers = facts.standings.filter((standing) => standing.kind === "peer");
  return {
    /** Whether ratios are of times taken in the same round, with an interval. */
    paired: measurements.some(({ ratio_to_fastest: ratio }) => ratio !== null && intervalOf(ratio) !== undefined),
    busy: busy === true,
    cases: shown(cases.length),
    still_cases: shown(facts.still.length),
    moving_cases: shown(facts.moving.length),
    measurements: shown(facts.timed),
    skipped: shown(facts.skipped),
    peers: shown(peers.length),
    cases_with_a_peer: shown(leads.length),
    mean_lead: mean(leads),
    mean_lead_interval: meanText(leads),
    groups: Object.fromEntries(
      Object.entries(facts.groups).map(([name, group]) =>
        [name, { ...leadData(group.leads), auto: leadData(group.autoLeads) }]),
    ),
    auto_lead: leadData(facts.autoLeads),
    literature: {
      ...leadData(facts.literature),
      algorithms: shown(facts.standings.filter(({ kind }) => kind === "literature").length),
      lost: shown(facts.literature.filter(({ ratio }) => isFaster(ratio)).length),
    },
    date: comparison.date ?? "an unknown day",
    mean_lead_still: mean(leadsOf(facts.still)),
    mean_lead_moving: mean(leadsOf(facts.moving)),
    least_lead: ratioText(least(leads).ratio.median),
    least_lead_interval: intervalText(least(leads).ratio),
    least_lead_case: least(leads).of.name,
    least_lead_peer: least(leads).peer.algorithm,
    greatest_lead: ratioText(greatest(leads).ratio.median),
    greatest_lead_interval: intervalText(greatest(leads).ratio),
    greatest_lead_case: greatest(leads).of.name,
    lost: shown(facts.lost.length),
    level: shown(facts.level.length),
    auto_mean: mean(choices),
    auto_worst: ratioText(worst.ratio.median),
    auto_worst_case: worst.of.name,
    command: command.join(" "),
    revision: build.revision ?? "unknown",
    compiler: build.compiler,
    cpu: processorName(comparison.machine),
    cores: shown(comparison.machine.cores ?? 0),
    os: comparison.machine.os ?? "an unknown system",
  };
}

function casesNamed(facts: Facts, which: string): Case[] {
  const groups: Record<string, Case[]> = { still: facts.still, moving: facts.moving };
  const found = groups[which];
  if (!found) throw new Problem(`no cases '${which}'; there are ${listed(Object.keys(groups))}`);
  return found;
}

/** The leads of our fastest and of auto, a line a group of cases. */
export function groupsTable({ groups, leads, autoLeads }: Facts): string {
  const all = [...Object.values(groups), { name: "all", leads, autoLeads }].filter((group) => group.leads.length > 0);
  const leastText = (some: readonly Lead[]) => (some.length === 0 ? "-" : intervalText(least(some).ratio));
  return tableText(
    ["cases", " how many", " best of ours, mean", " least", " `auto`, mean", " least", " lost", " level"],
    all.map(({ name, leads: some, autoLeads: autos }) => [
      name,
      shown(some.length),
      meanText(some),
      leastText(some),
      autos.length === 0 ? "-" : meanText(autos),
      leastText(autos),
      shown(some.filter(({ ratio }) => isFaster(ratio)).length),
      shown(some.filter(({ ratio }) => isLevel(ratio)).length),
    ]),
  );
}

/** Our fastest against the fastest algorithm by the literature, case by case; a sentence where there is none. */
export function literatureTable({ literature }: Facts): string {
  if (literature.length === 0) return "No algorithm by the literature took part in this comparison.";
  return tableText(
    ["boxes", "ours", " ms", "fastest by the literature", " ms", " lead"],
    literature.map(({ of, own, peer, ratio, own_ms, peer_ms }) => [
      plain(of.name),
      `\`${own.algorithm}\``,
      rounded(own_ms),
      `\`${peer.algorithm}\``,
      rounded(peer_ms),
      isFaster(ratio) ? `**${intervalText(ratio)}**` : intervalText(ratio),
    ]),
  );
}

/** Which of ours other than auto, of the peers and of the draft's is fastest in each case. */
export function leadsTable(facts: Facts, which: string): string {
  return tableText(
    ["boxes", "ours", " ms", "fastest peer", " ms", " lead", "fastest of the draft's", " ms"],
    casesNamed(facts, which).map((of) => {
      const timed = (found: Timed | undefined, ms = found?.median_ms) =>
        found && ms !== undefined ? [`\`${found.algorithm}\``, rounded(ms)] : ["-", "-"];
      const lead = leadOf(of);
      const text = lead === undefined ? "-" : intervalText(lead.ratio);
      return [
        plain(of.name),
        ...timed(lead?.own ?? bestOwn(of), lead?.own_ms),
        ...timed(lead?.peer, lead?.peer_ms),
        lead !== undefined && isFaster(lead.ratio) ? `**${text}**` : text,
        ...timed(ranking(of).find((measurement) => measurement.kind === "paper")),
      ];
    }),
  );
}

/** The cases in which a peer is faster than our best, as a list; a sentence where there is none. */
export function lostList({ lost }: Facts): string {
  if (lost.length === 0) return "In no case was a peer faster than our best.";
  return lost
    .map(
      ({ of, own, peer, ratio, own_ms, peer_ms }) =>
        `- ${plain(of.name)}: \`${peer.algorithm}\` takes ${rounded(peer_ms)} ms, our best, \`${own.algorithm}\`, ` +
        `${rounded(own_ms)} ms, which is a lead of ${intervalText(ratio)}.`,
    )
    .join("\n");
}

const kinds: Record<string, string> = {
  own: "ours", paper: "the draft's", literature: "the literature's", peer: "peer", user: "user's",
};

export function standingsTable(facts: Facts): string {
  return tableText(
    ["algorithm", "whose", " cases", " fastest in", " ratio to the fastest"],
    facts.standings.map(({ algorithm, kind, cases, fastest, ratio }) => [
      `\`${algorithm}\``,
      kinds[kind] ?? kind,
      shown(cases),
      shown(fastest),
      rounded(ratio),
    ]),
  );
}

export interface NamedChart {
  caption: string;
  draw: (place: Place) => Drawn;
}

/** For each group of cases, and for all: the mean lead of our best, and of auto. */
function meanLeads({ groups, leads, autoLeads }: Facts): Parameters<typeof drawMeanLeads>[0] {
  return [...Object.values(groups), { name: "all", leads, autoLeads }].flatMap(({ name, leads: ours, autoLeads: autos }) => [
    ...(ours.length > 0 ? [{ label: `${name}, best`, auto: false, ratio: meanRatio(ours.map(({ ratio }) => ratio)) }] : []),
    ...(autos.length > 0 ? [{ label: `${name}, auto`, auto: true, ratio: meanRatio(autos.map(({ ratio }) => ratio)) }] : []),
  ]);
}

/** The charts of the comparison, by name. */
export function comparisonCharts(facts: Facts): Record<string, NamedChart> {
  const charts: Record<string, NamedChart> = {
    standings: {
      caption: "Times as multiples of the fastest's, geometric mean of the cases that an algorithm does",
      draw: (place) => drawStandings(facts.cases, place),
    },
    libraries: {
      caption: "Auto and the best algorithm of each other library: times as multiples of the fastest algorithm's, " +
        "geometric mean of the cases that an algorithm does",
      draw: (place) => drawLibraries(facts.cases, place),
    },
    groups: {
      caption: "Time of the fastest peer over that of our best, and over that of auto (black): geometric means by " +
        "group of cases, with intervals; at 1 a peer is as fast",
      draw: (place) => drawMeanLeads(meanLeads(facts), place),
    },
    leads_still: {
      caption: "Boxes that rest: time of the fastest peer over that of our best, in the colour of the latter",
      draw: (place) => drawLeads(facts.still, place),
    },
    leads_moving: {
      caption: "Boxes that move: time of the fastest peer over that of our best, in the colour of the latter",
      draw: (place) => drawLeads(facts.moving, place),
    },
    winners: { caption: "The fastest in each case", draw: (place) => drawWinners(facts.cases, place) },
  };
  for (const scene of scaledScenes(facts.still)) {
    charts[`scaling_${scene.scene}_${scene.dimension}d`] = {
      caption: `Time over the number of boxes: ${scene.scene}, ${scene.dimension}D; ours, the draft's and the peers'`,
      draw: (place) => drawScaling(facts.still, scene, place, ["own", "paper", "peer", "literature"], 12),
    };
  }
  return charts;
}

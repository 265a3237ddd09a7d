// What templates may name of the comparison with other libraries.
import { bestOwn, leadOf, percent, ranking, type Case, type Timed } from "../../web/charts/comparison.ts";
import {
  drawLeads,
  drawLibraries,
  drawMeanLeads,
  drawScaling,
  drawStandings,
  drawWinners,
  scaledScenes,
} from "../../web/charts/comparison_charts.ts";
import type { Comparison, Measurement, Ratio } from "../../web/charts/data.ts";
import type { Drawn, Place } from "../../web/charts/frame.ts";
import { geometricMean, ratioText, rounded } from "../../web/charts/numbers.ts";
import { intervalOf, intervalText, isFaster, meanRatio } from "../../web/charts/ratios.ts";
import { greatest, hasAssertions, least, leadsOf, levelOf, lostOf, type Facts, type Lead } from "./facts.ts";
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
  const worst = leads.length === 0 ? undefined : least(leads);
  const [lost, level] = [lostOf(leads), levelOf(leads)];
  return {
    any: worst !== undefined,
    cases: shown(leads.length),
    mean: worst ? mean(leads) : "-",
    mean_interval: worst ? meanText(leads) : "-",
    least: worst ? ratioText(worst.ratio.median) : "-",
    least_interval: worst ? intervalText(worst.ratio) : "-",
    least_case: worst?.of.name ?? "-",
    least_peer: worst?.peer.algorithm ?? "-",
    lost: shown(lost.length),
    any_lost: lost.length > 0,
    lost_named: namedLeads(lost),
    level: shown(level.length),
    any_level: level.length > 0,
    level_named: namedLeads(level),
  };
}

/** "pile, 2D, 2,000 boxes, 100 % moving: 0.84 (0.79 to 0.86); ..." */
const namedLeads = (leads: readonly Lead[]): string =>
  leads.map(({ of, ratio }) => `${plain(of.name)}: ${intervalText(ratio)}`).join("; ");

/** How results were checked: how many by definition, and how many by others that agree, with how many of these. */
function checkedData(measurements: readonly Measurement[]): Record<string, string> {
  const timed = measurements.filter(({ median_ms }) => median_ms !== null);
  const agreeing = timed.flatMap(({ verified_by }) => {
    const [, structures, libraries] = /^cross-checked by (\d+) structures? of (\d+) librar/.exec(verified_by ?? "") ?? [];
    return structures === undefined ? [] : [{ structures: Number(structures), libraries: Number(libraries) }];
  });
  const fewest = (numbers: readonly number[]) => shown(numbers.length === 0 ? 0 : Math.min(...numbers));
  return {
    by_definition: shown(timed.filter(({ verified_by }) => /definition/.test(verified_by ?? "")).length),
    by_others: shown(agreeing.length),
    fewest_structures: fewest(agreeing.map(({ structures }) => structures)),
    fewest_libraries: fewest(agreeing.map(({ libraries }) => libraries)),
  };
}

/** How many times the floor's time our best takes, where there is a floor. */
function floorData(cases: readonly Case[]): Record<string, unknown> {
  const times = cases.flatMap((of) => {
    const own = bestOwn(of);
    return own && of.floor_ms !== null && of.floor_ms > 0 ? [own.median_ms / of.floor_ms] : [];
  });
  const text = (number: number) => (times.length === 0 ? "-" : ratioText(number));
  return { any: times.length > 0, least: text(Math.min(...times)), greatest: text(Math.max(...times)) };
}

/** "Embree 3.13.5", by the names of a library's algorithms. */
function versionsOf(measurements: readonly Measurement[]): Record<string, string> {
  return Object.fromEntries(measurements.filter(({ kind }) => kind === "peer").map(({ algorithm, version }) => [algorithm, version]));
}

/** The version of the library that an algorithm is of: "3.13.5" of embree_collide. Throws Problem. */
export function versionOf({ measurements }: Comparison, algorithm: string): string {
  const versions = versionsOf(measurements);
  const found = versions[algorithm];
  if (found === undefined) throw new Problem(`no peer '${algorithm}'; there are ${listed(Object.keys(versions))}`);
  return found.split(" ").at(-1)!;
}

const rangeText = (numbers: readonly number[], text: (number: number) => string): string => {
  const [low, high] = [Math.min(...numbers), Math.max(...numbers)].map((number) => text(number));
  return low === high ? low! : `${low} to ${high}`;
};

/** How a scene's cases were made: its parameters, numbers of boxes, seeds, and how its boxes move. Throws Problem. */
export function sceneParameters(facts: Facts, scene: string): string {
  const all = facts.cases.filter((of) => of.scene.split(":")[0] === scene).flatMap((of) => of.measurements.slice(0, 1));
  if (all.length === 0)
    throw new Problem(`no scene '${scene}'; there are ${listed([...new Set(facts.cases.map((of) => of.scene.split(":")[0]!))])}`);
  const set = Object.entries(all[0]!.scene_parameters).filter(([name]) => name !== "boxes").map(([name, value]) => `${name} ${value}`);
  const still = all.filter(({ mode }) => mode === "find");
  const moving = all.filter(({ mode }) => mode === "track");
  const of = (some: readonly Measurement[]): string[] => [
    `${rangeText(some.map(({ boxes }) => boxes), shown)} boxes`,
    `${rangeText(some.map(({ seeds }) => seeds.length), shown)} seeds`.replace(/^1 seeds$/, "1 seed"),
  ];
  const drifts = moving.flatMap(({ drift }) => (drift === null ? [] : [drift]));
  return [
    set.join(", "),
    still.length === 0 ? "" : of(still).join(", "),
    moving.length === 0 ? "" : `in motion ${[
      ...of(moving),
      `${rangeText(moving.map(({ frames }) => frames), shown)} frames`,
      `${rangeText(moving.map((one) => one.moving), percent)} moving`,
      ...(drifts.length === 0 ? [] : [`drift ${rangeText(drifts, rounded)}`]),
    ].join(", ")}`,
  ].filter((text) => text !== "").join("; ");
}

/** A time, marked where its samples lie too far apart to be trusted. */
const timeOf = ({ unsteady }: Timed, ms: number): string => `${rounded(ms)}${unsteady === true ? " †" : ""}`;

/** A library that Debian compiles with assertions is marked. */
const peerName = (one: Timed): string => `\`${one.algorithm}\`${hasAssertions(one) ? " ‡" : ""}`;

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
      rival: facts.rival?.algorithm ?? "-",
      rival_cases: shown(facts.rival?.ratios.length ?? 0),
      rival_faster: shown(facts.rival?.faster ?? 0),
      rival_mean: facts.rival ? meanText(facts.rival.ratios.map((ratio) => ({ ratio }))) : "-",
    },
    released: leadData(facts.released),
    listings_faster: shown(facts.listings.length),
    unsteady: shown(facts.unsteady),
    checked: checkedData(measurements),
    floor: floorData(facts.still),
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
    lost: shown(lostOf(leads).length),
    lost_named: namedLeads(lostOf(leads)),
    level: shown(levelOf(leads).length),
    level_named: namedLeads(levelOf(leads)),
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

/** A mean lead, the least, and how many are lost and level. */
function leadCells(leads: readonly Lead[]): string[] {
  if (leads.length === 0) return ["-", "-", "-"];
  return [meanText(leads), intervalText(least(leads).ratio), `${shown(lostOf(leads).length)} / ${shown(levelOf(leads).length)}`];
}

const allGroups = ({ groups, leads, autoLeads, literature, released }: Facts) =>
  [...Object.values(groups), { name: "all", leads, autoLeads, literature, released }].filter((group) => group.leads.length > 0);

/** The leads of auto and of our fastest, a line a group of cases. */
export function groupsTable(facts: Facts): string {
  return tableText(
    ["cases", " how many", " `auto`, mean", " least", " lost / level", " best of ours, mean", " least", " lost / level"],
    allGroups(facts).map(({ name, leads, autoLeads }) => [name, shown(leads.length), ...leadCells(autoLeads), ...leadCells(leads)]),
  );
}

/** The leads of our fastest over others: the literature's algorithms, and peers without those that have assertions. */
export function rivalsTable(facts: Facts): string {
  return tableText(
    ["cases", " over the literature, mean", " least", " lost / level", " over peers without assertions, mean", " least", " lost / level"],
    allGroups(facts).map(({ name, literature, released }) => [name, ...leadCells(literature), ...leadCells(released)]),
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
      timeOf(own, own_ms),
      `\`${peer.algorithm}\``,
      timeOf(peer, peer_ms),
      isFaster(ratio) ? `**${intervalText(ratio)}**` : intervalText(ratio),
    ]),
  );
}

/** Which of ours other than auto, of the peers and of the draft's is fastest in each case; of motion with p99. */
export function leadsTable(facts: Facts, which: string): string {
  const frames = which === "moving";
  const time = frames ? [" ms", " p99"] : [" ms"];
  return tableText(
    ["boxes", "ours", ...time, "fastest peer", ...time, " lead", "fastest of the draft's", ...time],
    casesNamed(facts, which).map((of) => {
      const timed = (found: Timed | undefined, ms = found?.median_ms) => {
        if (!found || ms === undefined) return frames ? ["-", "-", "-"] : ["-", "-"];
        const slow = found.p99_ms === null ? "-" : rounded(found.p99_ms);
        return [peerName(found), timeOf(found, ms), ...(frames ? [slow] : [])];
      };
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
export function lostList({ leads }: Facts): string {
  const lost = lostOf(leads);
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
      caption: "Boxes that rest: time of the fastest peer over that of our best, which is named, with intervals",
      draw: (place) => drawLeads(facts.still, place),
    },
    leads_moving: {
      caption: "Boxes that move: time of the fastest peer over that of our best, which is named, with intervals",
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

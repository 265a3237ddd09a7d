// Charts of a comparison.
import { drawBars } from "./bars.ts";
import type { BarsSpec } from "./bars.ts";
import { isTimed, labelOf, leadOf, percent, ranking, standings } from "./comparison.ts";
import type { Case } from "./comparison.ts";
import type { Measurement, Ratio } from "./data.ts";
import type { Drawn, Place } from "./frame.ts";
import { drawLines } from "./lines.ts";
import { drawMap } from "./map.ts";
import { short, timeText } from "./numbers.ts";
import { intervalOf, intervalText, shortRatioText } from "./ratios.ts";
import { familyColour } from "./theme.ts";
import type { Theme } from "./theme.ts";

const time = { name: "time", unit: "ms", log: true };

function colourOf(measurement: { algorithm: string }, theme: Theme): string {
  return familyColour(measurement.algorithm, theme) ?? theme.muted;
}

const noText = { short: "", full: "none" };

/** Bar values for ratios, with their intervals as whiskers. */
function ratioBars(ratios: readonly (Ratio | null)[]): Pick<BarsSpec, "values" | "whiskers" | "texts"> {
  return {
    values: ratios.map((ratio) => ratio?.median ?? null),
    whiskers: ratios.map((ratio) => (ratio === null ? undefined : intervalOf(ratio))),
    texts: ratios.map((ratio) => (ratio === null ? noText : { short: shortRatioText(ratio), full: intervalText(ratio) })),
  };
}

/** Times of all algorithms in a case, as multiples of the fastest. */
export function drawRatios(of: Case, place: Place): Drawn {
  const ranked = ranking(of);
  return drawBars({
    title: `Times as multiples of the fastest: ${of.name}`,
    x: { name: "algorithm", unit: "" },
    y: { name: "times the fastest's time", unit: "", log: true },
    labels: ranked.map(labelOf),
    ...ratioBars(ranked.map((measurement) => measurement.ratio_to_fastest)),
    colours: ranked.map((measurement) => colourOf(measurement, place.theme)),
    from: 1,
  }, place);
}

/** Geometric mean, over all cases, of each algorithm's time as a multiple of the fastest. */
export function drawStandings(cases: readonly Case[], place: Place): Drawn {
  const shown = standings(cases);
  return drawBars({
    title: "Times as multiples of the fastest, geometric mean of the cases that an algorithm does",
    x: { name: "algorithm", unit: "" },
    y: { name: "times the fastest's time", unit: "", log: true },
    labels: shown.map((standing) => standing.algorithm),
    values: shown.map((standing) => standing.ratio),
    colours: shown.map((standing) => colourOf(standing, place.theme)),
    from: 1,
  }, place);
}

/** How many times as fast our best is as the fastest peer, case by case. */
export function drawLeads(cases: readonly Case[], place: Place): Drawn {
  const leads = cases.flatMap((of) => {
    const lead = leadOf(of);
    return lead === undefined ? [] : [{ of, ...lead }];
  });
  return drawBars({
    title: "The fastest peer's time over that of our best",
    x: { name: "case", unit: "" },
    y: { name: "times as fast", unit: "", log: true },
    labels: leads.map(({ of, own }) => `${shortName(of)}: ${own.algorithm}`),
    ...ratioBars(leads.map(({ ratio }) => ratio)),
    colours: leads.map(({ own }) => colourOf(own, place.theme)),
    from: 1,
  }, place);
}

/** The shortest unambiguous name of a case: "uniform 2D 10k". */
export function shortName(of: Case): string {
  return `${of.scene.replace(":boxes=", " ")} ${of.dimension}D ${sizeText(of)}`;
}

/** The number of boxes, and of moving boxes. */
function sizeText(of: Case): string {
  return short(Number(of.boxes.toPrecision(3))) + (of.mode === "track" ? `, ${percent(of.moving)}` : "");
}

/** Scenes measured with several numbers of boxes and otherwise equal settings. */
export function scaledScenes(cases: readonly Case[]): { scene: string; dimension: number; mode: string; moving: number }[] {
  const groups = new Map<string, { first: Case; counts: Set<number> }>();
  for (const of of cases) {
    const key = JSON.stringify([of.scene, of.dimension, of.mode, of.mode === "track" ? percent(of.moving) : 0]);
    const group = groups.get(key) ?? { first: of, counts: new Set() };
    groups.set(key, group);
    group.counts.add(of.boxes);
  }
  return [...groups.values()].filter(({ counts }) => counts.size > 1)
    .map(({ first: { scene, dimension, mode, moving } }) => ({ scene, dimension, mode, moving }));
}

/**
 * Time over the number of boxes for one of scaledScenes(), with one line for each of at most `maxLines`
 * algorithms.
 */
export function drawScaling(
  cases: readonly Case[], of: ReturnType<typeof scaledScenes>[number], place: Place,
  kinds: readonly Measurement["kind"][] = ["own"], maxLines = 8,
): Drawn {
  const chosen = cases.filter((other) => other.scene === of.scene && other.dimension === of.dimension &&
    other.mode === of.mode && (of.mode === "find" || percent(other.moving) === percent(of.moving)));
  const lines = new Map<string, [number, number][]>();
  for (const other of chosen) {
    for (const measurement of other.measurements) {
      if (!isTimed(measurement) || !kinds.includes(measurement.kind)) continue;
      const points = lines.get(labelOf(measurement)) ?? [];
      lines.set(labelOf(measurement), points);
      points.push([other.boxes, measurement.median_ms]);
    }
  }
  const last = Math.max(...chosen.map((other) => other.boxes));
  // Prefer algorithms with a time for the largest number of boxes, and of these the fastest.
  const rank = (points: readonly [number, number][]): number => {
    const end = points.reduce((a, b) => (b[0] > a[0] ? b : a));
    return end[0] === last ? end[1] : Infinity;
  };
  const shown = [...lines].sort((a, b) => rank(a[1]) - rank(b[1])).slice(0, maxLines);
  const moves = of.mode === "track" ? `, ${percent(of.moving)} moving` : "";
  return drawLines({
    title: `Time over the number of boxes: ${of.scene}, ${of.dimension}D${moves}`,
    x: { name: "boxes", unit: "", log: true },
    y: time,
    lines: shown.map(([name, points]) => ({
      name, points: points.sort((a, b) => a[0] - b[0]), dashed: name.startsWith("paper_"),
    })),
  }, place);
}

/**
 * Frame times of a moving case, one history after the other, with each algorithm's 99th percentile.
 */
export function drawFrames(of: Case, place: Place, maxLines = 6): Drawn {
  const shown = ranking(of).filter((measurement) => (measurement.samples_ms?.length ?? 0) > 1).slice(0, maxLines);
  // Slow algorithms were measured on fewer histories.
  const fewest = Math.min(...shown.map((measurement) => measurement.samples_ms?.length ?? 0));
  const frames = shown[0]?.frames ?? 0;
  return drawLines({
    title: `Time of each frame, and the 99th percentile (dashed): ${of.name}`,
    x: { name: fewest > frames ? `frame (a new history every ${frames})` : "frame", unit: "", log: false },
    y: time,
    plain: true,
    lines: shown.map((measurement) => ({
      name: labelOf(measurement),
      points: (measurement.samples_ms ?? []).slice(0, fewest).map((sample, i) => [i + 1, sample] as const),
      ...(measurement.p99_ms === null ? {} : { level: ["p99", measurement.p99_ms] as const }),
    })),
  }, place);
}

/**
 * The fastest algorithm of each case: scenes and their numbers of boxes on the y axis, dimensions
 * on the x axis.
 */
export function drawWinners(cases: readonly Case[], place: Place): Drawn {
  const rowOf = (of: Case): string => `${of.scene.replace(":boxes=", " ")} ${sizeText(of)}`;
  const fields = cases.flatMap((of) => {
    const best = ranking(of)[0];
    return best === undefined ? [] : [{
      x: `${of.dimension}D`, y: rowOf(of), value: best.algorithm,
      note: `${of.name}: ${timeText(best.median_ms)}`,
    }];
  });
  return drawMap({
    title: "The fastest in each case",
    x: { name: "dimension", unit: "" },
    y: { name: "scene", unit: "" },
    xs: [...new Set(fields.map((field) => field.x))].sort(),
    ys: [...new Set(fields.map((field) => field.y))].reverse(),
    fields,
  }, place);
}

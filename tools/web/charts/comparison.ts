// Ranks algorithms in each case and over all cases, by the rules of lab/measure/ranking.cpp.
import type { Measurement, Ratio, RatioName } from "./data.ts";
import { geometricMean, grouped } from "./numbers.ts";

/** Measurements of the same boxes. */
export interface Case {
  name: string;
  scene: string;
  dimension: number;
  boxes: number;
  moving: number;
  mode: "find" | "track";
  floor_ms: number | null;
  measurements: Measurement[];
}

export interface Timed extends Measurement {
  median_ms: number;
}

export function isTimed(measurement: Measurement): measurement is Timed {
  return measurement.median_ms !== null;
}

export function percent(share: number): string {
  return `${Number((share * 100).toPrecision(2))} %`;
}

/**
 * Name of an algorithm, with its number of threads if it uses several and the spec does not say so.
 */
export function labelOf(measurement: Measurement): string {
  const saysThreads = measurement.algorithm.split(":").includes(`threads=${measurement.threads}`);
  return measurement.threads > 1 && !saysThreads ? `${measurement.algorithm} (${measurement.threads} threads)` : measurement.algorithm;
}

/** The cases of the measurements, in their order. */
export function casesOf(measurements: readonly Measurement[]): Case[] {
  const cases = new Map<string, Case>();
  for (const measurement of measurements) {
    const { scene, dimension, boxes, moving, mode, frames, left, filtered, drift, teleport, floor_ms } = measurement;
    const key = JSON.stringify([
      scene, dimension, boxes, moving, mode, frames, left, filtered, drift, teleport, measurement.seeds,
    ]);
    let found = cases.get(key);
    if (found === undefined) {
      const moves = mode === "track" ? `, ${percent(moving)} moving` : "";
      const sets = left === undefined ? "" : `, ${percent(left)} joined with ${percent(1 - left)}`;
      const filters = filtered ? ", filtered" : "";
      const name = `${scene}, ${dimension}D, ${grouped(boxes)} boxes${sets}${filters}${moves}`;
      found = { name, scene, dimension, boxes, moving, mode, floor_ms, measurements: [] };
      cases.set(key, found);
    }
    found.measurements.push(measurement);
  }
  return [...cases.values()];
}

/** The measurements that have a time, fastest first. */
export function ranking(of: Case): Timed[] {
  return of.measurements.filter(isTimed).sort((a, b) => a.median_ms - b.median_ms);
}

/**
 * The measurement that the case's ratios of this name refer to; the fastest of `those` if the case
 * has no ratios.
 */
function referenceOf(of: Case, name: RatioName, those: readonly Timed[]): Timed | undefined {
  const spec = of.measurements.find((measurement) => measurement[name] !== null)?.[name]?.of;
  return those.find(({ algorithm }) => algorithm === spec) ?? those[0];
}

/**
 * Our fastest algorithm other than auto, which runs one of the others; auto if it is the only one.
 */
export function bestOwn(of: Case): Timed | undefined {
  const own = ranking(of).filter((measurement) => measurement.kind === "own");
  const others = own.filter(({ algorithm }) => algorithm.split(":", 1)[0] !== "auto");
  return referenceOf(of, "ratio_to_best_own", others.length > 0 ? others : own);
}

/** The fastest peer's time over that of our best; undefined if either is missing. */
export function leadOf(of: Case): { ratio: Ratio; own: Timed; peer: Timed } | undefined {
  const own = bestOwn(of);
  const peer = referenceOf(of, "ratio_to_fastest_peer", ranking(of).filter(({ kind }) => kind === "peer"));
  const ratio = peer?.ratio_to_best_own;
  return own === undefined || peer === undefined || !ratio ? undefined : { ratio, own, peer };
}

export interface Standing {
  algorithm: string;
  kind: Measurement["kind"];
  cases: number;
  fastest: number;
  /** Geometric mean of its times over those of the fastest. */
  ratio: number;
}

/** Standing of every algorithm that has a time, best first. */
export function standings(cases: readonly Case[]): Standing[] {
  const ratios = new Map<string, { kind: Measurement["kind"]; ratios: number[]; fastest: number }>();
  for (const of of cases) {
    for (const measurement of ranking(of)) {
      const label = labelOf(measurement);
      const entry = ratios.get(label) ?? { kind: measurement.kind, ratios: [], fastest: 0 };
      ratios.set(label, entry);
      entry.ratios.push(measurement.ratio_to_fastest?.median ?? 1);
      if (measurement.ratio_to_fastest?.of === measurement.algorithm) ++entry.fastest;
    }
  }
  return [...ratios]
    .map(([algorithm, entry]) => ({
      algorithm,
      kind: entry.kind,
      cases: entry.ratios.length,
      fastest: entry.fastest,
      ratio: geometricMean(entry.ratios),
    }))
    .sort((a, b) => a.ratio - b.ratio);
}

// Small results and templates, to make papers from in tests.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { cwd } from "node:process";

import type { Comparison, Experiments, Measurement } from "../../../web/charts/data.ts";
import { inRounds, untold } from "../../../web/tests/fixture.ts";

function folderWith(path: string, from: string): string {
  if (existsSync(join(from, path))) return from;
  if (dirname(from) === from) throw new Error(`no folder above ${cwd()} has ${path}`);
  return folderWith(path, dirname(from));
}

/** The project's folder; tests run in it or below. */
export const project = folderWith("paper/templates", cwd());

const machine = { cpu: "A CPU", cores: 2, memory_bytes: 4e9, os: "An OS" };
const build = { version: "0.1.0", revision: "abc", compiler: "GNU 12", type: "Release", flags: "-O3" };

export function experiments(): Experiments {
  return {
    schema: "broadside.experiments/2",
    machine,
    build,
    target: "AVX2",
    date: "2026-11-21",
    command: ["broadside", "experiment"],
    quick: false,
    stopped: false,
    experiments: [
      {
        label: "1",
        name: "tests",
        title: "Tests grow | squarely",
        claim: "There are n*n tests.",
        section: "II",
        measured: "Tests.",
        seconds: 1.5,
        statements: [
          {
            label: "1a",
            name: "growth",
            text: "tests grow | squarely",
            verdict: "holds within bounds",
            condition: "there are more than 12 boxes",
            threshold: "more than 1",
            evidence: ["crossover", "slope"],
          },
          { label: "1b", name: "square", text: "n items make n*n", verdict: "not testable", condition: "a tautology", evidence: [] },
        ],
        reason: "12,000 tests.",
        figures: {
          crossover: { value: 12, unit: "boxes", low: null, high: null },
          slope: { value: 1.5, unit: "", low: 1.25, high: 1.75 },
          memory: { value: 2_761_234, unit: "bytes", low: null, high: null },
        },
        tables: [
          {
            name: "times",
            title: "Times",
            columns: [{ name: "boxes", unit: "" }, { name: "time", unit: "ms" }],
            charts: [
              {
                title: "Time over boxes",
                kind: "lines",
                x: "boxes",
                y: "time",
                series: "",
                value: "",
                log_x: true,
                log_y: true,
                where: [],
              },
            ],
            rows: [
              [10, 1.23456],
              [100, null],
              [1000, 123.456],
            ],
          },
        ],
      },
    ],
  };
}

function measurement(algorithm: string, kind: Measurement["kind"], median_ms: number, moving = 0): Measurement {
  return {
    scene: "uniform",
    scene_parameters: {},
    seeds: [1],
    dimension: 2,
    boxes: 1000,
    frames: moving > 0 ? 5 : 0,
    moving,
    drift: null,
    teleport: null,
    algorithm,
    version: "1",
    kind,
    mode: moving > 0 ? "track" : "find",
    threads: 1,
    target: null,
    pairs: 7,
    pair_hash: "0",
    verified: true,
    verified_by: "the definition",
    skipped: null,
    median_ms,
    min_ms: median_ms,
    p99_ms: median_ms,
    max_ms: median_ms,
    samples_ms: null,
    build_ms: null,
    ns_per_box: null,
    ns_per_mover: null,
    floor_ms: null,
    tests: null,
    references: null,
    explanation: null,
    own_bytes: null,
    peak_bytes: null,
    ...untold,
  };
}

export function withoutRatios(): Comparison {
  return {
    schema: "broadside.results/2",
    date: "2026-11-21",
    processor_share: 0.998,
    busy: false,
    machine,
    build,
    command: ["broadside", "compare"],
    stopped: false,
    measurements: [
      measurement("auto", "own", 1.1),
      measurement("grid", "own", 1),
      measurement("boost_rtree", "peer", 8),
      measurement("paper_grid", "paper", 4),
      measurement("auto", "own", 2, 0.1),
      measurement("bvh", "own", 2.5, 0.1),
      measurement("bullet_dbvt", "peer", 1, 0.1),
    ],
  };
}

export function comparison(): Comparison {
  return inRounds(withoutRatios());
}

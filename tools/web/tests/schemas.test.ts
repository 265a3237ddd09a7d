// The JSON Schemas in docs/schemas/ accept the program's output and reject invalid documents. Needs
// the program in BROADSIDE_PROGRAM; without it, only fixtures and committed results are checked.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { Ajv2020 } from "ajv/dist/2020.js";

import { comparison, doubtful } from "./fixture.ts";

const program = process.env["BROADSIDE_PROGRAM"] ?? "";
const project = existsSync("docs/schemas") ? "." : "..";
const missing = existsSync(program) ? false : "BROADSIDE_PROGRAM names no program";

// Strict: an unknown or misplaced keyword in a schema is an error.
const ajv = new Ajv2020({ strict: true, allowUnionTypes: true, strictRequired: false });

type Json = Record<string, unknown>;

const readJson = (path: string): Json => JSON.parse(readFileSync(path, "utf8")) as Json;

/** A function that returns what is wrong with a document; empty if nothing is. */
function checker(name: string): (document: unknown) => string {
  const validate = ajv.compile(readJson(join(project, "docs/schemas", `${name}.schema.json`)));
  return (document) => (validate(document) ? "" : ajv.errorsText(validate.errors));
}

const faultOfResults = checker("results-2");
const faultOfAdvice = checker("advice-2");

const [first] = comparison.measurements;
const failed = {
  ...first, verified: false, skipped: "on seed 1: 3 pairs; expected 4", rounds: 0, median_ms: null, min_ms: null, p99_ms: null,
  max_ms: null, samples_ms: null, unsteady: null, ns_per_box: null, ratio_to_fastest: null, ratio_to_best_own: null,
  ratio_to_fastest_peer: null,
};

test("comparisons fit their schema: doubtful ones, without samples, with a failure", () => {
  assert.equal(faultOfResults(comparison), "");
  assert.equal(faultOfResults(doubtful), "");
  const measurements = [{ ...first, samples_ms: null }, failed];
  assert.equal(faultOfResults({ ...comparison, measurements }), "");
});

test("comparisons that are wrong do not", () => {
  const faultOf = (changes: Json): string => faultOfResults({ ...comparison, measurements: [{ ...first, ...changes }] });
  const ratio = first?.ratio_to_fastest;
  assert.equal(faultOf({}), "");
  assert.match(faultOf({ floor_ms: undefined }), /must have required property 'floor_ms'/);
  assert.match(faultOf({ search_ms: null }), /must NOT have additional properties/);
  assert.match(faultOf({ boxes: "1000" }), /boxes must be integer/);
  assert.match(faultOf({ median_ms: null }), /median_ms must be number/);
  assert.match(faultOf({ ratio_to_fastest: { ...ratio, rounds: 0 } }), /rounds must be >= 1/);
  assert.match(faultOf({ ratio_to_fastest: { ...ratio, low: undefined } }), /must have required property 'low'/);
  assert.match(faultOfResults({ ...comparison, measurements: [{ ...failed, median_ms: 1 }] }), /median_ms must be null/);
  assert.match(faultOfResults({ ...comparison, date: undefined }), /must have required property 'date'/);
  assert.match(faultOfResults({ ...comparison, date: "today" }), /date must match pattern/);
});

describe("the program", { skip: missing }, () => {
  let folder: string;

  /** JSON written by the program. */
  function written(...words: string[]): Json {
    const path = join(folder, "out.json");
    execFileSync(program, [...words, "--json", path]);
    return readJson(path);
  }

  before(() => {
    folder = mkdtempSync(join(tmpdir(), "broadside-schemas-"));
  });

  after(() => rmSync(folder, { recursive: true, force: true }));

  test("writes comparisons that fit their schema: still, moving, skipped", () => {
    // The paper's grid does not support 3D, so it is skipped there.
    const results = written("compare", "--scenes", "uniform", "-n", "60", "--moving", "0,0.5", "--frames", "3",
      "--algorithms", "auto,grid,paper_grid,paper_brute_force");
    assert.equal(faultOfResults(results), "");
    const measurements = results["measurements"] as Json[];
    for (const [name, value] of [["mode", "find"], ["mode", "track"], ["verified", null], ["verified", true]] as const)
      assert.ok(measurements.some((measurement) => measurement[name] === value), `${name} ${value}`);
  });

  test("writes advice that fits its schema: still, moving, none", () => {
    const quick = ["-n", "60", "--budget", "0.05"];
    const still = written("advise", "uniform", ...quick);
    assert.equal(faultOfAdvice(still), "");
    assert.equal(faultOfAdvice(written("advise", "churn", ...quick, "--frames", "4")), "");
    const path = join(folder, "none.json");
    const words = ["advise", "uniform", ...quick, "--dimension", "3", "--algorithms", "paper_grid", "--json", path];
    assert.equal(spawnSync(program, words).status, 1);
    assert.equal(faultOfAdvice(readJson(path)), "");
    assert.equal(readJson(path)["advice"], null);
    assert.match(faultOfAdvice({ ...still, busy: undefined }), /must have required property 'busy'/);
  });
});

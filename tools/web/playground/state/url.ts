// Writes the state to the part of an address after "#", and reads it back. Only values that differ
// from the defaults are written. The scene determines the defaults of the number of boxes and of
// the panels.
import { defaultKnobs, type Knobs } from "../scene/drift.ts";
import type { Edit } from "../scene/edits.ts";
import type { PanelChoice } from "../bench/protocol.ts";
import { fileScene, sceneEntries } from "../scene/catalogue.ts";
import { maxBoxes, maxPanels, defaultState, startOf, type Mode, type State } from "./state.ts";

/** Four significant digits are finer than a pixel. */
function short(value: number): string {
  return String(Number(value.toPrecision(5)));
}

const editNumbers = ["box", "time", "x", "y", "width", "height", "vx", "vy"] as const;

function writeEdits(edits: readonly Edit[]): string {
  return edits.map((edit) => editNumbers.map((name) => short(edit[name])).join("_")).join("~");
}

function readEdits(text: string): { valid: Edit[]; invalid: number } {
  const parts = text.split("~").filter((one) => one !== "");
  const valid = parts.flatMap((one) => {
    const numbers = one.split("_").map(Number);
    if (numbers.length !== editNumbers.length || !numbers.every(Number.isFinite)) return [];
    const edit = Object.fromEntries(editNumbers.map((name, at) => [name, numbers[at]])) as unknown as Edit;
    return Number.isInteger(edit.box) && edit.box >= 0 && edit.box < 2 * maxBoxes ? [edit] : [];
  });
  return { valid, invalid: parts.length - valid.length };
}

function writePanels(panels: readonly PanelChoice[]): string {
  return panels.map(({ spec, follow }) => (follow ? "follow " : "") + spec).join(";");
}

function readPanels(text: string): PanelChoice[] {
  return text.split(";").filter((one) => one !== "").map((one) => {
    const follow = one.startsWith("follow ");
    return { follow, spec: follow ? one.slice("follow ".length) : one };
  });
}

const knobNames: Record<keyof Knobs, [min: number, max: number]> = {
  ratio: [1, 1000], clustering: [0, 1], moving: [0, 1], speed: [0, 10],
};

/** All that an address may set. */
const names: ReadonlySet<string> = new Set([
  ...Object.keys(knobNames), "mode", "lesson", "scene", "n", "seed", "a", "panel", "structure", "overlaps", "up", "box", "paused",
  "pace", "t", "edits", "steps", "step", "stepboxes", "cell", "capacity", "embed",
]);

/** The state at a given time, such as "scene=drift&n=500&a=grid:cell=4;bvh&t=2.5". */
export function writeState(state: State, time: number): string {
  const query = new URLSearchParams();
  const put = (name: string, value: string, defaultValue: string): void => {
    if (value !== defaultValue) query.set(name, value);
  };
  const { scene, steps } = state;
  const usual = defaultState;
  const start = startOf(scene.name);
  put("mode", state.mode, usual.mode);
  if (state.mode === "lesson") query.set("lesson", String(state.lesson + 1));
  put("scene", scene.name, usual.scene.name);
  put("n", String(scene.count), String(start.count));
  put("seed", String(scene.seed), String(usual.scene.seed));
  for (const name of Object.keys(knobNames) as (keyof Knobs)[])
    put(name, short(scene.knobs[name]), short(defaultKnobs[name]));
  put("a", writePanels(state.panels), writePanels(start.panels));
  put("panel", String(state.panel), "0");
  put("structure", state.structure ? "1" : "0", "1");
  put("overlaps", state.overlaps ? "1" : "0", "1");
  put("up", state.up ? "1" : "0", "0");
  put("box", String(state.selected), "-1");
  put("paused", state.playing ? "0" : "1", "0");
  put("pace", short(state.pace), "1");
  put("t", short(time), "0");
  put("edits", writeEdits(state.edits), "");
  if (state.mode === "steps") {
    put("steps", steps.algorithm, usual.steps.algorithm);
    put("step", String(steps.at), "0");
    put("stepboxes", String(steps.count), String(usual.steps.count));
    put("cell", short(steps.cell), "0");
    put("capacity", String(steps.capacity), String(usual.steps.capacity));
  }
  if (state.embed) query.set("embed", "");
  // These are allowed unescaped in an address, and more readable.
  return query.toString().replace(/%3A/g, ":").replace(/%3D/g, "=").replace(/%3B/g, ";").replace(/%2C/g, ",")
    .replace(/embed=$/, "embed");
}

/** The items as a list: "a, b or c". */
function listed(items: readonly unknown[]): string {
  return items.length < 2 ? items.join() : `${items.slice(0, -1).join(", ")} or ${items[items.length - 1]}`;
}

/**
 * Reads an address, before and after "#". Invalid values are replaced by defaults or by the nearest valid ones; `faults`
 * are sentences that say so.
 */
export function readState(search: string, hash: string): { state: State; time: number; faults: string[] } {
  const faults: string[] = [];
  const query = new URLSearchParams(search.replace(/^\?/, ""));
  new URLSearchParams(hash.replace(/^#/, "")).forEach((value, name) => {
    query.set(name, value);
    if (!names.has(name)) faults.push(`${name}=${value}: the page has no such setting.`);
  });
  const usual = defaultState;
  const flag = (name: string, defaultValue: boolean): boolean => {
    const value = query.get(name);
    return value === null ? defaultValue : value !== "0" && value !== "false";
  };
  const number = (name: string, defaultValue: number, min: number, max: number): number => {
    const text = query.get(name) ?? "";
    if (text.trim() === "") return defaultValue;
    const value = Number(text);
    const kept = Number.isFinite(value) ? Math.min(max, Math.max(min, value)) : defaultValue;
    if (kept !== value)
      faults.push(`${name}=${text}: expected a number from ${min} to ${max.toLocaleString("en")}; the page takes ${kept}.`);
    return kept;
  };
  const whole = (name: string, defaultValue: number, min: number, max: number): number =>
    Math.round(number(name, defaultValue, min, max));
  const oneOf = <Value extends string>(name: string, values: readonly Value[], defaultValue: Value): Value => {
    const text = query.get(name);
    const found = values.find((value) => value === text);
    if (text !== null && found === undefined)
      faults.push(`${name}=${text}: ${values.length > 5 ? "there is none" : `expected ${listed(values)}`}; the page takes ${defaultValue}.`);
    return found ?? defaultValue;
  };
  const knobs = { ...defaultKnobs };
  for (const [name, [min, max]] of Object.entries(knobNames) as [keyof Knobs, [number, number]][])
    knobs[name] = number(name, defaultKnobs[name], min, max);
  const panels = readPanels(query.get("a") ?? "");
  if (panels.length > maxPanels) faults.push(`a: ${panels.length} panels; the page shows the first ${maxPanels}.`);
  const scene = oneOf("scene", [...sceneEntries.map(({ name }) => name), fileScene], usual.scene.name);
  const start = startOf(scene);
  const shownPanels = panels.length > 0 ? panels.slice(0, maxPanels) : start.panels;
  const edits = readEdits(query.get("edits") ?? "");
  if (edits.invalid > 0) faults.push(`edits: ${edits.invalid} of them not of eight numbers; the page leaves them out.`);
  return {
    faults,
    time: number("t", 0, 0, 1e6),
    state: {
      mode: query.has("lesson") ? "lesson" : oneOf<Mode>("mode", ["play", "steps", "lesson"], usual.mode),
      lesson: whole("lesson", 1, 1, 7) - 1,
      scene: {
        name: scene,
        count: whole("n", start.count, 1, maxBoxes),
        seed: whole("seed", usual.scene.seed, 0, 2 ** 31 - 1),
        knobs,
      },
      edits: edits.valid,
      panels: shownPanels,
      panel: whole("panel", 0, 0, shownPanels.length - 1),
      structure: flag("structure", true),
      overlaps: flag("overlaps", true),
      up: flag("up", false),
      selected: whole("box", -1, -1, 2 * maxBoxes),
      playing: !flag("paused", false),
      pace: number("pace", 1, 0.05, 10),
      steps: {
        algorithm: oneOf("steps", ["brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"], usual.steps.algorithm),
        at: whole("step", 0, 0, 1e6),
        count: whole("stepboxes", usual.steps.count, 2, 40),
        cell: number("cell", 0, 0, 1000),
        capacity: whole("capacity", usual.steps.capacity, 1, 32),
      },
      embed: query.has("embed") && query.get("embed") !== "0",
    },
  };
}

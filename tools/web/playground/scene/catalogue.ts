// The scenes by name: the one with sliders, lines, the presets, and a file.
import { presets } from "../presets.ts";
import { drift, type Knobs } from "./drift.ts";
import { line } from "./line.ts";
import { followingBounds, usualBounds, type Scene } from "./scene.ts";

/** Selects a scene. */
export interface SceneChoice {
  name: string;
  count: number;
  seed: number;
  knobs: Knobs;
}

export interface SceneEntry {
  name: string;
  title: string;
  summary: string;
  dimension: 2 | 3;
  /** Initial number of boxes. */
  count: number;
  /** Whether the four sliders apply. */
  knobs: boolean;
  /** The algorithm that it breaks, and the reason. */
  breaks?: { spec: string; follow: boolean; why: string };
}

export const fileScene = "file";

const sliders: SceneEntry[] = [
  {
    name: "drift", title: "Drifting boxes", dimension: 2, count: 400, knobs: true,
    summary: "Boxes that drift and bounce. The sliders change sizes, clusters and motion.",
  },
  {
    name: "drift3", title: "Drifting boxes in 3D", dimension: 3, count: 300, knobs: true,
    summary: "The same in 3D. Drag the background to turn the camera.",
  },
];

const lines: SceneEntry[] = [
  {
    name: "street", title: "A street", dimension: 2, count: 200, knobs: false,
    summary: "Boxes along x. A sweep along x meets few at a time.",
  },
  {
    name: "tower", title: "A tower", dimension: 2, count: 40, knobs: false,
    summary: "Boxes above each other. On x nearly all of them overlap, so a sweep along x compares nearly all.",
  },
];

/** "a_huge_floor" becomes "A huge floor". */
function titleOf(name: string): string {
  const words = name.replace(/[_-]/g, " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

export const sceneEntries: readonly SceneEntry[] = [
  ...sliders,
  ...lines,
  ...presets.map(({ name, summary, dimension, count, breaks, follows, why }) => ({
    name, title: titleOf(name), summary, dimension, count, knobs: false, breaks: { spec: breaks, follow: follows, why },
  })),
];

export function sceneEntry(name: string): SceneEntry | undefined {
  return sceneEntries.find((entry) => entry.name === name);
}

/** The sliders' values as text, such as "ratio=3 clustering=0"; empty for a scene without sliders. */
export function settingsText({ name, knobs }: SceneChoice): string {
  if (sceneEntry(name)?.knobs !== true) return "";
  return Object.entries(knobs).map(([knob, value]) => `${knob}=${Number((value as number).toPrecision(3))}`).join(" ");
}

/** The scene of that name. Throws if there is none. */
export function makeScene({ name, count, seed, knobs }: SceneChoice): Scene {
  if (name === "drift") return drift(2, count, seed, knobs);
  if (name === "drift3") return drift(3, count, seed, knobs);
  if (name === "street") return line(0, count, seed);
  if (name === "tower") return line(1, count, seed);
  const preset = presets.find((one) => one.name === name);
  if (preset === undefined)
    throw new Error(`scene "${name}"; expected one of ${sceneEntries.map((entry) => entry.name).join(", ")}`);
  const first = preset.boxes(count, seed, 0);
  const bounds = usualBounds(first, preset.dimension);
  return {
    dimension: preset.dimension,
    bounds,
    boundsAt: followingBounds(bounds, first, preset.dimension),
    duration: Infinity,
    at: (time) => preset.boxes(count, seed, time),
  };
}

// The state of the page: all that a link holds.
import { standardKnobs } from "../scene/drift.ts";
import type { Edit } from "../scene/edits.ts";
import type { PanelChoice } from "../bench/protocol.ts";
import { sceneEntry, type SceneChoice } from "../scene/catalogue.ts";
import type { StepAlgorithm } from "../engine/types.ts";

export type Mode = "play" | "steps" | "lesson";

export interface State {
  mode: Mode;
  scene: SceneChoice;
  edits: readonly Edit[];
  panels: readonly PanelChoice[];
  /** Which panel's counts the sliders and the line to copy are about. */
  panel: number;
  structure: boolean;
  overlaps: boolean;
  selected: number;
  playing: boolean;
  /** Seconds of the scene in a second. */
  pace: number;
  /** The lesson, from 0. */
  lesson: number;
  steps: { algorithm: StepAlgorithm; at: number; count: number; cell: number; capacity: number };
  embed: boolean;
}

export const mostPanels = 4;
export const mostBoxes = 100_000;

export const standardState: State = {
  mode: "play",
  scene: { name: "drift", count: 300, seed: 1, knobs: standardKnobs },
  edits: [],
  panels: [{ spec: "grid", follow: false }],
  panel: 0,
  structure: true,
  overlaps: true,
  selected: -1,
  playing: true,
  pace: 1,
  lesson: 0,
  steps: { algorithm: "grid", at: 0, count: 12, cell: 0, capacity: 3 },
  embed: false,
};

/** What a scene begins with, whether the menu or a link names it: how many boxes, and which panels show them. */
export function startOf(scene: string): { count: number; panels: readonly PanelChoice[] } {
  const entry = sceneEntry(scene);
  const count = entry?.count ?? standardState.scene.count;
  if (entry?.breaks === undefined) return { count, panels: standardState.panels };
  // A preset shows what it breaks, beside what does better.
  const { spec, follow } = entry.breaks;
  return { count, panels: [{ spec, follow }, { spec: "auto", follow }] };
}

// The state of the page: everything that a link holds.
import { defaultKnobs } from "../scene/drift.ts";
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
  /** The panel that the sliders and the code to copy refer to. */
  panel: number;
  structure: boolean;
  overlaps: boolean;
  /** Whether y grows upwards in the picture, as on a map; otherwise downwards, as on a screen. */
  up: boolean;
  selected: number;
  playing: boolean;
  /** Scene seconds per second. */
  pace: number;
  /** The lesson, from 0. */
  lesson: number;
  steps: { algorithm: StepAlgorithm; at: number; count: number; cell: number; capacity: number };
  embed: boolean;
}

export const maxPanels = 4;
export const maxBoxes = 100_000;

export const defaultState: State = {
  mode: "play",
  scene: { name: "drift", count: 400, seed: 1, knobs: defaultKnobs },
  edits: [],
  // Small enough cells for many rows.
  panels: [{ spec: "grid:cell=8", follow: false }],
  panel: 0,
  structure: true,
  overlaps: true,
  up: false,
  selected: -1,
  playing: true,
  pace: 1,
  lesson: 0,
  steps: { algorithm: "grid", at: 0, count: 12, cell: 0, capacity: 3 },
  embed: false,
};

/** A scene's initial number of boxes and panels, whether it was chosen in the menu or by a link. */
export function startOf(scene: string): { count: number; panels: readonly PanelChoice[] } {
  const entry = sceneEntry(scene);
  const count = entry?.count ?? defaultState.scene.count;
  if (entry?.breaks === undefined) return { count, panels: defaultState.panels };
  // A preset shows the algorithm that it breaks beside a better one.
  const { spec, follow } = entry.breaks;
  return { count, panels: [{ spec, follow }, { spec: "auto", follow }] };
}

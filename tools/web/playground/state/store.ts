// The state as signals: settings, current results, and their changes.
import { batch, computed, signal } from "@preact/signals";

import type { Algorithm } from "../engine/types.ts";
import type { Duel, Measured, PanelChoice, Setup, Shown } from "../bench/protocol.ts";
import { fileScene, sceneEntry } from "../scene/catalogue.ts";
import { countWith, withEdit, type Edit } from "../scene/edits.ts";
import { maxPanels, defaultState, startOf, type State } from "./state.ts";

export const state = signal<State>(defaultState);
/** Current scene time in seconds. The results on screen have their own time in `shown`. */
export const clock = signal(0);
/** The latest time so far: the end of the scrubbing range. */
export const latest = signal(0);
export const shown = signal<Shown | null>(null);
/**
 * `shown`, updated a few times per second, for text: numbers that change in every frame are
 * unreadable.
 */
export const told = signal<Shown | null>(null);
export const dimension = computed(() => shown.value?.dimension ?? 2);
export const duration = computed(() => shown.value?.duration ?? Infinity);
export const algorithms = signal<Algorithm[]>([]);
/** The box held by the pointer. */
export const held = signal<Edit | null>(null);
/** An error, as a sentence. */
export const problem = signal("");
/** Text for screen readers. */
export const said = signal("");
export const measured = signal<readonly Measured[]>([]);
export const measuring = signal(false);
export const duel = signal<Duel | null>(null);
export const duelling = signal(false);
/** The name of the file whose boxes are shown. */
export const fileName = signal("");
/** Whether a drag is recorded as a sequence of edits. */
export const recording = signal(false);

export function patch(change: Partial<State>): void {
  state.value = { ...state.value, ...change };
}

export const setup = computed<Setup>(() => {
  const { scene, edits, panels, structure, overlaps, selected } = state.value;
  return { scene, edits, panels, structure, overlaps, selected };
});

/** Identifies the boxes that the chart's times refer to. */
export const timesKey = computed(() => {
  const { name, seed, knobs } = state.value.scene;
  return JSON.stringify([name, seed, knobs]);
});

/** The number of boxes, including added ones. */
export const count = computed(() => countWith(state.value.scene.count, state.value.edits));

export function chooseScene(name: string): void {
  const entry = sceneEntry(name);
  if (entry === undefined && name !== fileScene) return;
  batch(() => {
    const { scene } = state.value;
    const start = startOf(name);
    patch({
      scene: { ...scene, name, count: entry === undefined ? scene.count : start.count },
      // Files have maps and meshes.
      edits: [], selected: -1, up: name === fileScene,
    });
    // A scene without its own panels keeps the current ones.
    if (entry?.breaks !== undefined) patch({ panels: start.panels, panel: 0 });
    clock.value = 0;
    latest.value = 0;
    problem.value = "";
  });
}

export function changeScene(change: Partial<State["scene"]>): void {
  // Added boxes keep their indices only if the scene's count stays the same.
  const kept = change.count === undefined || change.count === state.value.scene.count;
  patch({
    scene: { ...state.value.scene, ...change },
    ...(kept ? {} : { edits: [], selected: -1 }),
  });
}

export function changePanel(at: number, change: Partial<PanelChoice>): void {
  patch({ panels: state.value.panels.map((panel, one) => one === at ? { ...panel, ...change } : panel) });
}

export function addPanel(spec: string): void {
  const { panels } = state.value;
  if (panels.length < maxPanels) patch({ panels: [...panels, { spec, follow: false }] });
}

export function removePanel(at: number): void {
  const panels = state.value.panels.filter((_, one) => one !== at);
  if (panels.length > 0) patch({ panels, panel: Math.min(state.value.panel, panels.length - 1) });
}

export function edit(one: Edit): void {
  patch({ edits: withEdit(state.value.edits, one) });
}

export function say(text: string): void {
  said.value = text;
}

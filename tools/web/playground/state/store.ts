// The state as signals: what is chosen, what is shown, and how it changes.
import { batch, computed, signal } from "@preact/signals";

import type { Algorithm } from "../engine/types.ts";
import type { Duel, Measured, PanelChoice, Setup, Shown } from "../bench/protocol.ts";
import { fileScene, sceneEntry } from "../scene/catalogue.ts";
import { countWith, withEdit, type Edit } from "../scene/edits.ts";
import { mostPanels, standardState, startOf, type State } from "./state.ts";

export const state = signal<State>(standardState);
/** The scene's seconds. Of what is on the screen, `shown` has its own. */
export const clock = signal(0);
/** The latest time that there was: how far one can scrub. */
export const latest = signal(0);
export const shown = signal<Shown | null>(null);
/** The same some times a second, for what is read: numbers that change in each frame cannot be. */
export const told = signal<Shown | null>(null);
export const dimension = computed(() => shown.value?.dimension ?? 2);
export const duration = computed(() => shown.value?.duration ?? Infinity);
export const algorithms = signal<Algorithm[]>([]);
/** A box that the pointer holds. */
export const held = signal<Edit | null>(null);
/** What went wrong, as a sentence. */
export const problem = signal("");
/** What screen readers are told. */
export const said = signal("");
export const measured = signal<readonly Measured[]>([]);
export const measuring = signal(false);
export const duel = signal<Duel | null>(null);
export const duelling = signal(false);
/** The name of the file whose boxes are shown. */
export const fileName = signal("");
/** Whether what the pointer does to boxes is kept as it is done. */
export const recording = signal(false);

export function patch(change: Partial<State>): void {
  state.value = { ...state.value, ...change };
}

export const setup = computed<Setup>(() => {
  const { scene, edits, panels, structure, overlaps, selected } = state.value;
  return { scene, edits, panels, structure, overlaps, selected };
});

/** What the chart's times are of. */
export const timesKey = computed(() => {
  const { name, seed, knobs } = state.value.scene;
  return JSON.stringify([name, seed, knobs]);
});

/** The number of boxes, with those that were added. */
export const count = computed(() => countWith(state.value.scene.count, state.value.edits));

export function chooseScene(name: string): void {
  const entry = sceneEntry(name);
  if (entry === undefined && name !== fileScene) return;
  batch(() => {
    const { scene } = state.value;
    const start = startOf(name);
    patch({ scene: { ...scene, name, count: entry === undefined ? scene.count : start.count }, edits: [], selected: -1 });
    // A scene without panels of its own keeps those that are there.
    if (entry?.breaks !== undefined) patch({ panels: start.panels, panel: 0 });
    clock.value = 0;
    latest.value = 0;
    problem.value = "";
  });
}

export function changeScene(change: Partial<State["scene"]>): void {
  // Boxes that were added keep their numbers only while the scene's number stays.
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
  if (panels.length < mostPanels) patch({ panels: [...panels, { spec, follow: false }] });
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

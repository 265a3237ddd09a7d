// A lesson: some text, boxes to look at, and an exercise that checks itself.
import type { ComponentChildren } from "preact";

import type { Duel, PanelChoice, Shown } from "../bench/protocol.ts";
import { defaultKnobs, type Knobs } from "../scene/drift.ts";
import type { SceneChoice } from "../scene/catalogue.ts";
import { nameOf } from "../state/spec.ts";
import type { State } from "../state/state.ts";

/** Facts by which an exercise is judged. */
export interface Facts {
  state: State;
  shown: Shown;
  duel: Duel | null;
}

export interface Verdict {
  done: boolean;
  /** The current status, as a sentence. */
  text: string;
}

export interface Exercise {
  task: ComponentChildren;
  /** The controls that the task speaks of. */
  control: () => ComponentChildren;
  hint: ComponentChildren;
  /** Whether it can be done with these panels. If not, its controls first bring back those of the lesson's start. */
  suits(panels: readonly PanelChoice[]): boolean;
  /** The setting of the boxes that it is about. If others differ from the start, its controls bring back the start's. */
  knob?: keyof Knobs;
  /** Whether it is about several scenes, so that none is brought back. */
  hasScenes?: true;
  check(facts: Facts): Verdict;
}

/** A button in the text that shows something. */
export interface Try {
  label: string;
  state: Partial<State>;
}

export interface Lesson {
  title: string;
  text: ComponentChildren;
  tries: readonly Try[];
  /** Initial state of the lesson. */
  start: Partial<State> & Pick<State, "scene" | "panels">;
  exercise: Exercise;
  /** Whether boxes have shadows on the axis of the sweep. */
  drawsShadows?: boolean;
}

/** Whether the panels search by these specs, or by others of the same names where a spec is a name alone. */
export function areOf(panels: readonly PanelChoice[], ...specs: readonly string[]): boolean {
  return specs.every((spec, at) => [panels[at]?.spec, nameOf(panels[at]?.spec ?? "")].includes(spec));
}

export function scene(name: string, count: number, knobs: Partial<Knobs> = {}): SceneChoice {
  return { name, count, seed: 1, knobs: { ...defaultKnobs, ...knobs } };
}

export function panels(...specs: readonly string[]): PanelChoice[] {
  return specs.map((spec) => ({ spec, follow: false }));
}

// A lesson: some text, boxes to look at, and an exercise that checks itself.
import type { ComponentChildren } from "preact";

import type { Duel, PanelChoice, Shown } from "../bench/protocol.ts";
import { defaultKnobs, type Knobs } from "../scene/drift.ts";
import type { SceneChoice } from "../scene/catalogue.ts";
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
  start: Partial<State>;
  exercise: Exercise;
  /** Whether boxes have shadows on the axis of the sweep. */
  drawsShadows?: boolean;
}

export function scene(name: string, count: number, knobs: Partial<Knobs> = {}): SceneChoice {
  return { name, count, seed: 1, knobs: { ...defaultKnobs, ...knobs } };
}

export function panels(...specs: readonly string[]): PanelChoice[] {
  return specs.map((spec) => ({ spec, follow: false }));
}

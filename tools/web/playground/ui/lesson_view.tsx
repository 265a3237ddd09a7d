// A lesson: its text before the picture, its exercise after it.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";

import { lessons } from "../lessons/index.ts";
import type { Lesson, Verdict } from "../lessons/lesson.ts";
import type { Knobs } from "../scene/drift.ts";
import type { State } from "../state/state.ts";
import { clock, duel, latest, patch, say, shown, state } from "../state/store.ts";
import { wholeView } from "./view.ts";

/** Applies a change of state that the lesson requests. */
function show(change: Partial<State>): void {
  clock.value = 0;
  latest.value = 0;
  duel.value = null;
  wholeView();
  patch({ edits: [], selected: -1, panel: 0, playing: true, structure: true, overlaps: true, ...change });
}

export function openLesson(at: number): void {
  show({ ...lessons[at]!.start, mode: "lesson", lesson: at });
}

/** Brings back what the exercise needs of the lesson's start, and leaves the rest as it is. */
function restore({ start, exercise }: Lesson): void {
  const { scene, panels } = state.value;
  const knobs = Object.keys(start.scene.knobs) as (keyof Knobs)[];
  const isSame = exercise.hasScenes === true || (scene.name === start.scene.name && scene.count === start.scene.count &&
    knobs.every((name) => name === exercise.knob || scene.knobs[name] === start.scene.knobs[name]));
  if (!isSame) patch({ scene: start.scene, edits: [], selected: -1 });
  if (!exercise.suits(panels)) patch({ panels: start.panels, panel: start.panel ?? 0 });
}

export function LessonText() {
  const at = state.value.lesson;
  const lesson = lessons[at]!;
  return (
    <article class="card lesson" aria-labelledby="lesson-title">
      <nav class="row" aria-label="Lessons">
        {lessons.map(({ title }, one) => (
          <button key={title} type="button" aria-current={one === at ? "true" : undefined} title={title}
            aria-label={`Lesson ${one + 1}: ${title}`} onClick={() => openLesson(one)}>{one + 1}</button>
        ))}
      </nav>
      <h1 id="lesson-title">{at + 1}. {lesson.title}</h1>
      {lesson.text}
      <div class="row tries">
        <span>Show:</span>
        {lesson.tries.map(({ label, state: change }) =>
          <button key={label} type="button" onClick={() => show({ ...lesson.start, ...change })}>{label}</button>)}
      </div>
    </article>
  );
}

export function LessonExercise() {
  const at = state.value.lesson;
  return (
    <div class="card lesson-exercise">
      <ExerciseView key={at} lesson={lessons[at]!} />
      {at + 1 < lessons.length &&
        <button type="button" onClick={() => openLesson(at + 1)}>Next: {lessons[at + 1]!.title}</button>}
    </div>
  );
}

function ExerciseView({ lesson }: { lesson: Lesson }) {
  const done = useSignal(false);
  const verdict = useSignal<Verdict | null>(null);
  useEffect(() => {
    const judge = (): void => {
      // The results must be those of the current settings, and of one time.
      const now = shown.value;
      const { panels, scene } = state.value;
      const specs = (all: readonly { spec: string }[]): string => all.map(({ spec }) => spec).join(";");
      if (now === null || specs(now.panels) !== specs(panels) || JSON.stringify(now.scene) !== JSON.stringify(scene) ||
        now.panels.some(({ late }) => late)) return;
      const next = lesson.exercise.check({ state: state.value, shown: now, duel: duel.value });
      if (next.text !== verdict.value?.text || next.done !== verdict.value.done) verdict.value = next;
      if (next.done && !done.value) {
        done.value = true;
        say("Exercise done");
      }
    };
    const timer = setInterval(judge, 250);
    return () => clearInterval(timer);
  }, [lesson]);
  return (
    <section class={`exercise ${verdict.value?.done === true ? "done" : ""}`} aria-label="Exercise">
      <h2>Exercise {done.value && <span class="badge">{verdict.value?.done === true ? "Done" : "Done before"}</span>}</h2>
      {lesson.exercise.task}
      {/* Before the control's own handler. */}
      <div onInputCapture={() => restore(lesson)} onChangeCapture={() => restore(lesson)}>{lesson.exercise.control()}</div>
      <p class="verdict">{verdict.value?.text ?? "…"}</p>
      <div class="row">
        <button type="button" onClick={() => show(lesson.start)}>Start again</button>
      </div>
      <details><summary>Hint</summary>{lesson.exercise.hint}</details>
    </section>
  );
}

import { signal } from "@preact/signals";

import { nameOf } from "../state/spec.ts";
import { PanelAlgorithm } from "../ui/algorithm_choice.tsx";
import { Race } from "../ui/challenge_card.tsx";
import { duration } from "../ui/numbers.ts";
import { panels, scene, type Lesson } from "./lesson.ts";

const cases = [
  { name: "a group of 20", scene: scene("drift", 20, { ratio: 2 }) },
  { name: "a street of 40,000", scene: scene("street", 40_000) },
  { name: "20,000 spread evenly", scene: scene("drift", 20_000, { moving: 0 }) },
] as const;

/** Names of the cases with a good enough choice. */
const solved = signal<ReadonlySet<string>>(new Set());

/** Maximum ratio to the fastest time that is good enough. */
const enough = 1.5;

export const choosing: Lesson = {
  title: "How to choose",
  start: { scene: cases[0].scene, panels: panels("quadtree"), structure: true },
  tries: cases.map(({ name, scene: one }) => ({ label: name, state: { scene: one, panels: panels("quadtree") } })),
  text: (
    <>
      <p>No algorithm suits all boxes. How many are there? Are they spread evenly, along a line, or in clusters? Do sizes
        differ? How many move? The answers decide:</p>
      <ul>
        <li>up to some 64 on this page, or 300 in a native program: <code>brute_force</code>, there is nothing to build;</li>
        <li>from there to some four thousand: <code>grid</code>, however they lie, since all fit in the processor's cache;</li>
        <li>more, spread over the plane or space: <code>grid</code> as well;</li>
        <li>more, along a line: <code>sweep_and_prune</code>, one sorted sweep finds all pairs;</li>
        <li>more, crowded or in dense clusters: <code>bvh</code>, whose bounds fit themselves to the boxes;</li>
        <li>you do not know: <code>auto</code>, which looks at the boxes and decides so for you;</li>
        <li>it is important: measure, with your own boxes.</li>
      </ul>
    </>
  ),
  exercise: {
    task: <p>Show one of the three cases with its button above, <b>{cases[0].name}</b>, <b>{cases[1].name}</b> or{" "}
      <b>{cases[2].name}</b>. Choose an algorithm (not <code>auto</code>), then press <b>Race</b>. Your algorithm may take
      at most {enough} times as long as the fastest one. Do so for all three.</p>,
    control: () => <><PanelAlgorithm panel={0} label="Algorithm" /><Race /></>,
    hint: <p>The list above has a line for each of the three.</p>,
    suits: (now) => now.length > 0,
    hasScenes: true,
    check({ state, duel }) {
      const now = cases.find((one) => one.scene.name === state.scene.name && one.scene.count === state.scene.count);
      const spec = state.panels[0]?.spec ?? "";
      const mine = duel?.others.find((one) => one.spec === nameOf(spec));
      const best = duel?.others[0];
      let text = now === undefined ? "Show one of the three cases." : `Choose for ${now.name}, and race.`;
      if (spec !== nameOf(spec)) text = `Take ${nameOf(spec)} as it is: the race takes no tunables.`;
      else if (now !== undefined && mine !== undefined && best !== undefined) {
        const good = mine.milliseconds <= enough * best.milliseconds;
        text = mine === best ? `${spec} is the fastest here: ${duration(mine.milliseconds)}.`
          : `${spec} took ${duration(mine.milliseconds)}; the fastest, ${best.spec}, took ${duration(best.milliseconds)}.`;
        text += good ? " That counts; you need not race again." : " That is too slow: choose another one.";
        if (good && !solved.value.has(now.name)) solved.value = new Set([...solved.value, now.name]);
      }
      const left = cases.filter(({ name }) => !solved.value.has(name));
      return {
        done: left.length === 0,
        text: `${text} ${left.length === 0 ? "All three are done." : `Left: ${left.map(({ name }) => name).join(", ")}.`}`,
      };
    },
  },
};

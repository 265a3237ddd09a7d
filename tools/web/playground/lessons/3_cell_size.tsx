import { nameOf } from "../state/spec.ts";
import { TunableField } from "../ui/algorithm_card.tsx";
import { grouped } from "../ui/numbers.ts";
import { areOf, panels, scene, type Lesson } from "./lesson.ts";

/** Limit on tests plus references; the best cell size needs about 1,600. */
const maxTests = 1800;

export const cellSize: Lesson = {
  title: "The cell-size cliff",
  start: { scene: scene("drift", 500), panels: panels("paper_grid:cell=60") },
  tries: [
    { label: "Large cells", state: { scene: scene("drift", 500), panels: panels("paper_grid:cell=60") } },
    { label: "Tiny cells", state: { scene: scene("drift", 500), panels: panels("paper_grid:cell=0.6") } },
    { label: "Sizes that differ", state: {
      scene: scene("drift", 500, { ratio: 20 }), panels: panels("paper_grid:cell=5", "grid:cell=8") } },
  ],
  text: (
    <>
      <p>A <b>grid</b> puts each box into every cell that it touches, and compares only boxes of the same cell. Large
        cells hold many boxes, so there are many <b>tests</b>. In tiny cells there are few tests, but a box is in many of
        them, and each entry, a <b>reference</b>, costs memory and time. Somewhere between is the best size, and on both
        sides it gets steep.</p>
      <p>A pair that shares several cells would be found in each. It is reported in one alone: the cell that holds the
        greater of the two minima on each axis, the <b>reference point</b>.</p>
      <p>Where sizes differ much, no cell suits all. The library's <code>grid</code> therefore cuts one axis only, into
        rows as long as the world, and sweeps each row. So a long box is in few rows. Left to itself, it takes rows of at
        least some thirty boxes, and a single one for a few hundred: the picture then shows one frame.</p>
    </>
  ),
  exercise: {
    task: <p>Move the slider <b>cell</b> until tests and references of <code>paper_grid</code> add up to less than{" "}
      {grouped(maxTests)} for these 500 boxes.</p>,
    control: () => <TunableField panel={0} name="cell" of="paper_grid:cell=60" />,
    hint: <p>Take cells about twice as wide as a usual box, and look at both counts while you drag.</p>,
    suits: (now) => areOf(now, "paper_grid"),
    check({ shown, state }) {
      const panel = shown.panels.find(({ spec }) => nameOf(spec) === "paper_grid");
      if (panel === undefined) return { done: false, text: "Keep paper_grid in a panel." };
      const { scene: { name, count, knobs } } = state;
      if (name !== "drift" || count < 500 || knobs.ratio !== 3 || !panel.spec.includes("cell="))
        return { done: false, text: "This is about the 500 boxes that the lesson begins with, and a cell that you set." };
      const { tests, references } = panel.statistics;
      return {
        done: panel.error === undefined && tests + references < maxTests,
        text: `${grouped(tests)} tests and ${grouped(references)} references: ${grouped(tests + references)}.`,
      };
    },
  },
};

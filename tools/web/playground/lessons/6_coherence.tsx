import { grouped } from "../ui/numbers.ts";
import { KnobSlider } from "../ui/scene_card.tsx";
import { scene, type Lesson } from "./lesson.ts";

const both = [{ spec: "grid", follow: false }, { spec: "grid:update=follow", follow: true }];

export const coherence: Lesson = {
  title: "What coherence buys",
  start: { scene: scene("drift", 1000, { moving: 1 }), panels: both, panel: 1 },
  tries: [
    { label: "All move", state: { scene: scene("drift", 1000, { moving: 1 }), panels: both } },
    { label: "One in five moves", state: { scene: scene("drift", 1000, { moving: 0.2 }), panels: both } },
    { label: "None moves", state: { scene: scene("drift", 1000, { moving: 0 }), panels: both } },
  ],
  text: (
    <>
      <p>From one frame to the next little changes: that is <b>coherence</b>. A search starts from nothing each time. A{" "}
        <b>tracker</b> keeps its structure, moves the boxes that moved, and tells which pairs <b>began</b> and which{" "}
        <b>ended</b>. Boxes at rest cost it nothing.</p>
      <p>The second panel draws what its tracker keeps: square cells, and larger ones for larger boxes, each box in the
        one cell that holds its corner of least x and y. A box that moves is taken out of its cell, put into another one,
        and compared with the boxes of the cells near it; no other box is looked at.</p>
      <p>Updating one moving box costs more than one box's share of a new search. So it pays while few boxes move; where
        nearly all do, a new search is as good or better. The library's trackers choose between the two by themselves; here,{" "}
        <code>update=follow</code> keeps it to following.</p>
    </>
  ),
  exercise: {
    task: <p>Both panels show the same boxes; the second one reuses its last frame. Change how many boxes move, but
      keep <b>some moving</b>, until the second panel makes <b>less than half</b> of the first one's tests.</p>,
    control: () => <KnobSlider name="moving" />,
    hint: <p>A tracker compares each box that moves with many boxes near it, so let only a few move.</p>,
    suits: (now) => now.length === 2 && now.every(({ follow }, at) => follow === both[at]!.follow),
    knob: "moving",
    check({ shown, state }) {
      const searching = shown.panels.find((_, at) => state.panels[at]?.follow === false);
      const following = shown.panels.find((_, at) => state.panels[at]?.follow === true);
      if (searching === undefined || following === undefined)
        return { done: false, text: "Keep a panel that searches anew and one that reuses its last frame." };
      const { name, count, knobs } = state.scene;
      if (name !== "drift" || count < 1000 || knobs.moving < 0.01 || knobs.speed < 0.1 || !state.playing)
        return { done: false, text: "Keep 1,000 drifting boxes, some of them moving." };
      const [a, b] = [searching.statistics.tests, following.statistics.tests];
      return {
        done: a > 0 && b < a / 2 && searching.pairs === following.pairs,
        text: `The search makes ${grouped(a)} tests a frame, the tracker ${grouped(b)}.`,
      };
    },
  },
};

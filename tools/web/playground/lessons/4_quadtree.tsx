import { grouped } from "../ui/numbers.ts";
import { KnobSlider } from "../ui/scene_card.tsx";
import { areOf, panels, scene, type Lesson } from "./lesson.ts";

const count = 400;
const both = panels("paper_grid:cell=10", "paper_quadtree:capacity=8");

/** Few move, or the clusters would dissolve. */
const boxes = (clustering: number) => scene("drift", count, { clustering, moving: 0.1 });

/** How many times as many tests the grid is to make. */
const times = 1.5;

export const quadtree: Lesson = {
  title: "Cells that split: the quadtree",
  start: { scene: boxes(0), panels: both },
  tries: [
    { label: "Spread evenly", state: { scene: boxes(0), panels: both } },
    { label: "Small leaves", state: {
      scene: boxes(0), panels: panels("paper_grid:cell=10", "paper_quadtree:capacity=2") } },
    { label: "Large leaves", state: {
      scene: boxes(0), panels: panels("paper_grid:cell=10", "paper_quadtree:capacity=40") } },
  ],
  text: (
    <>
      <p>Equal cells suit boxes that are spread evenly. Where boxes crowd, a cell holds too many; elsewhere it holds
        none. A <b>quadtree</b> is a grid that is fine only where the boxes are: the <b>root</b> is the whole world, and
        a <b>leaf</b> that holds more boxes than its <b>capacity</b> is split into four. Brute force then runs in each
        leaf.</p>
      <p>A box on a border is in several leaves, as in a grid, so the same reference point decides which leaf reports a
        pair. Splitting has to stop somewhere: boxes that share a point share a leaf, however small it is. Leaves of few
        boxes save tests, and cost references and nodes.</p>
    </>
  ),
  exercise: {
    task: <p>Both panels search the same {count} boxes, the first in equal cells, the second in a quadtree. Pull the boxes
      into clusters until the cells make <b>one and a half times</b> the tests of the tree.</p>,
    control: () => <KnobSlider name="clustering" />,
    hint: <p>The tighter the clusters, the more boxes share a cell, and there the tree splits. Beyond some 90 % the boxes of
      a cluster overlap so much that splitting no longer separates them: the tree then makes more tests than the cells,
      though still fewer than brute force.</p>,
    suits: (now) => areOf(now, ...both.map(({ spec }) => spec)),
    knob: "clustering",
    check({ shown, state }) {
      const [cells, tree] = both.map((panel) => shown.panels.find(({ spec }) => spec === panel.spec)?.statistics.tests);
      if (cells === undefined || tree === undefined)
        return { done: false, text: "This is about cells of 10 and leaves of up to 8 boxes, with which the lesson begins." };
      if (state.scene.name !== "drift" || state.scene.count < count)
        return { done: false, text: `This is about the ${count} boxes that the lesson begins with.` };
      return {
        done: tree > 0 && cells >= times * tree,
        text: `${grouped(cells)} tests in cells, ${grouped(tree)} in the tree: ${(cells / Math.max(1, tree)).toFixed(1)} times.`,
      };
    },
  },
};

import { nameOf } from "../state/spec.ts";
import { plural } from "../ui/numbers.ts";
import { KnobSlider } from "../ui/scene_card.tsx";
import { areOf, panels, scene, type Lesson } from "./lesson.ts";

const count = 400;
const both = panels("paper_quadtree:capacity=8", "bvh");

/** References a box that the quadtree is to need. */
const references = 5;

export const bvh: Lesson = {
  title: "Bounds that fit: the BVH",
  start: { scene: scene("drift", count), panels: both, panel: 1 },
  tries: [
    { label: "Sizes alike", state: { scene: scene("drift", count), panels: both } },
    { label: "Clusters", state: { scene: scene("drift", count, { clustering: 0.8 }), panels: both } },
    { label: "Step through one", state: { mode: "steps", steps: { algorithm: "bvh", at: 0, count: 12, cell: 0, capacity: 3 } } },
  ],
  text: (
    <>
      <p>Grids and quadtrees divide space, and a box is in every part that it touches. A <b>bounding volume
        hierarchy</b> (BVH) divides the boxes: near ones share a <b>leaf</b>, near leaves share a parent, and each node
        keeps the <b>bounds</b> of all that is below it. A box is in one leaf, whatever its size. Nothing is declared
        about the world, and clusters get small bounds.</p>
      <p>The tree is joined with itself, from the root on. Where the bounds of two nodes are apart, so are all boxes below
        them: the <b>descent</b> ends there. Where they overlap, their children are compared, at last boxes. The price:
        bounds of neighbours overlap, so some nodes are compared in vain.</p>
    </>
  ),
  exercise: {
    task: <p>Let sizes differ until the quadtree has <b>{references} references for each box</b>. How many has the BVH?</p>,
    control: () => <KnobSlider name="ratio" />,
    hint: <p>A large box touches many leaves of the quadtree.</p>,
    suits: (now) => areOf(now, "paper_quadtree", "bvh"),
    knob: "ratio",
    check({ shown, state }) {
      const of = (name: string) => shown.panels.find(({ spec }) => nameOf(spec) === name)?.statistics.references;
      const [tree, bounds] = [of("paper_quadtree"), of("bvh")];
      if (tree === undefined || bounds === undefined)
        return { done: false, text: "Keep paper_quadtree in one panel and bvh in the other." };
      if (state.scene.name !== "drift" || state.scene.count < count)
        return { done: false, text: `This is about the ${count} boxes that the lesson begins with.` };
      return {
        done: tree >= references * shown.present,
        text: `${plural(shown.present, "box")}: the quadtree has ${plural(tree, "reference")}, the BVH ${plural(bounds, "reference")}.`,
      };
    },
  },
};

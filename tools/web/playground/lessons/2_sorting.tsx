import { nameOf } from "../state/spec.ts";
import { TunableField } from "../ui/algorithm_card.tsx";
import { plural } from "../ui/numbers.ts";
import { panels, scene, type Lesson } from "./lesson.ts";

const maxTests = 1500;

export const sorting: Lesson = {
  title: "Why sorting helps",
  drawsShadows: true,
  start: { scene: scene("tower", 200), panels: panels("sweep_and_prune:axis=x:axes=1") },
  tries: [
    { label: "A street", state: { scene: scene("street", 200), panels: panels("sweep_and_prune:axis=x:axes=1") } },
    { label: "Its tests of a box", state: {
      scene: scene("street", 200), panels: panels("sweep_and_prune:axis=x:axes=1"), selected: 20 } },
    { label: "A tower", state: { scene: scene("tower", 200), panels: panels("sweep_and_prune:axis=x:axes=1") } },
  ],
  text: (
    <>
      <p>Sort the boxes by where they begin on x. Then go along: a box has to be tested only against those that begin
        before it ends. As soon as one begins later, so do all that follow, and the search for this box is over. This is{" "}
        <b>sweep and prune</b>: the sort takes n log n steps, or n with a radix sort, and the tests are those of boxes
        whose shadows on x overlap. The bars below the picture show these shadows.</p>
      <p>On a street, few shadows overlap. In a tower nearly all do, and the sweep is brute force again. So the axis matters.</p>
    </>
  ),
  exercise: {
    task: <p>Sweep the tower of 200 boxes with fewer than {maxTests} tests, without taking another algorithm.</p>,
    control: () => <TunableField panel={0} name="axis" />,
    hint: <p>Choose the axis along which the boxes' shadows overlap least.</p>,
    check({ shown, state }) {
      const panel = shown.panels[0];
      if (panel === undefined || nameOf(panel.spec) !== "sweep_and_prune")
        return { done: false, text: "Keep sweep_and_prune in the first panel." };
      if (state.scene.name !== "tower" || state.scene.count < 200)
        return { done: false, text: "This is about the tower, with its 200 boxes." };
      const { tests } = panel.statistics;
      return { done: panel.error === undefined && tests < maxTests, text: `The sweep makes ${plural(tests, "test")}.` };
    },
  },
};

import { nameOf } from "../state/spec.ts";
import { TunableField } from "../ui/algorithm_card.tsx";
import { plural } from "../ui/numbers.ts";
import { areOf, panels, scene, type Lesson } from "./lesson.ts";

const count = 40;

/** Most tests of a good sweep; along the wrong axis there are some 700. */
const maxTests = 150;

const alongX = "sweep_and_prune:axis=x:axes=1";

const along = (name: "street" | "tower") => ({ scene: scene(name, count), panels: panels(alongX) });

export const sorting: Lesson = {
  title: "Why sorting helps",
  drawsShadows: true,
  start: along("tower"),
  tries: [
    { label: "A street", state: along("street") },
    { label: "Its tests of a box", state: { ...along("street"), selected: 20 } },
    { label: "A tower", state: along("tower") },
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
    task: <p>Sweep the tower of {count} boxes with fewer than {maxTests} tests, without taking another algorithm.</p>,
    control: () => <TunableField panel={0} name="axis" of={alongX} />,
    hint: <p>Choose the axis along which the boxes' shadows overlap least.</p>,
    suits: (now) => areOf(now, "sweep_and_prune"),
    check({ shown, state }) {
      const panel = shown.panels[0];
      if (panel === undefined || nameOf(panel.spec) !== "sweep_and_prune")
        return { done: false, text: "Keep sweep_and_prune in the first panel." };
      if (state.scene.name !== "tower" || state.scene.count < count)
        return { done: false, text: `This is about the tower, with its ${count} boxes.` };
      const { tests } = panel.statistics;
      return { done: panel.error === undefined && tests < maxTests, text: `The sweep makes ${plural(tests, "test")}.` };
    },
  },
};

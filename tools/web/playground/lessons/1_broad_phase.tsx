import { PanelAlgorithm } from "../ui/algorithm_choice.tsx";
import { grouped, plural } from "../ui/numbers.ts";
import { areOf, panels, scene, type Lesson } from "./lesson.ts";

export const broadPhase: Lesson = {
  title: "What a broad phase is",
  start: { scene: scene("drift", 200), panels: panels("brute_force", "brute_force"), panel: 1 },
  tries: [
    { label: "50 boxes", state: { scene: scene("drift", 50), panels: panels("brute_force") } },
    { label: "100 boxes", state: { scene: scene("drift", 100), panels: panels("brute_force") } },
    { label: "Select a box", state: { scene: scene("drift", 100), panels: panels("brute_force"), selected: 4 } },
  ],
  text: (
    <>
      <p>A game, a robot or a map wants to know which things touch. Comparing two shapes exactly costs much, so each shape
        gets a box around it, with sides along the axes. Where the boxes are apart, so are the shapes. Finding the boxes
        that overlap is the <b>broad phase</b>; looking at the shapes of those few pairs is the narrow phase.</p>
      <p>Two boxes overlap if they overlap on each axis: that is one <b>test</b>, four comparisons in 2D. The plain way is{" "}
        <b>brute force</b>: test each box against each later one. With n boxes that is n (n − 1) / 2 tests, whatever the
        boxes. Twice as many boxes take four times as many tests. Try it:</p>
    </>
  ),
  exercise: {
    task: <p>Both panels search by brute force. Let the second one take another algorithm that finds <b>the same pairs</b>{" "}
      with <b>less than a tenth</b> of the tests.</p>,
    control: () => <PanelAlgorithm panel={1} label="The second panel's algorithm" />,
    hint: <p>Brute force appears twice in the list, as the library's and as the paper's. The other algorithms avoid
      most tests, each by another idea: the next lessons have them. If a panel is closed, choosing brings both back.</p>,
    suits: (now) => now.length > 1 && areOf(now, "brute_force"),
    check({ shown }) {
      const brute = shown.panels.find(({ spec }) => spec === "brute_force");
      const other = shown.panels.find(({ spec }) => spec !== "brute_force");
      if (shown.panels.length < 2) return { done: false, text: "Choose an algorithm: the second panel comes back with it." };
      if (brute === undefined) return { done: false, text: "Keep brute force in one of the panels, to compare with it." };
      if (other === undefined) return { done: false, text: "Both panels still search by brute force." };
      const share = other.statistics.tests / Math.max(1, brute.statistics.tests);
      const same = other.pairs === brute.pairs;
      return {
        done: same && other.error === undefined && share < 0.1,
        text: `${other.spec} makes ${plural(other.statistics.tests, "test")}, ${(100 * share).toFixed(1)} % of brute force's ` +
          `${grouped(brute.statistics.tests)}, and finds ${same ? "the same" : "other"} pairs.`,
      };
    },
  },
};

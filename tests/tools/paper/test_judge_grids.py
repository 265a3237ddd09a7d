"""The judgement of the experiments on the draft's grid, on results that are made by a model."""

import unittest

from made_results import results_of
from tools.paper.experiment import all_experiments
from tools.paper.experiments import grid_adding, grid_memory, grid_rebuilding, grid_translation
from tools.paper.judge import Verdict, judge
from tools.paper.rules import RuleBook

CONFIRMED, WITHIN, REFUTED, OPEN = Verdict.CONFIRMED, Verdict.WITHIN_BOUNDS, Verdict.REFUTED, Verdict.OPEN


def level(case, spec):
    return 1.0


def findings(name, time=level, **model):
    experiment = all_experiments()[name]
    results = results_of(experiment, time, **model)
    return {finding.number: finding for finding in judge(experiment, results, RuleBook())}


class Judgement(unittest.TestCase):
    def expect(self, name, number, verdict, time=level, condition="", **model):
        finding = findings(name, time, **model)[number]
        self.assertEqual(finding.verdict, verdict, finding)
        self.assertIn(condition, finding.condition)
        return finding


def number_after(text, word):
    return float(text.partition(word)[2].partition(":")[0].split()[0])


class OnMemory(Judgement):
    def memory(self, by_world=2, by_cell=2):
        def held(case, spec):
            if "limit=none" not in spec:
                return 1e6
            return 24 * number_after(spec, "width=")**by_world / number_after(spec, "cell=")**by_cell
        return held

    def test_that_fills_a_plane_may_not_hold_the_cells(self):
        finding = self.expect("grid_memory", "3a", CONFIRMED, memory=self.memory())
        self.assertAlmostEqual(finding.beside["a cell"].value, 24)
        self.assertAlmostEqual(finding.beside["cells across a world whose cells take 16 GB"].value, 25820, delta=1)
        self.expect("grid_memory", "3a", REFUTED, memory=self.memory(0, 0))
        self.expect("grid_memory", "3a", WITHIN, memory=self.memory(by_world=1),
                    condition="memory grows with the cells in a length")

    def test_large_cells_are_full_where_tests_and_time_grow(self):
        def grown(case, spec):
            largest = str(grid_memory.LARGEST) in case.name and "paper_grid" in spec
            return 6.0 if largest else 1.0
        def counted(case, spec):
            return grown(case, spec), 1.0
        self.expect("grid_memory", "3b", CONFIRMED, grown, counts=counted)
        self.expect("grid_memory", "3b", REFUTED)
        self.expect("grid_memory", "3b", REFUTED, counts=counted)
        self.expect("grid_memory", "3b", OPEN, lambda case, spec: grown(case, spec)**0.1, counts=counted)


class OnReferences(Judgement):
    def references(self, of):
        return lambda case, spec: (1.0, of(*map(int, case.name.split(" cells")[0].split(" x "))))

    def test_are_width_times_height_of_large_boxes(self):
        def exact(width, height):
            return (width + 1) * (height + 1)
        finding = self.expect("grid_spanning", "4a", CONFIRMED, counts=self.references(exact))
        self.assertAlmostEqual(finding.beside["boxes of 1 x 1 cells"].value, 4)
        self.assertNotIn("boxes of 128 x 4 cells", finding.evidence, "a small multiple in height")
        self.expect("grid_spanning", "4a", REFUTED, counts=self.references(lambda width, height: 1.3 * width * height))
        self.expect("grid_spanning", "4a", OPEN, counts=self.references(lambda width, height: 1.1 * width * height))


class OnAdding(Judgement):
    def phases(self, share):
        """Of a call with 16 cells across a box or more in a world of so many neighbours."""
        def of(case, spec):
            part = share(float(case.scene.partition("=")[2])) if number_after(spec, "cell=") <= 1 / 16 else 0.1
            return {"initializing_ms": 0.0, "adding_ms": part, "searching_ms": 1 - part}
        return lambda case, spec: of(case, spec) if "paper_grid" in spec else of(case, "cell=1")

    def test_most_of_the_time_is_more_than_half_with_small_cells(self):
        self.expect("grid_adding", "4b", CONFIRMED, phases=self.phases(lambda neighbours: 0.6))
        self.expect("grid_adding", "4b", REFUTED, phases=self.phases(lambda neighbours: 0.4))
        finding = self.expect("grid_adding", "4b", WITHIN, condition="200 boxes of 0.5 neighbours",
                              phases=self.phases(lambda neighbours: 0.8 if neighbours < 10 else 0.2))
        self.assertTrue(4 < finding.beside["neighbours of 200 boxes from which on it is less"].value < 16)

    def test_time_is_wasted_where_the_smallest_cells_take_twice_the_best(self):
        def time(factor):
            return lambda case, spec: factor if spec == grid_adding.spec(grid_adding.SMALLEST) else 1.0
        phases = self.phases(lambda neighbours: 0.6)
        self.expect("grid_adding", "4c", CONFIRMED, time(3.0), phases=phases)
        self.expect("grid_adding", "4c", REFUTED, time(1.0), phases=phases)
        self.expect("grid_adding", "4c", OPEN, time(1.5), phases=phases)


class OnTranslation(Judgement):
    def phases(self, reinserting, translating=1.0):
        return lambda case, spec: {"mending_ms": reinserting(case) if "reinsert" in spec else translating}

    def test_wins_or_not_where_boxes_are_in_the_most_cells(self):
        self.expect("grid_translation", "10a", CONFIRMED, phases=self.phases(lambda case: 1.5))
        self.expect("grid_translation", "10a", REFUTED, phases=self.phases(lambda case: 1.0))

    def test_loses_always_only_if_it_does_wherever_boxes_leave_their_cell(self):
        few = grid_translation.single(*[values[0] for values in (grid_translation.MOVING, grid_translation.IN_A_CELL)])
        self.expect("grid_translation", "10b", CONFIRMED, phases=self.phases(lambda case: 0.8))
        self.expect("grid_translation", "10b", REFUTED, phases=self.phases(lambda case: 1.0))
        self.expect("grid_translation", "10b", WITHIN, condition=few,
                    phases=self.phases(lambda case: 0.8 if case.name == few else 1.0))

    def test_offset_is_the_distance_to_the_lower_border_alone(self):
        finding = self.expect("grid_translation", "10c", WITHIN, phases=self.phases(lambda case: 1.0),
                              condition="towards the lower border, steps of a cell and towards the lower border")
        self.assertEqual([at.value for way, at in finding.evidence.items() if "lower" in way], [1, 1])
        self.assertEqual(finding.beside["with the sign of the change, towards the upper border, steps of a cell"],
                         finding.evidence["towards the upper border, steps of a cell"])


class OnRebuilding(Judgement):
    def phases(self, ratio):
        return lambda case, spec: {"mending_ms": ratio(case) if "reinsert" in spec else 1.0}

    def test_most_objects_decide(self):
        self.expect("grid_rebuilding", "11a", CONFIRMED, phases=self.phases(lambda case: 2 * case.moving))
        self.expect("grid_rebuilding", "11a", REFUTED, phases=self.phases(lambda case: 1.05))
        finding = self.expect("grid_rebuilding", "11a", WITHIN, condition="100 % of 1,000 boxes",
                              phases=self.phases(lambda case: 1.4 * case.moving))
        boxes, drift = grid_rebuilding.SERIES[0]
        crossing = f"percent of {grid_rebuilding.series(boxes, drift)} from which on rebuilding is faster"
        self.assertAlmostEqual(finding.beside[crossing].value, 100 / 1.4, delta=1)


if __name__ == "__main__":
    unittest.main()

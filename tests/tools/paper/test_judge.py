"""Verdicts by intervals, and the three experiments' own."""

import dataclasses
import unittest

from made_results import results_of
from tools.paper.experiment import Unusable, all_experiments
from tools.paper.experiments.grid_cell_size import LENGTHS
from tools.paper.judge import Asked, Finding, Verdict, judge, judged, judged_all
from tools.paper.rules import RuleBook
from tools.paper.statistics import Estimate

ABOVE = Estimate(2, 1.9, 2.1, (2,))
AROUND = Estimate(1, 0.9, 1.1, (1,))
BELOW = Estimate(0.5, 0.4, 0.6, (0.5,))


class Verdicts(unittest.TestCase):
    def expect(self, places, verdict, condition="", **threshold):
        finding = judged("1a", places, where="it is {}", **(threshold or {"above": 1}))
        self.assertEqual((finding.verdict, finding.condition), (verdict, condition))

    def test_rest_on_whole_intervals(self):
        self.expect({"a": ABOVE, "b": ABOVE}, Verdict.CONFIRMED)
        self.expect({"a": BELOW, "b": BELOW}, Verdict.REFUTED)
        self.expect({"a": AROUND, "b": BELOW}, Verdict.OPEN)
        self.expect({"a": ABOVE, "b": BELOW}, Verdict.WITHIN_BOUNDS, "it is a")
        self.expect({"a": ABOVE, "b": BELOW, "c": AROUND}, Verdict.WITHIN_BOUNDS, "it is a; open: c")
        self.expect({"a": ABOVE, "b": ABOVE, "c": AROUND}, Verdict.OPEN, "it holds where it is a and b; open: c")
        self.expect({"a": ABOVE, "b": AROUND}, Verdict.WITHIN_BOUNDS, "it is a", above=1.5, fails_at=0.5)
        self.expect({"a": BELOW, "b": BELOW}, Verdict.CONFIRMED, below=1)
        self.expect({"a": ABOVE}, Verdict.REFUTED, below=1)
        self.expect({"a": AROUND}, Verdict.REFUTED, above=1.8, fails_at=1.2)
        self.expect({"a": ABOVE}, Verdict.OPEN, above=2.5, fails_at=1.5)

    def test_on_several_things_ask_for_all_of_them(self):
        def verdict(*asked):
            return judged_all("1a", {"here": {str(i): one for i, one in enumerate(asked)}}).verdict

        holds, fails, undecided = (Asked(at, above=1) for at in (ABOVE, BELOW, AROUND))
        self.assertEqual(verdict(holds, Asked(ABOVE, above=1, below=3)), Verdict.CONFIRMED)
        self.assertEqual(verdict(holds, fails), Verdict.REFUTED)
        self.assertEqual(verdict(holds, undecided), Verdict.OPEN)
        self.assertEqual(verdict(holds, Asked(ABOVE, above=1, below=1.5)), Verdict.REFUTED, "above both")
        self.assertEqual(verdict(holds, Asked(BELOW, above=1, fails_at=0.3)), Verdict.OPEN)

    def test_are_open_where_nothing_was_measured(self):
        self.assertEqual(judged("1a", {}, above=1).verdict, Verdict.OPEN)

    def test_need_a_threshold(self):
        with self.assertRaises(ValueError):
            judged("1a", {"a": ABOVE})


class OfAnExperiment(unittest.TestCase):
    def setUp(self):
        self.book = RuleBook()
        self.experiment = all_experiments()["quadtree_capacity"]

    def quadtree(self, runs=3, small=2.0, references=lambda neighbours: neighbours, tests=lambda capacity: capacity,
                 fewer=0.1):
        """Small leaves take `small` times as long as others; the larger, the fewer references by this power."""
        def capacity_of(spec):
            return float(spec.rpartition("=")[2]) if "capacity" in spec else 1000.0

        def time(case, spec):
            return small if capacity_of(spec) <= 8 else 1.0

        def counts(case, spec):
            neighbours = float(case.scene.rpartition("=")[2])
            return tests(capacity_of(spec)), references(neighbours) / capacity_of(spec)**fewer

        return results_of(self.experiment, time, counts, runs=runs)

    def verdicts(self, **model):
        return [finding.verdict for finding in judge(self.experiment, self.quadtree(**model), self.book)]

    def test_are_one_for_each_claim_in_their_order(self):
        found = judge(self.experiment, self.quadtree(), self.book)
        self.assertEqual([finding.number for finding in found], ["8a", "8b", "8c"])

    def test_are_open_with_too_few_runs(self):
        for finding in judge(self.experiment, self.quadtree(runs=2), self.book):
            self.assertEqual(finding.verdict, Verdict.OPEN)
            self.assertTrue(finding.condition.startswith("2 of 3 runs; so far confirmed"))

    def test_of_other_claims_are_refused(self):
        other = dataclasses.replace(self.experiment, judge=lambda *_: [Finding("1a", Verdict.OPEN, {})])
        with self.assertRaisesRegex(Unusable, "judges 1a; expected its claims, 8a, 8b and 8c"):
            judge(other, self.quadtree(), self.book)

    def test_on_the_quadtree_follow_its_counts_and_the_times_of_small_leaves(self):
        self.assertEqual(self.verdicts(), [Verdict.CONFIRMED] * 3)
        self.assertEqual(self.verdicts(small=1.0)[1], Verdict.REFUTED)
        self.assertEqual(self.verdicts(fewer=-0.1)[1], Verdict.REFUTED, "larger leaves alleviate nothing")
        self.assertEqual(self.verdicts(tests=lambda capacity: 1e5 / capacity)[2], Verdict.REFUTED)
        self.assertEqual(self.verdicts(tests=lambda capacity: 1 / capacity)[2], Verdict.WITHIN_BOUNDS, "of the grid")

    def test_on_a_tree_whose_references_stay_leave_no_dense_world(self):
        self.assertEqual(self.verdicts(references=lambda neighbours: 1.0)[:2], [Verdict.REFUTED, Verdict.OPEN])


class OnTheGrid(unittest.TestCase):
    def verdicts(self, optimum, by_rule):
        """`optimum` is a scene's best size, in lengths of a box; times grow with the distance from it."""
        experiment = all_experiments()["grid_cell_size"]

        def size_of(case, spec):
            return float(spec.partition("cell=")[2].partition(":")[0]) / LENGTHS[case.scene][case.dimension - 2]

        def time(case, spec):
            if "cell=" not in spec:
                return by_rule
            size = size_of(case, spec)
            return max(size / optimum(case.scene), optimum(case.scene) / size)

        def counts(case, spec):
            return (size_of(case, spec), 1 / size_of(case, spec)) if "cell=" in spec else (1.0, 1.0)

        return [(finding.verdict, finding.condition)
                for finding in judge(experiment, results_of(experiment, time, counts), RuleBook())]

    def test_a_valley_everywhere_is_a_balance(self):
        balance, tuned = self.verdicts(lambda scene: 4.0, by_rule=1.0)
        self.assertEqual(balance[0], Verdict.CONFIRMED)
        self.assertEqual(tuned[0], Verdict.REFUTED, "one size does for all, and the rule finds it")

    def test_valleys_at_other_places_ask_for_tuning(self):
        def optimum(scene):
            return {"uniform": 1.0, "clustered": 2.0, "mixed": 8.0, "power_law": 16.0, "thin": 64.0}[scene]

        self.assertEqual(self.verdicts(optimum, by_rule=2.0)[1][0], Verdict.CONFIRMED)
        verdict, condition = self.verdicts(optimum, by_rule=1.0)[1]
        self.assertEqual((verdict, condition), (
            Verdict.WITHIN_BOUNDS, "the choice is one size, in lengths of a box, for all scenes"))

    def test_what_is_at_the_threshold_is_open(self):
        self.assertEqual(self.verdicts(lambda scene: 4.0, by_rule=1.1)[1][0], Verdict.OPEN)


class OnInsertionSort(unittest.TestCase):
    def verdicts(self, over_heap, exponent=0.0):
        """Where a box passes so many others, insertion sort takes `over_heap` times as long as the rest."""
        experiment = all_experiments()["sweep_insertion"]

        def passed(case):
            if " boxes in " in case.name:
                return (case.boxes / 100) ** exponent
            return 1000.0 if case.teleport else case.drift * 11

        def time(case, spec):
            return over_heap(passed(case)) if spec.endswith("insertion") else 1.0

        results = results_of(experiment, time, phases=lambda case, spec: {"moved": passed(case)})
        return judge(experiment, results, RuleBook())

    def test_work_that_outgrows_n_where_order_is_kept_refutes(self):
        self.assertEqual(self.verdicts(lambda passed: 0.5)[0].verdict, Verdict.CONFIRMED)
        self.assertEqual(self.verdicts(lambda passed: 0.5, exponent=0.6)[0].verdict, Verdict.REFUTED)

    def test_frames_in_order_decide_on_the_heap(self):
        self.assertEqual(self.verdicts(lambda passed: 0.5 if passed < 10 else 5.0)[1].verdict, Verdict.CONFIRMED)
        self.assertEqual(self.verdicts(lambda passed: 1.0)[1].verdict, Verdict.REFUTED, "level")
        bounded = self.verdicts(lambda passed: (passed / 2) ** 0.5)[1]
        self.assertEqual(bounded.verdict, Verdict.WITHIN_BOUNDS)
        even = bounded.beside["as fast as the heap at"]
        self.assertAlmostEqual(even.value, 2, delta=0.25)


if __name__ == "__main__":
    unittest.main()

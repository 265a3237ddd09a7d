"""Judgement on brute force, on how others overtake it, and on the sweep's worlds."""

import unittest

from made_results import results_of
from tools.paper.experiment import all_experiments
from tools.paper.experiments import overtaking, sweep_worlds
from tools.paper.judge import Verdict, judge
from tools.paper.rules import RuleBook


def findings(name, time, counts=None):
    experiment = all_experiments()[name]
    return judge(experiment, results_of(experiment, time, counts), RuleBook())


class OnBruteForce(unittest.TestCase):
    def verdict(self, amount):
        return findings("brute_force_tests", lambda case, spec: amount(case.boxes / 1000),
                        lambda case, spec: ((case.boxes - 1) / 2, 1.0))[0]

    def test_time_that_grows_as_the_square_confirms(self):
        found = self.verdict(lambda n: n**2)
        self.assertEqual(found.verdict, Verdict.CONFIRMED)
        self.assertAlmostEqual(found.beside["tests over n (n - 1) / 2, 1,000 boxes"].value, 1)

    def test_another_power_refutes_and_none_leaves_it_open(self):
        self.assertEqual(self.verdict(lambda n: n**1.5).verdict, Verdict.REFUTED)
        self.assertEqual(self.verdict(lambda n: n**2 if n < 5 else 6 * n**2).verdict, Verdict.OPEN)


class OnOvertaking(unittest.TestCase):
    def findings(self, exponent=lambda spec: 0.5, slow=()):
        """Others take as long as brute force at 100 boxes, those that are slow at any number."""
        def is_brute_force(spec):
            return spec in (overtaking.LISTING, overtaking.OURS)

        def time(case, spec):
            return case.boxes**2 if is_brute_force(spec) or spec in slow else 100.0 * case.boxes

        def counts(case, spec):
            return (case.boxes - 1) / 2 if is_brute_force(spec) else case.boxes**exponent(spec), 1.0

        return findings("overtaking", time, counts)

    def test_smaller_collections_and_less_time_confirm(self):
        tests, times = self.findings()
        self.assertEqual((tests.verdict, times.verdict), (Verdict.CONFIRMED, Verdict.CONFIRMED))
        self.assertAlmostEqual(times.beside["the draft's grid on thin boxes overtakes at"].value, 100, delta=5)

    def test_one_that_does_not_is_a_bound(self):
        tests, times = self.findings(lambda spec: 0.9 if spec == "paper_grid" else 0.5, slow=["paper_quadtree"])
        self.assertEqual((tests.verdict, times.verdict), (Verdict.WITHIN_BOUNDS, Verdict.WITHIN_BOUNDS))
        self.assertNotIn("grid", tests.condition)
        self.assertNotIn("quadtree", times.condition)

    def test_none_that_does_refutes(self):
        tests, times = self.findings(lambda spec: 0.95, slow=overtaking.OTHERS)
        self.assertEqual((tests.verdict, times.verdict), (Verdict.REFUTED, Verdict.REFUTED))


class OnTheSweep(unittest.TestCase):
    def finding(self, tests=lambda world: 1.0, time=lambda world: 1.0):
        return findings("sweep_worlds", lambda case, spec: time(case.name),
                        lambda case, spec: (tests(case.name), 1.0))[0]

    def test_worlds_that_cost_nothing_confirm(self):
        self.assertEqual(self.finding().verdict, Verdict.CONFIRMED)

    def test_infinite_boxes_that_cost_tests_are_a_bound(self):
        found = self.finding(tests=lambda world: 3.0 if "infinite" in world else 1.0)
        self.assertEqual(found.verdict, Verdict.WITHIN_BOUNDS)
        self.assertNotIn("infinite", found.condition)

    def test_time_in_every_world_without_bounds_refutes(self):
        self.assertEqual(self.finding(time=lambda world: 1.5 if world in sweep_worlds.BOUNDLESS else 1.0).verdict,
                         Verdict.REFUTED)


if __name__ == "__main__":
    unittest.main()

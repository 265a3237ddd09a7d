"""Verdicts on our own claims, on made results."""

import unittest

from made_results import results_of
from tools.paper.experiment import all_experiments
from tools.paper.experiments.ablation import scalar
from tools.paper.judge import Verdict, judge
from tools.paper.rules import RuleBook


class OnWinners(unittest.TestCase):
    def verdicts(self, time):
        experiment = all_experiments()["winners"]
        return [(finding.verdict, finding.condition) for finding in
                judge(experiment, results_of(experiment, time), RuleBook())]

    def test_no_winner_everywhere_and_a_choice_that_follows_the_winners_confirm(self):
        def time(case, spec):
            return 1.0 if spec == "auto" or (spec == "grid") == (case.dimension == 2) else 2.0

        self.assertEqual(self.verdicts(time), [(Verdict.CONFIRMED, "")] * 2)

    def test_one_that_is_nowhere_slower_refutes(self):
        def time(case, spec):
            return 1.0 if spec == "grid" else 1.03 if spec == "auto" else 2.0

        self.assertEqual(self.verdicts(time), [(Verdict.REFUTED, "")] * 2)

    def test_a_choice_that_is_better_at_rest_only_is_bounded(self):
        def time(case, spec):
            first = 1.0 if (spec == "grid") == (case.dimension == 2) else 2.0
            return first if spec != "auto" else 3.0 if case.frames else 1.0

        self.assertEqual(self.verdicts(time)[1], (Verdict.WITHIN_BOUNDS, "boxes rest"))


class OnAblation(unittest.TestCase):
    def finding(self, plainly, scalar_target=9.0):
        """The library takes 1 ms, the plainest form 16."""
        experiment = all_experiments()["ablation"]

        def time(case, spec):
            if spec in ("grid", "bvh"):
                return 1.0
            if spec in (scalar("grid"), scalar("bvh")):
                return scalar_target
            return 16.0 if spec.count("=no") > 2 else plainly(case, spec)

        return judge(experiment, results_of(experiment, time), RuleBook())[0]

    def test_shares_are_of_logarithms_over_the_fastest_plain_form(self):
        self.assertEqual(self.finding(lambda case, spec: 8.0).verdict, Verdict.CONFIRMED)
        self.assertEqual(self.finding(lambda case, spec: 2.0).verdict, Verdict.REFUTED)
        self.assertEqual(self.finding(lambda case, spec: 2.0 if "arrays=no" in spec else 8.0).verdict, Verdict.REFUTED)
        bounded = self.finding(lambda case, spec: 8.0 if "grid" in spec else 2.0)
        self.assertEqual(bounded.verdict, Verdict.WITHIN_BOUNDS)
        self.assertNotIn("tree of bounds", bounded.condition)

    def test_the_scalar_target_is_the_baseline_where_it_is_faster_than_plain_code(self):
        self.assertEqual(self.finding(lambda case, spec: 8.0, scalar_target=2.0).verdict, Verdict.REFUTED)
        self.assertEqual(self.finding(lambda case, spec: 2.0, scalar_target=16.0).verdict, Verdict.REFUTED)


if __name__ == "__main__":
    unittest.main()

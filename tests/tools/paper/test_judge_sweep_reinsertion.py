"""The verdict on statement 13b, on made results."""

import math
import unittest

from made_results import results_of
from tools.paper.experiment import all_experiments
from tools.paper.judge import Verdict, judge
from tools.paper.rules import RuleBook


class OnBinarySearch(unittest.TestCase):
    def verdict(self, moved):
        """Where each mover has `moved(boxes)` others give way."""
        experiment = all_experiments()["sweep_reinsertion"]
        results = results_of(experiment, lambda case, spec: 1.0, None, lambda case, spec: {
            "visited": 2 * math.log2(case.boxes), "moved": moved(case) if case.teleport else 0.0})
        return judge(experiment, results, RuleBook())[0].verdict

    def test_follows_the_places_that_give_way_as_well(self):
        self.assertEqual(self.verdict(lambda case: math.log2(case.boxes)), Verdict.CONFIRMED)
        self.assertEqual(self.verdict(lambda case: case.boxes / 3), Verdict.REFUTED)


if __name__ == "__main__":
    unittest.main()

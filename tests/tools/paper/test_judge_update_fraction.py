"""Verdicts on statements 9a to 9d, on made results."""

import unittest

from made_results import results_of
from tools.paper.experiment import all_experiments
from tools.paper.judge import Verdict, judge
from tools.paper.rules import RuleBook


class OnWhatChanged(unittest.TestCase):
    def findings(self, mending=0.1, frame=0.5, detecting=0.0, searching=lambda structure, movers: 0.01):
        """Where `mending` is its time over that of building, and `searching` likewise by a flag alone; the frame
        that builds anew takes 1 ms, as building does."""
        experiment = all_experiments()["update_fraction"]

        def time(case, spec):
            return 1.0 if "rebuild" in spec else max(frame, 0.9) if "=search" in spec else frame

        def phases(case, spec):
            structure, _, update = spec.partition(":update=")
            part = {"rebuild": 1.0, "search_delete_reinsert": searching(structure, case.moving * case.boxes)}
            return {"mending_ms": part.get(update, mending), "detecting_ms": detecting}

        return {finding.number: finding for finding in judge(experiment, results_of(experiment, time, None, phases),
                                                             RuleBook())}

    def test_mending_and_frames_that_are_faster_confirm(self):
        found = self.findings()
        self.assertEqual([finding.verdict for finding in found.values()], [Verdict.CONFIRMED] * 4)

    def test_what_is_level_refutes(self):
        self.assertEqual(self.findings(mending=1.0, searching=lambda *_: 1.0)["9a"].verdict, Verdict.REFUTED)
        self.assertEqual(self.findings(frame=1.0)["9b"].verdict, Verdict.REFUTED)

    def test_the_time_to_detect_counts(self):
        self.assertEqual(self.findings(detecting=2.0)["9c"].verdict, Verdict.REFUTED)

    def test_searching_for_each_bounds_by_movers_and_structure(self):
        found = self.findings(searching=lambda structure, movers: movers / (200 if "quadtree" in structure else 50))
        self.assertEqual(found["9d"].verdict, Verdict.WITHIN_BOUNDS)
        self.assertEqual(found["9d"].condition.split("; ")[:2], [
            "by a flag alone where 10 of 10,000 move: grid, sweep and quadtree",
            "by a flag alone where 100 of 10,000 move: quadtree"])
        even = found["9d"].beside["by a flag alone in the grid of 1,000, no longer faster from"]
        self.assertAlmostEqual(even.value, 50, delta=5)
        self.assertEqual(self.findings(mending=2.0, searching=lambda structure, movers: 2.0)["9d"].verdict,
                         Verdict.REFUTED)


if __name__ == "__main__":
    unittest.main()

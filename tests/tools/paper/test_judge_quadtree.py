"""Judgement on the sizes of boxes in a quadtree, and on the ways by which they are inserted again."""

import math
import unittest

import numpy

from made_results import results_of
from tools.paper.experiment import all_experiments
from tools.paper.experiments import quadtree_depth, quadtree_siblings, quadtree_sizes
from tools.paper.judge import Verdict, judge
from tools.paper.rules import RuleBook


def findings(name, time=lambda case, spec: 1.0, counts=None, phases=None):
    experiment = all_experiments()[name]
    return judge(experiment, results_of(experiment, time, counts, phases), RuleBook())


class OnSizes(unittest.TestCase):
    def verdicts(self, leaves=lambda size, side: (1 + size / side)**2, references=3.0, time=2.0):
        """`references` and `time` are of the tree with the largest boxes over those with small ones."""
        sides = {quadtree_sizes.leaves_of(side): side for side in quadtree_sizes.LEAVES}

        def size_of(case):
            return float(case.name.split()[-2])

        def counts(case, spec):
            if spec in sides:
                return 1.0, (999 + leaves(size_of(case), sides[spec])) / 1000
            return 1.0, references if size_of(case) == quadtree_sizes.LARGE[-1] else 1.0

        def times(case, spec):
            is_slow = spec == quadtree_sizes.TREE and size_of(case) == quadtree_sizes.LARGE[-1]
            return time if is_slow else 1.0

        return [finding.verdict for finding in findings("quadtree_sizes", times, counts)]

    def test_leaves_by_a_boxs_area_confirm(self):
        self.assertEqual(self.verdicts(), [Verdict.CONFIRMED] * 3)

    def test_leaves_that_do_not_grow_refute_fourfold(self):
        self.assertEqual(self.verdicts(leaves=lambda size, side: 1.0)[:2], [Verdict.CONFIRMED, Verdict.REFUTED])

    def test_small_boxes_that_multiply_refute_that_they_suit(self):
        self.assertEqual(self.verdicts(leaves=lambda size, side: 16.0 / side**2)[0], Verdict.REFUTED)

    def test_bookkeeping_takes_references_and_time(self):
        self.assertEqual(self.verdicts(references=1.1, time=1.0)[2], Verdict.REFUTED)
        self.assertEqual(self.verdicts(time=1.0)[2], Verdict.WITHIN_BOUNDS)


class OnSiblings(unittest.TestCase):
    def findings(self, relative=lambda leaves: 0.5, across=lambda leaves: 0.5):
        """The time of mending, and the nodes visited, over those from the root, by the leaves that a box is in."""
        def leaves(case):
            return 1.1 + float(case.scene.partition("=")[2] or 4) / 8

        def phases(case, spec):
            way = spec.rpartition("=")[2]
            over_root = {"root": 1.0, "relative": relative(leaves(case))}.get(way, across(leaves(case)))
            return {"mending_ms": over_root, "visited": 10 * over_root}

        return findings("quadtree_siblings", counts=lambda case, spec: (1.0, leaves(case)), phases=phases)

    def test_ways_that_are_horrible_for_boxes_in_many_leaves_confirm(self):
        found = self.findings(across=lambda leaves: 0.5 if leaves < 4 else 2.0)
        self.assertEqual([finding.verdict for finding in found], [Verdict.CONFIRMED] * 3)

    def test_ways_that_are_level_everywhere_refute(self):
        found = self.findings(lambda leaves: 1.0, lambda leaves: 1.0)
        self.assertEqual([finding.verdict for finding in found], [Verdict.REFUTED] * 3)

    def test_a_way_that_is_faster_in_few_leaves_is_a_bound(self):
        found = self.findings(relative=lambda leaves: leaves / 5)[0]
        self.assertEqual(found.verdict, Verdict.WITHIN_BOUNDS)
        self.assertNotIn("128 neighbours", found.condition)
        self.assertAlmostEqual(found.beside["as fast as from the root at, leaves of 8"].value, 5, delta=0.2)


class OnDepth(unittest.TestCase):
    def verdicts(self, visited, moved=1.0):
        return [finding.verdict for finding in findings(
            "quadtree_depth", phases=lambda case, spec: {"visited": visited(case.boxes), "moved": moved})]

    def test_nodes_by_the_logarithm_confirm(self):
        self.assertEqual(self.verdicts(math.log2, moved=4.0), [Verdict.CONFIRMED] * 2)

    def test_nodes_by_a_power_refute_also_that_they_are_a_part(self):
        self.assertEqual(self.verdicts(lambda boxes: boxes**0.5, moved=0.1), [Verdict.REFUTED] * 2)

    def test_the_far_box_is_the_last_one_and_alone(self):
        boxes = quadtree_depth.with_one_far_away(numpy.random.default_rng(1))
        self.assertGreater(boxes[-1, 0], 1000 * boxes[:-1, 2].max())


if __name__ == "__main__":
    unittest.main()

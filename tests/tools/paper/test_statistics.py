"""Figures and their intervals."""

import math
import unittest

import numpy

from tools.paper.statistics import (between_runs, bootstrap_interval, crossing, digits, geometric_mean, growth,
                                    growth_interval, median_ratio)


class BetweenRuns(unittest.TestCase):
    def test_is_students_interval_of_the_logarithms(self):
        at = between_runs([1, 2, 4], 0.95)
        self.assertAlmostEqual(at.value, 2)
        # t of two degrees of freedom is 4.3027, the standard error of the logarithms ln 2 / sqrt 3.
        self.assertAlmostEqual(at.high, 2 * math.exp(4.3027 * math.log(2) / math.sqrt(3)), places=3)
        self.assertAlmostEqual(at.low * at.high, 4)

    def test_of_the_reciprocals_is_the_reciprocal(self):
        at = between_runs([1.1, 1.2, 1.4], 0.95)
        other = between_runs([1 / 1.1, 1 / 1.2, 1 / 1.4], 0.95)
        for name, name_of_other in (("value", "value"), ("low", "high"), ("high", "low")):
            self.assertAlmostEqual(getattr(at, name), 1 / getattr(other, name_of_other))

    def test_of_figures_around_nothing_is_of_the_figures_themselves(self):
        at = between_runs([-1, 0, 1], 0.95)
        self.assertEqual(at.value, 0)
        self.assertLess(at.low, -1)

    def test_of_equal_counts_is_the_count(self):
        at = between_runs([5, 5, 5], 0.95)
        self.assertAlmostEqual(at.low, 5)
        self.assertEqual(at.low, at.high)

    def test_is_not_printed_where_no_digit_of_it_differs(self):
        self.assertEqual(between_runs([24.001, 24.002], 0.95, "bytes").text(), "24.0 bytes")
        self.assertEqual(between_runs([24, 25], 0.95).text(), "24.5 (18.9 to 31.7)")

    def test_of_crossings_says_where_there_was_none(self):
        self.assertEqual(between_runs([math.inf, math.inf], 0.95).text(), "not reached")
        self.assertEqual(between_runs([math.inf, 2], 0.95).text(), "not reached in each run")
        self.assertIn("unknown", between_runs([math.nan, 2], 0.95).text())

    def test_decides_nothing_with_one_run_or_an_unknown_figure(self):
        for values in ([3.0], [1.0, math.inf, 2.0]):
            at = between_runs(values, 0.95)
            self.assertFalse(at.is_above(0) or at.is_below(1e9))

    def test_covers_the_truth_as_often_as_it_says(self):
        random = numpy.random.default_rng(1)
        hits = sum(at.low <= 1 <= at.high for at in
                   (between_runs(numpy.exp(random.normal(0, 0.1, 3)), 0.95) for _ in range(2000)))
        self.assertAlmostEqual(hits / 2000, 0.95, delta=0.015)


class Ratios(unittest.TestCase):
    def test_are_of_the_rounds_of_both(self):
        times = numpy.array([[2.0], [4.0], [60.0]])
        others = numpy.array([[1.0], [2.0]])
        self.assertAlmostEqual(median_ratio(times, others), 2)
        with self.assertRaises(ValueError):
            median_ratio(times, numpy.empty((0, 1)))

    def test_have_a_bootstrap_interval_within_a_run(self):
        random = numpy.random.default_rng(1)
        times = numpy.exp(random.normal(math.log(2), 0.1, (100, 1)))
        low, high = bootstrap_interval(times, numpy.ones((100, 1)), 0.95)
        self.assertTrue(1.9 < low < 2 < high < 2.1, (low, high))
        self.assertTrue(math.isnan(bootstrap_interval(times[:3], times[:3], 0.95)[0]))


class Curves(unittest.TestCase):
    def test_grow_by_the_slope_of_the_logarithms(self):
        self.assertAlmostEqual(growth([1, 10, 100], [2, 200, 20000]), 2)

    def test_leave_the_exponent_open_where_they_are_no_power(self):
        low, high = growth_interval([1, 2, 4, 8, 16], [1, 4, 16, 64, 256], 0.95)
        self.assertAlmostEqual(high - low, 0)
        low, high = growth_interval([1, 2, 4, 8, 16], [1, 1, 16, 16, 256], 0.95)
        self.assertTrue(low < 1.5 and high > 2.5, (low, high))

    def test_cross_between_places_by_logarithms(self):
        self.assertAlmostEqual(crossing([1, 100], [0.5, 2]), 10)
        self.assertAlmostEqual(crossing([100, 1], [2, 0.5]), 10)
        self.assertAlmostEqual(crossing([1, 100], [2, 3]), 1)
        self.assertEqual(crossing([1, 100], [2, 0.5]), math.inf)

    def test_have_a_geometric_mean(self):
        self.assertAlmostEqual(geometric_mean([1, 4]), 2)


class Digits(unittest.TestCase):
    def test_are_three(self):
        self.assertEqual([digits(x) for x in (0, 1.2345, 0.012345, 25689, 999.6, math.inf, math.nan)],
                         ["0", "1.23", "0.0123", "25,700", "1,000", "without end", "unknown"])


if __name__ == "__main__":
    unittest.main()

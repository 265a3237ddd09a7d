"""Figures with intervals: between runs by Student's t, within one run by the bootstrap.

A run is a separate process on boxes of its own seeds, and the unit of every interval: rounds within a process share
its memory layout and the time at which it ran, so they are not independent (Georges, Buytaert and Eeckhout, OOPSLA
2007; Kalibera and Jones, ISMM 2013).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy
from scipy import stats


@dataclass(frozen=True)
class Estimate:
    """A figure: the mean of its runs and the interval between them."""

    value: float
    low: float
    high: float
    runs: tuple[float, ...]
    unit: str = ""

    def is_above(self, level: float) -> bool:
        return self.low > level

    def is_below(self, level: float) -> bool:
        return self.high < level

    def text(self) -> str:
        """Three digits, and the interval in brackets: "1.42 (1.38 to 1.46) ms". A crossing may be "not reached"."""
        if math.isnan(self.value) and not any(map(math.isnan, self.runs)):
            return "not reached" if not any(map(math.isfinite, self.runs)) else "not reached in each run"
        low, high = digits(self.low), digits(self.high)
        if math.isnan(self.low) or math.isnan(self.high):
            interval = " (no interval)"
        else:
            is_a_point = low == high and self.high - self.low <= 1e-3 * abs(self.value)
            interval = "" if is_a_point else f" ({low} to {high})"
        return f"{digits(self.value)}{interval}{' ' if self.unit else ''}{self.unit}"


def digits(number: float) -> str:
    """Three significant digits, with commas: 0.0123, 1.42, 25,700."""
    if not math.isfinite(number):
        return "unknown" if math.isnan(number) else ("-" if number < 0 else "") + "without end"
    if number == 0:
        return "0"
    places = 2 - math.floor(math.log10(abs(number)))
    rounded = round(number, places)
    return f"{rounded:,.{max(places, 0)}f}"


def between_runs(values: Sequence[float], confidence: float, unit: str = "") -> Estimate:
    """The mean of the runs' figures and its Student's interval.

    For positive figures, both are computed from logarithms, so that a ratio's reciprocal has the reciprocal interval.
    A single run has no interval between runs and decides nothing.
    """
    runs = numpy.asarray(values, dtype=float)
    if runs.size == 0:
        raise ValueError("no runs; expected one at least")
    if not numpy.isfinite(runs).all():
        return Estimate(math.nan, math.nan, math.nan, tuple(runs), unit)
    is_positive = bool((runs > 0).all())
    numbers = numpy.log(runs) if is_positive else runs
    mean = numbers.mean()
    if runs.size == 1:
        low = high = math.nan
    elif numpy.ptp(numbers) == 0:  # counts
        low = high = mean
    else:
        low, high = stats.t.interval(confidence, runs.size - 1, loc=mean, scale=stats.sem(numbers))
    back = math.exp if is_positive else float
    return Estimate(back(mean), back(low), back(high), tuple(runs), unit)


def median_ratio(times: numpy.ndarray, others: numpy.ndarray) -> float:
    """The median of paired ratios; that of the reciprocals is its reciprocal."""
    return float(numpy.exp(numpy.median(_logarithms(times, others))))


def bootstrap_interval(times: numpy.ndarray, others: numpy.ndarray, confidence: float) -> tuple[float, float]:
    """The bootstrap interval of one run's median ratio, from resampling its pairs: the variation within the run."""
    logarithms = _logarithms(times, others)
    if logarithms.size < 5 or numpy.ptp(logarithms) == 0:
        return math.nan, math.nan
    result = stats.bootstrap((logarithms,), numpy.median, confidence_level=confidence, n_resamples=2000,
                             method="percentile", random_state=numpy.random.default_rng(1))
    return tuple(numpy.exp(result.confidence_interval))


def _logarithms(times: numpy.ndarray, others: numpy.ndarray) -> numpy.ndarray:
    """For the pairs in which both took part. A time of 0 on the clock was less than a nanosecond."""
    rounds = min(len(times), len(others))
    if rounds == 0:
        raise ValueError("no round in which both took part; expected one at least")
    least = 1e-6
    return numpy.log(numpy.maximum(times[:rounds], least) / numpy.maximum(others[:rounds], least)).ravel()


def geometric_mean(numbers: Sequence[float]) -> float:
    return float(stats.gmean(numbers))


def growth(sizes: Sequence[float], amounts: Sequence[float]) -> float:
    """The exponent e of amount ~ size^e, by least squares of the logarithms."""
    return float(stats.linregress(numpy.log(sizes), numpy.log(amounts)).slope)


def growth_interval(sizes: Sequence[float], amounts: Sequence[float], confidence: float) -> tuple[float, float]:
    """The fit's interval of the exponent: wide if the amounts do not follow a power law."""
    fit = stats.linregress(numpy.log(sizes), numpy.log(amounts))
    return stats.t.interval(confidence, len(sizes) - 2, loc=fit.slope, scale=max(fit.stderr, 1e-12))


def crossing(places: Sequence[float], ratios: Sequence[float], level: float = 1) -> float:
    """The place from which a ratio stays above a level, interpolated between places by logarithms.

    The first place if it is always above; infinite if it is not above at the last.
    """
    order = numpy.argsort(places)
    x = numpy.log(numpy.asarray(places, dtype=float)[order])
    above = numpy.log(numpy.asarray(ratios, dtype=float)[order] / level)
    below = numpy.flatnonzero(above <= 0)
    if below.size == 0:
        return float(numpy.exp(x[0]))
    last = below[-1]
    if last == x.size - 1:
        return math.inf
    share = -above[last] / (above[last + 1] - above[last])
    return float(numpy.exp(x[last] + share * (x[last + 1] - x[last])))

"""The results of an experiment: one object for each run, and figures between runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy
import pandas

from .experiment import Unusable
from .statistics import Estimate, between_runs, bootstrap_interval, growth, growth_interval, median_ratio

WHOLE = ("whole",)


class Run:
    """One run: a measurement for each case and spec.

    A part of a time is the whole call or frame, or a sum of phases such as ("adding",): see
    paper/listings/phases.hpp.
    """

    def __init__(self, measurements: Sequence[dict]):
        self._measurements = {(one["case"], one["algorithm"]): one for one in measurements}
        self._first_of_case = {one["case"]: one for one in reversed(measurements)}

    @property
    def table(self) -> pandas.DataFrame:
        """All measurements, by case and algorithm, for fast look-up."""
        return pandas.DataFrame(self._measurements.values()).set_index(["case", "algorithm"], drop=False)

    def measurement(self, case: str, spec: str) -> dict:
        if (case, spec) not in self._measurements:
            if case not in self._first_of_case:
                raise Unusable(f"no case '{case}' was measured; expected one of: {', '.join(self._first_of_case)}")
            known = [of_spec for of_case, of_spec in self._measurements if of_case == case]
            raise Unusable(f"case '{case}': '{spec}' was not measured; expected one of: {', '.join(known)}")
        return self._measurements[case, spec]

    def samples(self, case: str, spec: str, part: Sequence[str] = WHOLE) -> numpy.ndarray:
        """Milliseconds: a row per round, a column per frame (one if boxes rest). No rows if it was too slow."""
        measured = self.measurement(case, spec)
        if measured["samples_ms"] is None:
            return numpy.empty((0, 1))
        frames = max(int(measured["frames"]), 1)
        whole = numpy.asarray(measured["samples_ms"], dtype=float).reshape(-1, frames)
        if tuple(part) == WHOLE:
            return whole
        phases = measured["phases"]
        return sum(numpy.asarray(phases[f"{name}_ms"], dtype=float) for name in part).reshape(whole.shape)

    def was_timed(self, case: str, spec: str) -> bool:
        return self.samples(case, spec).size > 0

    def lacks(self, case: str, spec: str, what: str) -> Unusable:
        """The error for a measurement that lacks this: usually because it was too slow."""
        why = self.measurement(case, spec).get("skipped") or "it was not taken"
        return Unusable(f"case '{case}': {spec} has no {what} ({why}); expected some, as on a faster machine")

    def needed(self, case: str, spec: str, part: Sequence[str]) -> numpy.ndarray:
        if not self.was_timed(case, spec):
            raise self.lacks(case, spec, "time")
        return self.samples(case, spec, part)

    def time(self, case: str, spec: str, part: Sequence[str] = WHOLE) -> float:
        """Milliseconds: the median of all calls or frames."""
        return float(numpy.median(self.needed(case, spec, part)))

    def ratio(self, case: str, spec: str, other: str, part: Sequence[str] = WHOLE,
              other_part: Sequence[str] | None = None) -> float:
        """The ratio of one time to another, in their common rounds."""
        return median_ratio(self.needed(case, spec, part), self.needed(case, other, other_part or part))

    def count(self, case: str, spec: str, what: str) -> float:
        """Tests or references per box: the mean over the seeds."""
        measured = self.measurement(case, spec)
        by_seed = [number for number in measured[f"{what}_by_seed"] if number is not None]
        if not by_seed:
            raise self.lacks(case, spec, what)
        return float(numpy.mean(by_seed)) / self.boxes(case)

    def per_mover(self, case: str, spec: str, what: str) -> float:
        """Entries `visited` or `moved` per box that changed."""
        phases = self.measurement(case, spec)["phases"]
        if phases is None:
            raise self.lacks(case, spec, "phases")
        return float(numpy.sum(phases[what]) / max(numpy.sum(phases["movers"]), 1))

    def memory(self, case: str, spec: str, what: str = "own") -> float:
        """Bytes held between calls (own), or their maximum at one moment (peak)."""
        held = self.measurement(case, spec)[f"{what}_bytes"]
        if held is None:
            raise self.lacks(case, spec, "memory")
        return float(held)

    def boxes(self, case: str) -> int:
        return self._first_of_case[case]["boxes"]

    def seeds(self, case: str) -> int:
        return len(self._first_of_case[case]["seeds"])


class Results:
    """All runs of one experiment. Every figure is a function of one run, with its interval between runs."""

    def __init__(self, runs: Sequence[Run], confidence: float):
        if not runs:
            raise Unusable("no runs; expected one at least")
        self.runs = list(runs)
        self.confidence = confidence

    def between(self, figure: Callable[[Run], float], unit: str = "") -> Estimate:
        return between_runs([figure(run) for run in self.runs], self.confidence, unit)

    def growth(self, sizes: Sequence[float], amount: Callable[[Run, float], float]) -> Estimate:
        """The exponent e of amount(run, size) ~ size^e; its interval contains both that between runs and that of the
        fit to the runs' means."""
        amounts = numpy.array([[amount(run, size) for size in sizes] for run in self.runs])
        between = between_runs([growth(sizes, row) for row in amounts], self.confidence)
        low, high = growth_interval(sizes, numpy.exp(numpy.log(amounts).mean(axis=0)), self.confidence)
        return Estimate(between.value, numpy.fmin(between.low, low), numpy.fmax(between.high, high),
                        between.runs)

    def time(self, case: str, spec: str, part: Sequence[str] = WHOLE) -> Estimate:
        return self.between(lambda run: run.time(case, spec, part), "ms")

    def ratio(self, case: str, spec: str, other: str, part: Sequence[str] = WHOLE,
              other_part: Sequence[str] | None = None) -> Estimate:
        """With a single run, the interval is the bootstrap's within the run, for a first impression."""
        estimate = self.between(lambda run: run.ratio(case, spec, other, part, other_part))
        if len(self.runs) > 1 or spec == other:
            return estimate
        low, high = bootstrap_interval(self.runs[0].samples(case, spec, part),
                                       self.runs[0].samples(case, other, other_part or part),
                                       self.confidence)
        return Estimate(estimate.value, low, high, estimate.runs)

    def largest(self, figure: Callable[[Run], float]) -> Estimate:
        """The maximum of the runs' figures, which is a bound and has no interval."""
        figures = tuple(float(figure(run)) for run in self.runs)
        return Estimate(max(figures), max(figures), max(figures), figures)

    def count(self, case: str, spec: str, what: str) -> Estimate:
        return self.between(lambda run: run.count(case, spec, what), f"{what} a box")

    def per_mover(self, case: str, spec: str, what: str) -> Estimate:
        return self.between(lambda run: run.per_mover(case, spec, what), f"{what} a mover")

    def boxes(self, case: str) -> int:
        return self.runs[0].boxes(case)

    def timed(self, case: str, specs: Sequence[str]) -> list[str]:
        """The specs that have a time in every run."""
        return [spec for spec in specs if all(run.was_timed(case, spec) for run in self.runs)]

    def fastest(self, case: str, specs: Sequence[str], part: Sequence[str] = WHOLE) -> str:
        """The spec with the minimum mean time over the runs; the same for all runs."""
        timed = self.timed(case, specs)
        if not timed:
            raise Unusable(f"case '{case}': none of {', '.join(specs)} has a time; expected one at least")
        means = {spec: math.exp(numpy.mean([math.log(run.time(case, spec, part)) for run in self.runs]))
                 for spec in timed}
        return min(means, key=means.get)

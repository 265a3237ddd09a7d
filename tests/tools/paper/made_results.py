"""Results that are made by a model instead of a clock, for tests of judgement."""

from __future__ import annotations

import numpy

from tools.paper.experiment import Experiment
from tools.paper.results import Results, Run


def run_of(experiment: Experiment, number: int, time, counts=None, phases=None, memory=None, rounds: int = 8) -> Run:
    """A run in which `time(case, spec)` is the median of a spec's milliseconds, give or take a percent;
    `counts(case, spec)` its tests and references a box, `phases(case, spec)` its phases by name, and
    `memory(case, spec)` the bytes that it holds."""
    random = numpy.random.default_rng(number)
    measurements = []
    for case in experiment.cases():
        frames = case.frames or 1
        boxes = case.boxes or 1000
        for spec in case.specs:
            samples = time(case, spec) * random.normal(1, 0.01, rounds * frames)
            tests, references = counts(case, spec) if counts else (1.0, 1.0)
            measured = {
                "case": case.name, "algorithm": spec, "boxes": boxes, "frames": case.frames or 0,
                "seeds": [1, 2], "samples_ms": list(samples),
                "tests_by_seed": [tests * boxes] * 2, "references_by_seed": [references * boxes] * 2,
                "own_bytes": memory(case, spec) if memory else 1000, "peak_bytes": 2000, "phases": None,
            }
            if phases is not None:
                parts = {"mending_ms": 1.0, "moved": 1.0, "visited": 1.0, **phases(case, spec)}
                measured["phases"] = {name: [value] * len(samples) for name, value in parts.items()}
                measured["phases"]["movers"] = [1] * len(samples)
            measurements.append(measured)
    return Run(measurements)


def results_of(experiment: Experiment, time, counts=None, phases=None, memory=None, runs: int = 3) -> Results:
    return Results([run_of(experiment, number, time, counts, phases, memory) for number in range(1, runs + 1)], 0.95)

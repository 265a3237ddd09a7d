"""Section II: brute force tests every unique pair, and halving the square of n leaves a square."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate

COUNTS = (1_000, 2_000, 4_000, 8_000, 16_000, 32_000)  # with fewer boxes, the fixed cost of a call would show
LISTING, OURS = "paper_brute_force", "brute_force"


def case_of(boxes: int) -> str:
    return f"{boxes} boxes"


def cases() -> list[Case]:
    # The listing takes most of a second for the largest number of boxes; four calls are one on each input.
    return [Case(case_of(boxes), "uniform", [LISTING, OURS], boxes=boxes, take=["time", "counts"],
                 effort={"min_rounds": 4}) for boxes in COUNTS]


def time_growth(results: Results, spec: str) -> Estimate:
    return results.growth(COUNTS, lambda run, boxes: run.time(case_of(boxes), spec))


def share_of_all(results: Results, boxes: int) -> Estimate:
    """Tests over the square of n."""
    return results.between(lambda run: run.count(case_of(boxes), LISTING, "tests") / boxes)


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    beside = {
        "exponent of the tests": results.growth(
            COUNTS, lambda run, boxes: boxes * run.count(case_of(boxes), LISTING, "tests")),
        "exponent of the time of our brute force": time_growth(results, OURS),
    }
    for boxes in (COUNTS[0], COUNTS[-1]):  # statement 1a, a definition
        beside[f"tests over the square of n, {boxes:,} boxes"] = share_of_all(results, boxes)
        beside[f"tests over n (n - 1) / 2, {boxes:,} boxes"] = results.between(
            lambda run: run.count(case_of(boxes), LISTING, "tests") / ((boxes - 1) / 2))
    return [judged("1b", {"exponent of the time": time_growth(results, LISTING)}, above=rules.square_low,
                   below=rules.square_high, beside=beside)]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (times, tests) = figures.new(columns=2)
    for spec in (LISTING, OURS):
        figures.line(times, COUNTS, [results.time(case_of(boxes), spec) for boxes in COUNTS], figures.NAMES[spec])
    figures.label(times, "boxes", "milliseconds")
    figures.legend(times)
    figures.line(tests, COUNTS, [share_of_all(results, boxes) for boxes in COUNTS])
    figures.label(tests, "boxes", "tests over the square of n", log="x")
    yield figures.Figure("brute_force_tests", "Brute force by the number of boxes: time, and the tests of the "
                         "draft's over all pairs. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="Brute force tests every unique pair",
    measured=f"The time and the tests of the draft's brute force and of ours on {COUNTS[0]:,} to {COUNTS[-1]:,} "
             "uniform boxes in the plane.",
    claims=[
        Claim("1b", "Time grows as n to a power between {square_low} and {square_high}.",
              "It grows as n to a power outside of these."),
    ],
    cases=cases, judge=judge, figures=draw)

"""Section II: other methods are brute force on smaller collections, and overtake it as boxes are added."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate, crossing

COUNTS = tuple(2**power for power in range(3, 15))
LAST = COUNTS[-3:]
SCENES = ("uniform", "clustered", "thin")
LISTING = "paper_brute_force"
OTHERS = ("paper_grid", "paper_sweep_and_prune", "paper_quadtree")
OURS = "brute_force"
OUR_OTHERS = ("grid", "sweep_and_prune", "quadtree", "bvh", "auto")


def case_of(boxes: int, scene: str) -> str:
    return f"the draft's, {boxes} {scene} boxes"


def our_case(boxes: int, dimension: int) -> str:
    return f"ours, {boxes} boxes in {dimension}D"


def cases() -> list[Case]:
    # More than a dozen rounds would not decide anything beyond the runs.
    effort = {"share_seconds": 0.05, "min_rounds": 4}
    listed = [Case(case_of(boxes, scene), scene, [LISTING, *OTHERS], boxes=boxes, take=["time", "counts"],
                   effort=effort) for scene in SCENES for boxes in COUNTS]
    ours = [Case(our_case(boxes, dimension), "uniform", [LISTING, OURS, *OUR_OTHERS] if dimension == 2 else
                 [OURS, *OUR_OTHERS], boxes=boxes, dimension=dimension, effort=effort)
            for dimension in (2, 3) for boxes in COUNTS]
    return listed + ours


def place(spec: str, scene: str) -> str:
    return f"{figures.NAMES[spec]} on {scene} boxes"


def growth_below(results: Results, spec: str, scene: str) -> Estimate:
    """The difference between the exponent of brute force's tests and that of this algorithm's."""
    return results.growth(COUNTS, lambda run, boxes: run.count(case_of(boxes, scene), spec, "tests")
                          / run.count(case_of(boxes, scene), LISTING, "tests"))


def most_time(results: Results, spec: str, scene: str) -> Estimate:
    """The maximum of its time over brute force's at the largest numbers of boxes."""
    return results.between(lambda run: max(run.ratio(case_of(boxes, scene), spec, LISTING) for boxes in LAST))


def overtakes_at(results: Results, ways: dict[int, str], spec: str, other: str) -> Estimate:
    """The number of boxes from which one takes less time than the other, in cases by their number of boxes."""
    return results.between(lambda run: crossing(list(ways), [run.ratio(case, other, spec)
                                                             for case in ways.values()]), "boxes")


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    places = [(spec, scene) for spec in OTHERS for scene in SCENES]
    tests = {}
    crossings = {}
    for spec, scene in places:
        tests[f"tests of {place(spec, scene)} with {COUNTS[-1]:,} boxes"] = results.count(
            case_of(COUNTS[-1], scene), spec, "tests")
        crossings[f"{place(spec, scene)} overtakes at"] = overtakes_at(
            results, {boxes: case_of(boxes, scene) for boxes in COUNTS}, spec, LISTING)
    for dimension in (2, 3):
        for spec in OUR_OTHERS:
            crossings[f"{figures.NAMES[spec]} overtakes our brute force in {dimension}D at"] = overtakes_at(
                results, {boxes: our_case(boxes, dimension) for boxes in COUNTS}, spec, OURS)
    crossings["the draft's brute force over ours, with the most boxes"] = results.ratio(
        our_case(COUNTS[-1], 2), LISTING, OURS)
    return [
        judged("2a", {place(*at): growth_below(results, *at) for at in places}, below=-rules.smaller,
               where="the method is {}", beside=tests),
        judged("2c", {place(*at): most_time(results, *at) for at in places}, below=1 / rules.level,
               where="the method is {}", beside=crossings),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (tests, times) = figures.new(columns=2)
    for spec in (LISTING, *OTHERS):
        figures.line(tests, COUNTS, [results.count(case_of(boxes, "uniform"), spec, "tests") for boxes in COUNTS],
                     figures.NAMES[spec])
        figures.line(times, COUNTS, [results.ratio(case_of(boxes, "uniform"), spec, LISTING) for boxes in COUNTS])
    figures.label(tests, "boxes", "tests for each box")
    figures.label(times, "boxes", "time over brute force")
    figures.legend(tests, is_shared=True)
    yield figures.Figure("overtaking", "The draft's methods on uniform boxes in the plane, by the number of boxes. "
                         "Left: tests, for each box. Right: time over that of the draft's brute force. Bars: 95% "
                         "intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="The others are brute force on smaller collections",
    measured=f"Tests and time of the draft's four methods on {COUNTS[0]} to {COUNTS[-1]:,} uniform, clustered and "
             "thin boxes in the plane, and the time of ours on uniform boxes in the plane and in space.",
    claims=[
        Claim("2a",
              "The tests of grid, sweep and quadtree grow as n to a power that is more than {smaller} below that of "
              "brute force, on uniform, on clustered and on thin boxes.", "None of them does on any of these."),
        Claim("2c",
              "As we read it, a method that keeps collections small overtakes brute force as boxes are added: at each "
              f"of {LAST[0]:,}, {LAST[1]:,} and {LAST[2]:,} boxes grid, sweep and quadtree are faster by more than "
              "{level} times, on uniform, on clustered and on thin boxes.", "None of them is on any of these."),
    ],
    cases=cases, judge=judge, figures=draw)

"""Section VI-B: if most objects move, rebuilding all cells of a grid is faster than reinserting."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate, crossing

COUNTS = (1_000, 5_000, 50_000)
DRIFTS = (0.2, 2)  # in sizes of a box
MOVING = (0.05, 0.2, 0.5, 0.7, 1)
REINSERT, TRANSLATE, REBUILD = (f"paper_grid:update={update}" for update in ("reinsert", "translate", "rebuild"))
MENDING = ["mending"]
EFFORT = {"min_rounds": 5}


def series(boxes: int, drift: float) -> str:
    return f"{boxes:,} boxes that go {drift:g} of their size"


def case_of(boxes: int, drift: float, moving: float) -> str:
    return f"{100 * moving:g} % of {series(boxes, drift)}"


SERIES = [(boxes, drift) for boxes in COUNTS for drift in DRIFTS]


def cases() -> list[Case]:
    return [Case(case_of(boxes, drift, moving), "uniform", [REINSERT, TRANSLATE, REBUILD, "grid"], boxes=boxes,
                 seeds=2, frames=6, moving=moving, drift=drift, take=["time", "phases"], effort=EFFORT)
            for boxes, drift in SERIES for moving in MOVING]


def over_rebuilding(results: Results, case: str, update: str = REINSERT) -> Estimate:
    return results.ratio(case, update, REBUILD, MENDING)


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    most = {}
    beside = {}
    for boxes, drift in SERIES:
        beside[f"percent of {series(boxes, drift)} from which on rebuilding is faster"] = results.between(
            lambda run: crossing([100 * moving for moving in MOVING], [
                run.ratio(case_of(boxes, drift, moving), REINSERT, REBUILD, MENDING) for moving in MOVING]))
        for moving in MOVING:
            case = case_of(boxes, drift, moving)
            if moving > rules.most_objects:
                most[case] = over_rebuilding(results, case)
                beside[f"translating over rebuilding, {case}"] = over_rebuilding(results, case, TRANSLATE)
                beside[f"frames reinserting over rebuilding, {case}"] = results.ratio(case, REINSERT, REBUILD)
                beside[f"frames reinserting over our grid, {case}"] = results.ratio(case, REINSERT, "grid")
    return [judged("11a", most, above=rules.level, where="{} move", beside=beside)]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, places = figures.new(columns=2)
    for axes, drift in zip(places, DRIFTS):
        for boxes in COUNTS:
            figures.line(axes, [100 * moving for moving in MOVING],
                         [over_rebuilding(results, case_of(boxes, drift, moving)) for moving in MOVING],
                         f"{boxes:,} boxes")
        axes.axhline(1, color="black", linewidth=0.6)
        figures.label(axes, "boxes that move, in percent", "reinserting over rebuilding",
                      f"Steps of {drift:g} of a box's size")
    figures.legend(places[0], is_shared=True)
    yield figures.Figure("grid_rebuilding", "The time to mend the draft's grid by reinserting what moved, over that "
                         "of adding all boxes to empty cells. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="Grid: reinserting or rebuilding",
    measured="The time to mend the cells of the draft's grid, whose size is twice a mean box, on uniform boxes in the "
             "plane: each mover found by one hash and placed by another, or all boxes added to empty cells. What "
             "stays in its cells is not touched.",
    claims=[Claim("11a",
                  "Wherever more than {most_objects} of the boxes move, mending takes more than {level} times as long "
                  "by reinserting as by rebuilding.", "Nowhere it does.")],
    cases=cases, judge=judge, figures=draw)

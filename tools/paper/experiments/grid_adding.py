"""Section III: with cells much smaller than boxes, the time goes into adding references."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate, crossing

COUNTS = (200, 1_000)  # hundreds of boxes
NEIGHBOURS = (0.5, 1, 4, 16, 64)
ACROSS = (1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 16, 64)  # cells across a box
SMALLEST = ACROSS[-1]
OWN = f"grid:cell={1 / SMALLEST:g}"

PARTS = ("initializing", "adding", "searching")
EFFORT = {"min_rounds": 5}


def spec(across: float) -> str:
    return f"paper_grid:cell={1 / across:g}:limit=none"


SPECS = [spec(across) for across in ACROSS]


def case_of(boxes: int, neighbours: float, is_kept: bool = False) -> str:
    return f"{boxes:,} boxes of {neighbours:g} neighbour{'s' if neighbours != 1 else ''}" + (
        ", cells kept" if is_kept else "")


def many(threshold: float) -> list[float]:
    return [across for across in ACROSS if across >= threshold]


def cases() -> list[Case]:
    scenes = {neighbours: f"uniform:neighbours={neighbours:g}" for neighbours in NEIGHBOURS}
    anew = [Case(case_of(boxes, neighbours), scenes[neighbours], [*SPECS, "grid", OWN], boxes=boxes, seeds=4,
                 take=["time", "counts", "phases"], made_anew=True, effort=EFFORT)
            for boxes in COUNTS for neighbours in NEIGHBOURS]
    kept = [Case(case_of(COUNTS[0], neighbours, True), scenes[neighbours], SPECS[-2:], boxes=COUNTS[0], seeds=4,
                 take=["time", "phases"], effort=EFFORT)
            for neighbours in NEIGHBOURS]
    return anew + kept


def adding(results: Results, case: str, across: Sequence[float], parts: Sequence[str] = PARTS) -> Estimate:
    """The share of the time spent adding references: the minimum over these cell sizes."""
    return results.between(lambda run: min(
        run.ratio(case, spec(one), spec(one), ["adding"], parts) for one in across))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    small = many(rules.large_multiple)
    shares = {}
    waste = {}
    shares_beside = {}
    waste_beside = {}
    for boxes in COUNTS:
        for neighbours in NEIGHBOURS:
            case = case_of(boxes, neighbours)
            shares[case] = adding(results, case, small)
            shares_beside[f"without the time of empty cells, {case}"] = adding(results, case, small, PARTS[1:])
            if neighbours in (1, 4):
                waste[case] = results.ratio(case, spec(SMALLEST), results.fastest(case, SPECS))
                waste_beside[f"our grid with such cells over its choice, {case}"] = results.ratio(case, OWN, "grid")
        shares_beside[f"neighbours of {boxes} boxes from which on it is less"] = results.between(
            lambda run: crossing(NEIGHBOURS, [1 / min(
                run.ratio(case_of(boxes, one), spec(across), spec(across), ["adding"], PARTS) for across in small)
                for one in NEIGHBOURS], 1 / rules.most_of_the_time))
    for neighbours in NEIGHBOURS:
        case = case_of(COUNTS[0], neighbours, True)
        shares_beside[case] = adding(results, case, small)
    return [
        judged("4b", shares, above=rules.most_of_the_time, where="there are {}", beside=shares_beside),
        judged("4c", waste, above=rules.twice, fails_at=rules.level, where="there are {}", beside=waste_beside),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (shares, times) = figures.new(columns=2)
    for neighbours in NEIGHBOURS:
        case = case_of(COUNTS[-1], neighbours)
        timed = [across for across in ACROSS if results.timed(case, [spec(across)])]
        best = results.fastest(case, SPECS)
        figures.line(shares, timed, [adding(results, case, [across]) for across in timed])
        figures.line(times, timed, [results.ratio(case, spec(across), best) for across in timed], f"{neighbours:g}")
    figures.label(shares, "cells across a box", "share of the time for adding", log="x")
    figures.label(times, "cells across a box", "time over the best")
    figures.legend(times, "neighbours of a box", is_shared=True)
    yield figures.Figure("grid_adding", f"The draft's grid, built anew for each call, on {COUNTS[-1]:,} boxes, by the "
                         "cells across a box. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="Small cells: the time goes into adding",
    measured="The draft's grid, built anew for each call, on 200 and on 1,000 uniform boxes in the plane that overlap "
             "few others or many, with cells from eight lengths of a box down to a 64th: the time of making empty "
             "cells, of adding boxes and of testing them.",
    claims=[
        Claim("4b",
              "Wherever {large_multiple} cells and more lie across a box, adding hundreds of boxes takes more than "
              "{most_of_the_time} of the time of a call, in worlds of every density.",
              "In no world it does."),
        Claim("4c",
              "With the smallest cells, 64 across a box, a call takes more than {twice} times as long as with the "
              "best ones, in each world of 1 or 4 neighbours.", "In each it takes less than {level} times as long."),
    ],
    cases=cases, judge=judge, figures=draw)

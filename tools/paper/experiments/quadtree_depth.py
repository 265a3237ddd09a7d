"""Section VI-D: how many nodes an insertion from the root of a quadtree visits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy

from .. import figures
from ..experiment import Boxes, Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate

COUNTS = (1_000, 4_000, 16_000, 64_000, 256_000)
SPREAD = {0.1: "boxes mostly in one leaf", 4: "boxes in several leaves"}  # by the number of others that a box overlaps
FAR = 10_000  # distance of one box from the others, in worlds: the tree is deep for such a distance
FAR_CASE = f"{COUNTS[0]:,} boxes, one of them far away"
ROOT = "paper_quadtree:update=root"
MOTION = {"frames": 3, "moving": 0.1, "drift": 20, "take": ["phases"]}  # out of their leaves


def case_of(boxes: int, neighbours: float) -> str:
    return f"{boxes:,} boxes, {SPREAD[neighbours].removeprefix('boxes ')}"


def with_one_far_away(random: numpy.random.Generator) -> numpy.ndarray:
    side = math.sqrt(COUNTS[0] * 4 / 0.1)
    minima = random.uniform(0, side, (COUNTS[0], 2))
    minima[-1] = FAR * side
    return numpy.hstack([minima, minima + random.uniform(0.5, 1.5, minima.shape)])


def cases() -> list[Case]:
    # Counts are the same in each round.
    once = {"min_rounds": 2, "share_seconds": 0.02}
    uniform = [Case(case_of(boxes, neighbours), f"uniform:neighbours={neighbours}", [ROOT], boxes=boxes,
                    effort=once, **MOTION) for neighbours in SPREAD for boxes in COUNTS]
    return [*uniform, Case(FAR_CASE, Boxes("one-far-away", with_one_far_away, inputs=2), [ROOT], boxes=COUNTS[0],
                           **MOTION)]


def nodes(results: Results, case: str) -> Estimate:
    return results.per_mover(case, ROOT, "visited")


def over_logarithm(results: Results, neighbours: float) -> Estimate:
    """Nodes visited per mover over the logarithm of n: with the most boxes over that with the fewest."""
    def work(run: Run, boxes: int) -> float:
        return run.per_mover(case_of(boxes, neighbours), ROOT, "visited") / math.log2(boxes)

    return results.between(lambda run: work(run, COUNTS[-1]) / work(run, COUNTS[0]))


def share(results: Results, case: str) -> Estimate:
    """Nodes visited, as a share of all nodes visited and entries removed or inserted."""
    def of(run: Run) -> float:
        visited, moved = (run.per_mover(case, ROOT, what) for what in ("visited", "moved"))
        return visited / (visited + moved)

    return results.between(of)


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    ends = [case_of(boxes, neighbours) for neighbours in SPREAD for boxes in (COUNTS[0], COUNTS[-1])]
    beside = {f"nodes of a mover, {case}": nodes(results, case) for case in [*ends, FAR_CASE]}
    for neighbours, spread in SPREAD.items():
        beside[f"exponent of the time of a mover, {spread}"] = results.growth(
            COUNTS, lambda run, boxes: run.time(case_of(boxes, neighbours), ROOT, ["mending"]) / boxes)
    return [
        judged("14d", {spread: over_logarithm(results, neighbours) for neighbours, spread in SPREAD.items()},
               below=rules.twice, where="there are {}", beside=beside),
        judged("14e", {case: share(results, case) for case in ends}, below=rules.part, where="there are {}"),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (visits, shares) = figures.new(columns=2)
    for neighbours, spread in SPREAD.items():
        figures.line(visits, COUNTS, [nodes(results, case_of(boxes, neighbours)) for boxes in COUNTS], spread)
        figures.line(shares, COUNTS, [share(results, case_of(boxes, neighbours)) for boxes in COUNTS])
    figures.label(visits, "boxes", "nodes that a mover visits", log="x")
    figures.label(shares, "boxes", "share of nodes in what is done", log="x")
    figures.legend(visits, is_shared=True)
    yield figures.Figure("quadtree_depth", "A tenth of uniform boxes inserted from the root of the draft's quadtree. "
                         "Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="The way from the root of a quadtree",
    measured="The nodes that are visited for a mover, and the entries that are taken out and put in, where a tenth of "
             f"{COUNTS[0]:,} to {COUNTS[-1]:,} uniform boxes go 20 times their size and are inserted from the root "
             "of the draft's quadtree.",
    claims=[
        Claim("14d",
              f"From {COUNTS[0]:,} to {COUNTS[-1]:,} uniform boxes, mostly in one leaf or in several, the nodes that "
              "a mover visits grow less than {twice} times as much as the logarithm of n.", "They grow more."),
        Claim("14e",
              "Nodes that are visited are a smaller part than {part} of all that is done for a mover: nodes visited, "
              "and entries taken out and put in.", "They are a larger part."),
    ],
    cases=cases, judge=judge, figures=draw)

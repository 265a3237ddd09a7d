"""Section V: boxes of unit size suit a quadtree; large ones multiply with its levels, and fill it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy

from .. import figures
from ..experiment import Boxes, Case, Claim, Experiment
from ..judge import Asked, Finding, judged_all
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate

SIDE = 32                        # of the world in which one box is followed; each unit square contains a small box
LEAVES = (8, 4, 2, 1)            # sides of leaves, one per level
SINGLE = (0.25, 1.0, 4.0, 16.0)  # lengths of the box that is followed
LARGE_SIDE = 100
LARGE = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)  # lengths of one box in a hundred
TREE, YARDSTICK = "paper_quadtree", "bvh"
OTHERS = ("quadtree", "grid", "paper_grid")


def small_boxes(side: int, random: numpy.random.Generator) -> numpy.ndarray:
    """Half a unit long, one in each unit square, none on a square's border, so that leaves depend only on the
    capacity."""
    squares = numpy.stack(numpy.meshgrid(numpy.arange(side), numpy.arange(side)), axis=-1).reshape(-1, 2)
    minima = squares + random.uniform(0.01, 0.49, squares.shape)
    return numpy.hstack([minima, minima + 0.5])


def with_one(size: float) -> Boxes:
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        small = small_boxes(SIDE, random)
        minima = random.uniform(0, SIDE - size, 2)
        return numpy.vstack([small, [*minima, *(minima + size)]])
    return Boxes(f"one-{size:g}", make, inputs=64)


def with_large(size: float) -> Boxes:
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        boxes = small_boxes(LARGE_SIDE, random)
        large = boxes[50::100]
        large[:, :2] = numpy.minimum(large[:, :2], LARGE_SIDE - size)
        large[:, 2:] = large[:, :2] + size
        return boxes
    return Boxes(f"large-{size:g}", make)


def single_case(size: float) -> str:
    return f"one box of {size:g} units"


def large_case(size: float) -> str:
    return f"large boxes of {size:g} units"


def leaves_of(side: int) -> str:
    """The tree with leaves of this side: each holds two boxes for each unit square."""
    return f"{TREE}:capacity={2 * side**2}:left=0:top=0:width={SIDE}:height={SIDE}"


def cases() -> list[Case]:
    single = [Case(single_case(size), with_one(size), [leaves_of(side) for side in LEAVES], take=["counts"])
              for size in SINGLE]
    large = [Case(large_case(size), with_large(size), [TREE, YARDSTICK, *OTHERS], take=["time", "counts"])
             for size in LARGE]
    return single + large


def leaves(run: Run, size: float, side: int) -> numpy.ndarray:
    """The number of leaves of this side that the box is in, on each input; each small box is in one leaf."""
    measured = run.measurement(single_case(size), leaves_of(side))
    return numpy.array(measured["references_by_seed"]) - (measured["boxes"] - 1)


def over_level_above(results: Results, size: float, side: int) -> Estimate:
    return results.between(lambda run: leaves(run, size, side).mean() / leaves(run, size, 2 * side).mean())


def grown(results: Results, spec: str, figure) -> Estimate:
    """The ratio of a figure with the largest boxes to that with small boxes only."""
    return results.between(
        lambda run: figure(run, large_case(LARGE[-1]), spec) / figure(run, large_case(LARGE[0]), spec))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    unit = {}
    for size in SINGLE:
        for side in LEAVES[1:]:
            if size > side:
                continue
            place = f"a box of {size:g} in leaves of {side}"
            unit[place] = {
                f"times as many leaves as in the level above, {place}": Asked(
                    over_level_above(results, size, side), below=rules.suits),
                f"most leaves, {place}": Asked(results.largest(lambda run: leaves(run, size, side).max()),
                                               below=rules.corner),
            }
    largest = SINGLE[-1]
    factors = {side: over_level_above(results, largest, side) for side in LEAVES[1:]}
    steepest = max(factors, key=lambda side: factors[side].value)
    fourfold = {"the largest box": {f"most times as many leaves as in the level above, a box of {largest:g}": Asked(
        factors[steepest], above=rules.fourfold_low, below=rules.fourfold_high, fails_at=rules.twice)}}
    levels = {f"leaves of a box of {largest:g} where leaves are of {side}": results.between(
        lambda run: leaves(run, largest, side).mean()) for side in LEAVES}

    references = grown(results, TREE, lambda run, case, spec: run.count(case, spec, "references"))
    time = grown(results, TREE, lambda run, case, spec: run.ratio(case, spec, YARDSTICK))
    bookkeeping = {
        "in references": {"times as many references": Asked(references, above=rules.twice, fails_at=rules.clearly)},
        "in time": {"time over a tree of bounds, times as much": Asked(time, above=rules.level)},
    }
    beside = {}
    for size in LARGE:
        beside[f"references of a box, large ones of {size:g}"] = results.count(large_case(size), TREE, "references")
    for spec in (TREE, YARDSTICK, *OTHERS):
        beside[f"time with the largest over that with small boxes, {figures.NAMES[spec]}"] = grown(
            results, spec, lambda run, case, one: run.time(case, one))
    return [
        judged_all("7a", unit, where="it is {}"),
        judged_all("7b", fourfold, beside=levels),
        judged_all("7c", bookkeeping, where="it is counted {}", beside=beside),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (single, large) = figures.new(columns=2)
    for size in SINGLE:
        figures.line(single, LEAVES, [results.between(lambda run: leaves(run, size, side).mean()) for side in LEAVES],
                     f"{size:g}")
    figures.label(single, "side of a leaf, in units", "leaves of a box")
    figures.legend(single, "length of the box")
    for spec in (TREE, *OTHERS):
        figures.line(large, LARGE, [results.count(large_case(size), spec, "references") for size in LARGE],
                     figures.NAMES[spec])
    figures.label(large, "length of a large box, in units", "references of a box")
    figures.legend(large)
    yield figures.Figure("quadtree_sizes", "Left: the leaves that one box is in, by its length and theirs. Right: "
                         "references where one box in a hundred is large. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="Large boxes fill a quadtree",
    measured="The leaves of the draft's quadtree that one box is in, by its size and theirs, among small boxes in a "
             f"world of {SIDE} by {SIDE} units; and references and time, as one box in a hundred of {LARGE_SIDE**2:,} "
             "becomes larger, with our tree of bounds for what the more pairs cost anyway.",
    claims=[
        Claim("7a",
              "Wherever a box is no longer than a leaf, it is in fewer than {suits} times as many leaves as in a tree "
              "of one level less, and in fewer than {corner} at most.", "Nowhere it is."),
        Claim("7b",
              "A level more multiplies the leaves of the largest box by up to a number between {fourfold_low} and "
              "{fourfold_high}.", "It multiplies them by up to a number below {twice}, or above {fourfold_high}."),
        Claim("7c",
              "With one box in a hundred large, a box has more than {twice} times as many references as with small "
              "ones alone; and the time, over that of a tree of bounds, which has the same pairs to report and one "
              "reference a box, is more than {level} times as much.",
              "A box has fewer than {clearly} times as many, and the time is less than {level} times as much."),
    ],
    cases=cases, judge=judge, figures=draw)

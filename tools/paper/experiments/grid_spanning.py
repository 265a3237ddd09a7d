"""Section III: with cells of unit size, the number of an object's references is its width times its height."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy

from .. import figures
from ..experiment import Boxes, Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate

BOXES = 200
WORLD = 1024
SPEC = "paper_grid:cell=1:limit=none"
SQUARES = tuple((2**power, 2**power) for power in range(8))
FLAT = (128, 4)

Size = tuple[int, int]


def boxes_of(size: Size) -> Boxes:
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        minima = random.uniform(0, WORLD - numpy.array(size), (BOXES, 2))
        return numpy.hstack([minima, minima + size])
    return Boxes(f"boxes-of-{size[0]}-{size[1]}", make)


def case_of(size: Size) -> str:
    return f"{size[0]} x {size[1]} cells"


def cases() -> list[Case]:
    return [Case(case_of(size), boxes_of(size), [SPEC], take=["counts"]) for size in (*SQUARES, FLAT)]


def over_product(results: Results, size: Size) -> Estimate:
    """References of a box over its width times its height."""
    return results.between(lambda run: run.count(case_of(size), SPEC, "references") / (size[0] * size[1]))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    large = [size for size in SQUARES if min(size) >= rules.large_multiple]
    rest = {f"boxes of {case_of(size)}": over_product(results, size)
            for size in (*SQUARES, FLAT) if size not in large}
    return [judged("4a", {f"boxes of {case_of(size)}": over_product(results, size) for size in large},
                   below=rules.about, fails_at=rules.clearly, where="there are {}", beside=rest)]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (axes,) = figures.new(height=2.2)
    widths = [size[0] for size in SQUARES]
    figures.line(axes, widths, [over_product(results, size) for size in SQUARES], "counted")
    axes.plot(widths, [(1 + 1 / width)**2 for width in widths], "k:", zorder=5,
              label="(1 + 1 / width) (1 + 1 / height)")
    figures.label(axes, "width and height of a box, in cells", "references over its area")
    figures.legend(axes)
    yield figures.Figure("grid_spanning", "References of a box at a random place in the draft's grid, over its width "
                         "times its height in cells.", drawing)


EXPERIMENT = Experiment(
    title="Width times height references",
    measured=f"The references that the draft's grid with cells of unit size has to {BOXES} boxes of one size at "
             "random places, squares of 1 to 128 cells and a flat box.",
    claims=[Claim("4a",
                  "Boxes of {large_multiple} cells and more in width and height have fewer than {about} times as many "
                  "references as their width times their height.",
                  "They all have more than {clearly} times as many.")],
    cases=cases, judge=judge, figures=draw)

"""Section VI-B: references translated to neighbouring cells, or a box inserted again."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy

from .. import figures
from ..experiment import Boxes, Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate, between_runs

REINSERT, TRANSLATE = "reinsert", "translate"
MENDING = ["mending"]
FRAMES = 6

# Boxes that span cells, each overlapping 16 others: the length of a cell in lengths of a box, and steps in cells.
CELLS = (8, 4, 2, 1, 1 / 2, 1 / 4, 1 / 8)
STEPS = {1: CELLS, 0.1: CELLS[::3]}
STEP_NAMES = {1: "steps of a cell", 0.1: "steps of a tenth of a cell"}
SPANNING = 2_500

# Boxes of 1 x 1 within a single cell. A step along a direction is long enough to leave the cell on at least one axis.
SINGLE = 10_000
SINGLE_CELL = 256
IN_A_CELL = (1, 4, 16)
MOVING = (0.05, 0.2, 1)

ENDS = 100_000  # number of box ends, for the rule of the offset


def spec(update: str, cell: float) -> str:
    return f"paper_grid:cell={cell:g}:limit=none:update={update}"


def specs(cell: float) -> list[str]:
    return [spec(update, cell) for update in (REINSERT, TRANSLATE)]


def spanning(step: float, cell: float) -> str:
    return f"cells of {cell:g} box lengths, {STEP_NAMES[step]}"


def single(moving: float, in_a_cell: int) -> str:
    return f"{100 * moving:g} % move, {in_a_cell} {'box' if in_a_cell == 1 else 'boxes'} in a cell"


def squares(count: int, world: float) -> Boxes:
    """Boxes of 1 x 1, anywhere in a world of this length."""
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        minima = random.uniform(0, world, (count, 2))
        return numpy.hstack([minima, minima + 1])
    return Boxes(f"squares-{count}-{world:.0f}", make, inputs=2)


def cases() -> list[Case]:
    large = [Case(spanning(step, cell), squares(SPANNING, math.sqrt(SPANNING / 4)), specs(cell), frames=FRAMES,
                  moving=0.2, drift=step * cell, take=["phases"]) for step, cells in STEPS.items() for cell in cells]
    small = [Case(single(moving, in_a_cell), squares(SINGLE, SINGLE_CELL * math.sqrt(SINGLE / in_a_cell)),
                  specs(SINGLE_CELL), frames=FRAMES, moving=moving, drift=math.sqrt(2) * SINGLE_CELL, take=["phases"])
             for moving in MOVING for in_a_cell in IN_A_CELL]
    return large + small


def over_translating(results: Results, case: str, cell: float) -> Estimate:
    return results.ratio(case, *specs(cell), MENDING)


def cells_of_a_box(results: Results, cell: float) -> Estimate:
    return results.count(spanning(1, cell), spec(REINSERT, cell), "references")


def rule_is_right(results: Results, step: float, is_down: bool, is_signed: bool = False) -> Estimate:
    """The share of box ends with this motion for which the draft's rule predicts correctly whether they leave their
    cell: they do if the change of position is greater than the position modulo the cell size."""
    def of_run(run: int) -> float:
        random = numpy.random.default_rng([run, ENDS])
        position = random.uniform(0, 1, ENDS)  # within its cell
        change = step * numpy.cos(random.uniform(0, math.pi / 2, ENDS)) * (-1 if is_down else 1)
        says = (change if is_signed else abs(change)) > position
        return float(numpy.mean(says == (numpy.floor(position + change) != 0)))
    return between_runs([of_run(run) for run in range(len(results.runs))], results.confidence)


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    most = CELLS[-1]
    beside = {}
    for step, cells in STEPS.items():
        for cell in cells:
            case = spanning(step, cell)
            if (step, cell) != (1, most):
                beside[case] = over_translating(results, case, cell)
            for update, name in ((REINSERT, "reinserting"), (TRANSLATE, "translating")):
                beside[f"references moved by {name}, {case}"] = results.per_mover(case, spec(update, cell), "moved")
    one_cell = [single(moving, in_a_cell) for moving in MOVING for in_a_cell in IN_A_CELL]
    offset = {}
    signed = {}
    for is_down, border in ((True, "lower"), (False, "upper")):
        for step in STEPS:
            way = f"towards the {border} border, {STEP_NAMES[step]}"
            offset[way] = rule_is_right(results, step, is_down)
            signed[f"with the sign of the change, {way}"] = rule_is_right(results, step, is_down, True)
    return [
        judged("10a", {f"boxes are in {cells_of_a_box(results, most).value:.0f} cells":
                       over_translating(results, spanning(1, most), most)},
               above=rules.level, where="{}", beside=beside),
        judged("10b", {case: over_translating(results, case, SINGLE_CELL) for case in one_cell},
               below=1 / rules.level, where="{}",
               beside={f"references moved by reinserting, {case}": results.per_mover(
                   case, spec(REINSERT, SINGLE_CELL), "moved") for case in one_cell}),
        judged("10c", offset, above=rules.right, where="boxes move {}", beside=signed),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (large, small) = figures.new(columns=2)
    for step, cells in STEPS.items():
        figures.line(large, [cells_of_a_box(results, cell).value for cell in cells],
                     [over_translating(results, spanning(step, cell), cell) for cell in cells],
                     STEP_NAMES[step])
    figures.label(large, "cells of a box", "reinserting over translating", "Boxes that span cells")
    figures.legend(large)
    for in_a_cell in IN_A_CELL:
        figures.line(small, [100 * moving for moving in MOVING],
                     [over_translating(results, single(moving, in_a_cell), SINGLE_CELL) for moving in MOVING],
                     f"{in_a_cell}")
    figures.label(small, "boxes that move, in percent", "", "Boxes in a single cell")
    figures.legend(small, "boxes in a cell")
    for axes in (large, small):
        axes.axhline(1, color="black", linewidth=0.6)
    yield figures.Figure("grid_translation", "The time to mend the draft's grid by reinserting what moved, over that "
                         "by translating its references; above 1 translating is faster. Left: a fifth of "
                         f"{SPANNING:,} boxes moves, by the cells that a box touches. Right: boxes of a 256th of a "
                         "cell leave theirs. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="Grid: translating or reinserting",
    measured=f"The time to mend the cells of the draft's grid by both ways: where a fifth of {SPANNING:,} boxes that "
             f"span ever more cells moves, and where some or all of {SINGLE:,} boxes of a {SINGLE_CELL}th of a cell "
             f"leave it. And the draft's rule by the offset, for {ENDS:,} ends of boxes at random places in their "
             "cells.",
    claims=[
        Claim("10a",
              "Where boxes span the most cells and go one cell, mending takes more than {level} times as long by "
              "reinserting as by translating.", "It does not."),
        Claim("10b",
              "Wherever boxes in a single cell leave it, mending takes more than {level} times as long by translating "
              "as by reinserting.", "Nowhere it does."),
        Claim("10c",
              "Of ends that move towards the lower and towards the upper border, by a cell or a tenth, the rule is "
              "right about more than {right}, taking the change of position without its sign.",
              "It is right about fewer in every case."),
    ],
    cases=cases, judge=judge, figures=draw)

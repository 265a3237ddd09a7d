"""Section III: a matrix of cells exhausts the memory, and larger cells no longer keep collections small."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy

from .. import figures
from ..experiment import Boxes, Case, Claim, Experiment
from ..judge import Asked, Finding, judged, judged_all
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate

BOXES = 8_000
CLUSTERS = 16
DEVIATION = 6.0  # of the boxes of a cluster from its centre, in lengths of a box: a box overlaps about 4 others
CELL = 2.0       # in lengths of a box

# Lengths of a world, in lengths of a box; the largest has 1.6 GB of cells.
WORLDS = tuple(2**power for power in range(9, 15))
SMALLEST, LARGEST = WORLDS[0], WORLDS[-1]
# Cells in the middle one of these worlds, down to as many as the largest world has.
MIDDLE = 1024
CELLS = tuple(CELL * MIDDLE / world for world in WORLDS if world >= MIDDLE)

# Cells take most of a search's time here; an estimate from fewer boxes would attribute it to boxes.
UNHURRIED = {"budget_seconds": 1000}

ACROSS = 256  # number of cells across a world whose cells grow with its size
OTHERS = ("grid", "bvh")


def clusters(world: int, dimension: int = 2) -> Boxes:
    """The same number of boxes in every world, in clusters that are ever further apart."""
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        middles = random.uniform(4 * DEVIATION, world - 4 * DEVIATION, (CLUSTERS, dimension))
        centres = middles[random.integers(CLUSTERS, size=BOXES)]
        centres = numpy.clip(random.normal(centres, DEVIATION), 1, world - 1)
        half = random.uniform(0.25, 0.75, (BOXES, dimension))
        return numpy.hstack([centres - half, centres + half])
    return Boxes(f"clusters-{dimension}d-{world}", make, inputs=2)


def spec(world: int, cell: float) -> str:
    return f"paper_grid:cell={cell:g}:limit=none:left=0:top=0:width={world}:height={world}"


def memory_case(world: int, cell: float) -> str:
    return f"cells of {cell:g} in a world of {world}"


def large_case(world: int, dimension: int = 2) -> str:
    return f"{ACROSS} cells across a world of {world} in {dimension}D"


def cases() -> list[Case]:
    held = {(world, CELL) for world in WORLDS} | {(MIDDLE, cell) for cell in CELLS}
    memory = [Case(memory_case(*one), clusters(one[0]), [spec(*one), f"paper_grid:cell={one[1]:g}", "grid"],
                   take=["memory"], effort=UNHURRIED) for one in sorted(held)]
    large = [Case(large_case(world), clusters(world), [spec(world, world / ACROSS), *OTHERS],
                  take=["time", "counts"]) for world in WORLDS]
    space = [Case(large_case(world, 3), clusters(world, 3), ["grid"], dimension=3, take=["time", "counts"])
             for world in (SMALLEST, LARGEST)]
    return memory + large + space


def held(run: Run, world: int, cell: float = CELL) -> float:
    return run.memory(memory_case(world, cell), spec(world, cell))


def bytes_of_a_cell(run: Run) -> float:
    return held(run, LARGEST) / (LARGEST / CELL)**2


def grown(results: Results, algorithm: str, what: str, dimension: int = 2) -> Estimate:
    """Tests per box, or the time, in the largest world over that in the smallest."""
    def of(run: Run, world: int) -> float:
        case = large_case(world, dimension)
        one = spec(world, world / ACROSS) if algorithm == "paper_grid" else algorithm
        return run.time(case, one) if what == "time" else run.count(case, one, what)
    return results.between(lambda run: of(run, LARGEST) / of(run, SMALLEST))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    growing = {
        "with the world's length": results.growth(WORLDS, held),
        "with the cells in a length": results.growth(
            [CELL / cell for cell in CELLS], lambda run, cells: held(run, MIDDLE, CELL / cells)),
    }
    case = memory_case(LARGEST, CELL)
    memory = {
        "a cell": results.between(bytes_of_a_cell, "bytes"),
        f"the largest world, {LARGEST / CELL:,.0f} cells wide": results.between(
            lambda run: held(run, LARGEST) / 1e6, "MB"),
        f"cells across a world whose cells take {rules.full_gb:g} GB": results.between(
            lambda run: (1e9 * rules.full_gb / bytes_of_a_cell(run))**0.5),
        "the boxes": results.between(lambda run: BOXES * 16 / 1e6, "MB"),
        "the draft's grid where its cells are enlarged to fit": results.between(
            lambda run: run.memory(case, f"paper_grid:cell={CELL:g}") / 1e6, "MB"),
        "our grid": results.between(lambda run: run.memory(case, "grid") / 1e6, "MB"),
    }
    tested = {
        "tests a box": Asked(grown(results, "paper_grid", "tests"), above=rules.twice, fails_at=rules.clearly),
        "time": Asked(grown(results, "paper_grid", "time"), above=rules.clearly, fails_at=rules.level),
    }
    others = {f"{what}, {figures.NAMES[one]}": grown(results, one, count)
              for one in OTHERS for what, count in (("tests a box", "tests"), ("time", "time"))}
    others["tests a box, our grid in 3D"] = grown(results, "grid", "tests", 3)
    return [
        judged("3a", growing, above=rules.square_low, fails_at=rules.bounded, where="memory grows {}", beside=memory),
        judged_all("3b", {"the largest world": tested}, beside=others),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (memory, tests) = figures.new(columns=2)
    specs = {"the draft's grid": lambda world: spec(world, CELL), "our grid": lambda world: "grid"}
    for name, one in specs.items():
        figures.line(memory, [world / CELL for world in WORLDS], [results.between(
            lambda run: run.memory(memory_case(world, CELL), one(world)) / 1e6) for world in WORLDS], name)
    figures.label(memory, "length of the world, in cells", "megabytes")
    figures.legend(memory, is_shared=True)
    figures.line(tests, WORLDS, [results.count(large_case(world), spec(world, world / ACROSS), "tests")
                                 for world in WORLDS], "the draft's grid")
    figures.line(tests, WORLDS, [results.count(large_case(world), "grid", "tests") for world in WORLDS], "our grid")
    figures.label(tests, "length of the world, in those of a box", "tests a box")
    yield figures.Figure("grid_memory", f"{BOXES:,} boxes in {CLUSTERS} clusters that lie ever further apart. Left: "
                         "memory with cells of two lengths of a box. Right: tests where cells grow with the world.",
                         drawing)


EXPERIMENT = Experiment(
    title="Cells fill the memory, or the cells are full",
    measured=f"The draft's grid on {BOXES:,} boxes in {CLUSTERS} clusters: its memory in ever larger worlds and with "
             f"ever smaller cells, up to {LARGEST / CELL:,.0f} cells across, and its tests and time where {ACROSS} "
             "cells across the world are all there are; beside it our grid and our tree of bounds.",
    claims=[
        Claim("3a",
              "Memory grows as the length of the world, and as the cells in a length of it, to a power above "
              "{square_low}, though there are no more boxes.",
              "It grows to a power below {bounded} with both."),
        Claim("3b",
              "Where cells grow with the world, tests a box in the largest are more than {twice} times those in the "
              "smallest, and the time is more than {clearly} times as long.",
              "Tests are less than {clearly} times as many, or time is less than {level} times as long."),
    ],
    cases=cases, judge=judge, figures=draw)

"""Our own claim: no single algorithm is the fastest everywhere, and choosing by a sample loses less than any single
one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import isfinite

import numpy

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Asked, Finding, judged, judged_all
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate, geometric_mean

SINGLE = ("brute_force", "grid", "sweep_and_prune", "quadtree", "bvh")
CHOICE = "auto"
FRAMES = 4
EFFORT = {"share_seconds": 0.03, "min_rounds": 4}

# With more boxes, brute force obviously takes far too long.
MOST_BY_BRUTE_FORCE = 2_000


@dataclass(frozen=True)
class Field:
    """One place of a map: a number of boxes, and one property that makes boxes easy or hard."""

    map: str
    scene: str
    dimension: int
    boxes: int
    value: float

    @property
    def moves(self) -> bool:
        return self.map == MOTION

    @property
    def case(self) -> str:
        return f"{self.map}: {self.value:g}, {self.boxes:,} boxes in {self.dimension}D"

    @property
    def single(self) -> list[str]:
        return [name for name in SINGLE if name != "brute_force" or self.boxes <= MOST_BY_BRUTE_FORCE]


MOTION = "the share that moves"
MAPS = {
    "overlaps of a box": ("uniform:neighbours={:g}", (2, 3), (0.5, 4, 16, 64)),
    "the largest size over the smallest": ("power_law:ratio={:g}", (2,), (10, 316, 10_000)),
    "the width of clusters": ("clustered:spread={:g}", (2,), (0.1, 0.017, 0.003)),
    MOTION: ("uniform", (2, 3), (0.01, 0.1, 1)),
}
COUNTS = (100, 1_000, 10_000, 100_000)


def fields() -> list[Field]:
    return [Field(name, scene.format(value), dimension, boxes, value)
            for name, (scene, dimensions, values) in MAPS.items() for dimension in dimensions for value in values
            for boxes in COUNTS]


def cases() -> list[Case]:
    return [Case(field.case, field.scene, [*field.single, CHOICE], boxes=field.boxes, dimension=field.dimension,
                 frames=FRAMES if field.moves else None, moving=field.value if field.moves else None,
                 seeds=2 if field.boxes >= 10_000 else None, effort=EFFORT)
            for field in fields()]


def fastest(results: Results) -> dict[Field, str]:
    """The single algorithm with the minimum time in each field, the same for all runs."""
    return {field: results.fastest(field.case, field.single) for field in fields()}


def mean(results: Results, ratios: Sequence[tuple[Field, str, str]],
         of: Callable[[Sequence[float]], float] = geometric_mean) -> Estimate:
    """The mean ratio of one algorithm's times to another's over some fields."""
    return results.between(lambda run: of([run.ratio(field.case, one, other) for field, one, other in ratios]))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    first = fastest(results)
    ever = [name for name in SINGLE if all(name in field.single for field in first)]
    worst, wins, choosing, beside = {}, {}, {}, {}
    for name in SINGLE:
        ratios = {field: results.ratio(field.case, name, first[field]) for field in first if name in field.single}
        field = max(ratios, key=lambda field: ratios[field].low if isfinite(ratios[field].low) else 0)
        worst[f"{figures.NAMES[name]} at its worst ({field.case})"] = ratios[field]
        wins[f"fields of {len(first)} in which the fastest is {figures.NAMES[name]}"] = results.between(
            lambda run: sum(is_fastest(run, field, name) for field in first))
    for moves, where in ((False, "boxes rest"), (True, "boxes move")):
        there = [field for field in first if field.moves == moves]
        over_first = {name: mean(results, [(field, name, first[field]) for field in there])
                      for name in (*ever, CHOICE)}
        best = min(ever, key=lambda name: over_first[name].value)
        choosing[where] = mean(results, [(field, CHOICE, best) for field in there])
        for name in (CHOICE, best):
            ratios = [(field, name, first[field]) for field in there]
            beside[f"{figures.NAMES[name]} over the fastest, mean, where {where}"] = over_first[name]
            beside[f"{figures.NAMES[name]} over the fastest, at worst, where {where}"] = mean(results, ratios, max)
    slower = {name: Asked(at, above=rules.clearly) for name, at in worst.items()}
    return [judged_all("B1a", {"all": slower}, beside=wins),
            judged("B1b", choosing, below=1 / rules.level, beside=beside)]


def is_fastest(run: Run, field: Field, name: str) -> bool:
    return name in field.single and name == min(field.single, key=lambda one: run.time(field.case, one))


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    first = fastest(results)
    drawing, profiles = figures.new(columns=2)
    for axes, moves, title in zip(profiles, (False, True), ("boxes at rest", "boxes in motion")):
        there = [field for field in first if field.moves == moves]
        for name in (*SINGLE, CHOICE):
            ratios = numpy.sort([results.ratio(field.case, name, first[field]).value
                                 for field in there if name in (*field.single, CHOICE)])
            shares = 100 * numpy.arange(1, len(ratios) + 1) / len(there)
            axes.step(ratios, shares, where="post", label=figures.NAMES[name], zorder=3 if name == CHOICE else 2,
                      **({"color": "black", "linewidth": 2} if name == CHOICE else {}))
        axes.set_xlim(0.9, 10)
        figures.label(axes, "time over that of the fastest", "% of the fields", title, log="x")
    figures.legend(profiles[1], is_shared=True)
    yield figures.Figure("winners", "In how many fields an algorithm takes at most so many times as long as the "
                         "fastest one in each. Brute force was measured up to 2,000 boxes.", drawing)
    yield winners_map(first)


def winners_map(first: dict[Field, str]) -> figures.Figure:
    """The fastest algorithm, over the number of boxes and one other property."""
    drawing, (*maps, key) = figures.new(columns=4, height=2.2)
    for axes, (name, dimension) in zip(maps, [("overlaps of a box", 2), ("overlaps of a box", 3), (MOTION, 2)]):
        for number, winner in enumerate(SINGLE):
            there = [field for field in first if (field.map, field.dimension) == (name, dimension)
                     and first[field] == winner]
            axes.plot([field.boxes for field in there], [field.value for field in there], linestyle="",
                      marker=figures.MARKERS[number], markersize=6, label=figures.NAMES[winner].removeprefix("our "))
        axes.margins(0.2)
        figures.label(axes, "boxes", name if name == MOTION else "neighbours of a box",
                      f"{'moving' if name == MOTION else 'at rest'}, {dimension}D")
        axes.set_xticks(COUNTS[::2])
    key.axis("off")
    key.legend(*maps[0].get_legend_handles_labels(), loc="center", borderpad=0)
    return figures.Figure("winners_map", "The fastest of our algorithms on uniform boxes, by the number of boxes and, "
                          "at rest, by the others that a box overlaps on average, in motion by the share of boxes "
                          "that move in a frame. Brute force was measured up to 2,000 boxes.", drawing)


EXPERIMENT = Experiment(
    title="Which algorithm is the fastest where",
    measured="Our own algorithms, and our own choice among them by a sample of the boxes, in fields from 100 to "
             "100,000 boxes: by overlaps of a box, by sizes, by clusters, and by how many move in a frame, in the "
             "plane and in space.",
    claims=[
        Claim("B1a", "Each single algorithm takes more than {clearly} times as long as the fastest one in some field.",
              "One does so in no field."),
        Claim("B1b", "The choice takes less time than the best single algorithm, by more than {level} times in the "
              "mean of the fields at rest, and so in those in motion. The best single one is chosen after measuring, "
              "in each of both.", "In neither it does."),
    ],
    cases=cases, judge=judge, figures=draw)

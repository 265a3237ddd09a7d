"""Section VI-C: insertion sort is linear if the order is nearly kept, and improves on a heap."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy

from .. import figures
from ..experiment import Boxes, Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate, crossing

COUNTS = (1_000, 2_000, 4_000, 8_000, 16_000, 32_000)
BOXES = 10_000
FRAMES = 6
FEW_ROUNDS = {"min_rounds": 2, "max_rounds": 2, "history_seconds": 60}  # for cases in which counts decide
MENDED = ("insertion", "heap", "binary", "rebuild")

# How far all boxes move in a frame, in their own sizes; None: they jump anywhere.
DRIFTS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, None)


def spec(update: str) -> str:
    return f"paper_sweep_and_prune:update={update}"


def corridor(boxes: int) -> Boxes:
    """Boxes along the x axis: the density along it is constant, whatever the number of boxes."""
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        minima = numpy.column_stack([random.uniform(0, boxes / 2, boxes), random.uniform(0, 1, boxes)])
        return numpy.hstack([minima, minima + random.uniform(0.5, 1.5, (boxes, 2))])
    return Boxes(f"corridor-{boxes}", make, inputs=2)


# Boxes move by a tenth of their size. In a corridor they stay relatively in order, whatever their number; in the other
# worlds, each passes more and more others on the sweep axis.
IN_ORDER = "a corridor"
WORLDS = (IN_ORDER, "a plane", "space")


def growth_case(world: str, boxes: int) -> str:
    return f"{boxes} boxes in {world}"


def motion(drift: float | None) -> str:
    return "anywhere" if drift is None else f"{drift:g} of their size"


def motion_case(drift: float | None) -> str:
    return f"all boxes go {motion(drift)}"


def cases() -> list[Case]:
    growing = [Case(growth_case(world, boxes), corridor(boxes) if world == IN_ORDER else "uniform",
                    [spec("insertion")], boxes=boxes, dimension=3 if world == "space" else 2, frames=2, moving=1,
                    drift=0.1, take=["phases"], effort=FEW_ROUNDS)
               for world in WORLDS for boxes in COUNTS]
    moving = [Case(motion_case(drift), "uniform", [*map(spec, MENDED), "sweep_and_prune", "auto"], boxes=BOXES,
                   frames=FRAMES, moving=1, drift=drift or 1, teleport=0 if drift else 1, take=["time", "phases"])
              for drift in DRIFTS]
    return growing + moving


def passed(results: Results, drift: float | None) -> Estimate:
    """The number of others that a box passes in a frame: the inversions of the order, per box."""
    return results.per_mover(motion_case(drift), spec("insertion"), "moved")


def growth(results: Results, world: str, what: Sequence[str]) -> Estimate:
    """The exponent of a count in a frame in which all boxes move."""
    return results.growth(COUNTS, lambda run, boxes: boxes * sum(
        run.per_mover(growth_case(world, boxes), spec("insertion"), one) for one in what))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    # Insertion sort visits each entry and moves some: adds both counts, so that neither growth is hidden.
    work = {world: growth(results, world, ("visited", "moved")) for world in WORLDS}
    beside = {f"work in {world}": at for world, at in work.items() if world != IN_ORDER}
    for world in WORLDS:
        beside[f"how far the order of {COUNTS[-1]:,} boxes is disturbed in {world}"] = results.between(
            lambda run: run.per_mover(growth_case(world, COUNTS[-1]), spec("insertion"), "moved"),
            "others passed by a box in a frame")
        beside[f"time in {world}"] = results.growth(COUNTS, lambda run, boxes: run.time(
            growth_case(world, boxes), spec("insertion"), ["mending"]))

    over_heap = {drift: results.ratio(motion_case(drift), spec("insertion"), spec("heap")) for drift in DRIFTS}
    in_order = [drift for drift in DRIFTS if passed(results, drift).is_below(rules.in_order)]
    even = results.between(lambda run: crossing(
        [run.per_mover(motion_case(drift), spec("insertion"), "moved") for drift in DRIFTS],
        [run.ratio(motion_case(drift), spec("insertion"), spec("heap")) for drift in DRIFTS]),
        "others passed in a frame")
    frames = {"as fast as the heap at": even}
    for drift in DRIFTS:
        if drift not in in_order:
            frames[f"over the heap where boxes go {motion(drift)}"] = over_heap[drift]
        for other, name in ((spec("rebuild"), "sorting anew"), ("sweep_and_prune", "our sweep"),
                            ("auto", "our own choice")):
            frames[f"over {name} where boxes go {motion(drift)}"] = results.ratio(
                motion_case(drift), spec("insertion"), other)
    return [
        judged("12a", {f"entries looked at and moved in {IN_ORDER}": work[IN_ORDER],
                       f"entries moved in {IN_ORDER}": growth(results, IN_ORDER, ("moved",))},
               below=rules.linear_high, beside=beside),
        judged("12b", {f"boxes go {motion(drift)}": over_heap[drift] for drift in in_order},
               below=1 / rules.level, where="{}", beside=frames),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (places, times) = figures.new(columns=2)
    for world in WORLDS:
        figures.line(places, COUNTS, [results.per_mover(growth_case(world, boxes), spec("insertion"), "moved")
                                      for boxes in COUNTS], world)
    figures.label(places, "boxes", "others that a box passes in a frame")
    figures.legend(places)
    others = [passed(results, drift).value for drift in DRIFTS]
    names = {"insertion": "insertion sort", "heap": "heap", "binary": "binary search", "rebuild": "sorted anew"}
    for update, name in names.items():
        figures.line(times, others, [results.time(motion_case(drift), spec(update)) for drift in DRIFTS], name)
    figures.label(times, "others that a box passes in a frame", "milliseconds of a frame")
    figures.legend(times)
    yield figures.Figure("sweep_insertion", "Left: how far the order is disturbed where all boxes go a tenth of "
                         f"their size. Right: a frame of the draft's sweep on {BOXES:,} boxes in the plane, by how "
                         "far they go and how the order is kept. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="Insertion sort and an order that is nearly kept",
    measured="The draft's sweep, its order mended by insertion sort, by binary search or as a heap, or sorted anew: "
             "the places by which boxes move in the order, and the time of frames, by how far all boxes go; and "
             "the work of mending by the number of boxes in a corridor, a plane and space.",
    claims=[
        Claim("12a",
              "In a corridor, where boxes that go a tenth of their size stay relatively in order, the entries that "
              "insertion sort looks at and moves grow as n to a power below {linear_high}, and so do those that it "
              "moves alone.",
              "Both grow as n to a higher power."),
        Claim("12b",
              "Wherever a box passes fewer than {in_order} others in a frame, a frame takes less time by insertion "
              "sort than by a heap that is kept, by more than {level} times.", "Nowhere it does."),
    ],
    cases=cases, judge=judge, figures=draw)

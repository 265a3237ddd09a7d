"""Section IV: a sweep needs no bounds of the world; the cost of the choice of its axis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy

from .. import figures
from ..experiment import Boxes, Case, Claim, Experiment
from ..judge import Asked, Finding, judged_all
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate, geometric_mean

BOXES = 10_000
SIDE = 100.0  # of the bounded world: a box overlaps about 4 others
SWEEP = "paper_sweep_and_prune"
BOUNDED = ("paper_grid", "paper_quadtree")  # listings that divide the world
COMPACT, COVERED = "a world with bounds", "four boxes over all"


def compact(random: numpy.random.Generator) -> numpy.ndarray:
    sizes = random.uniform(0.5, 1.5, (BOXES, 2))
    centres = random.uniform(0, SIDE, (BOXES, 2))
    return numpy.hstack([centres - sizes / 2, centres + sizes / 2])


def spread(random: numpy.random.Generator) -> numpy.ndarray:
    boxes = compact(random)
    boxes[:, 2:] -= boxes[:, :2]
    boxes[:, :2] *= 1_000
    boxes[:, 2:] += boxes[:, :2]
    return boxes


def with_others(places: Sequence[int], least: float, most: float):
    """The compact world, with these boxes replaced by boxes from `least` to `most`."""
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        boxes = compact(random)
        boxes[list(places)] = [least, least, most, most]
        return boxes
    return make


SOME = range(BOXES // 5, BOXES, BOXES // 5)

# Each world, and the bounded world that it is compared with.
WORLDS = {
    COMPACT: (compact, None),
    "a world a thousand times as wide": (spread, COMPACT),
    "a box a thousand worlds away": (with_others([BOXES - 1], 1e3 * SIDE, 1e3 * SIDE), COMPACT),
    "a box a million worlds away": (with_others([BOXES - 1], 1e6 * SIDE, 1e6 * SIDE), COMPACT),
    "a box 10^30 worlds away": (with_others([BOXES - 1], 1e30 * SIDE, 1e30 * SIDE), COMPACT),
    COVERED: (with_others(SOME, -2 * SIDE, 2 * SIDE), None),
    "four infinite boxes": (with_others(SOME, -numpy.inf, numpy.inf), COVERED),
}
BOUNDLESS = {world: bounded for world, (_, bounded) in WORLDS.items() if bounded}


def towers(dimension: int) -> Boxes:
    """Boxes on common ground: on the last axis, all have the same minimum."""
    def make(random: numpy.random.Generator) -> numpy.ndarray:
        sizes = random.uniform(0.5, 1.5, (BOXES, dimension))
        sizes[:, -1] *= 20
        side = (BOXES * 2**(dimension - 1) / 4)**(1 / (dimension - 1))
        minima = random.uniform(0, side, (BOXES, dimension))
        minima[:, -1] = 0
        return numpy.hstack([minima, minima + sizes])
    return Boxes(f"towers-{dimension}", make, inputs=2)


# Statement 6b, a definition: the draft sweeps along the x axis. The cost of an axis is measured with our sweep, which
# takes any.
SCENES = [(scene, 2) for scene in ("uniform", "one_line", "thin", "clustered", "power_law", "towers")]
SCENES += [(scene, 3) for scene in ("uniform", "one_line", "thin", "towers")]
CHOSEN, STRIPES = "sweep_and_prune:axes=1", "sweep_and_prune"


def axes_of(dimension: int) -> list[str]:
    return [f"sweep_and_prune:axis={axis}:axes=1" for axis in "xyz"[:dimension]]


def axis_case(scene: str, dimension: int) -> str:
    return f"{scene.replace('_', ' ')} boxes in {dimension}D"


def cases() -> list[Case]:
    effort = {"min_rounds": 4}  # for slow cases
    worlds = [Case(world, Boxes(f"world-{place}", make), [SWEEP, "sweep_and_prune", *BOUNDED],
                   take=["time", "counts", "memory"], effort=effort)
              for place, (world, (make, _)) in enumerate(WORLDS.items())]
    axes = [Case(axis_case(scene, dimension), towers(dimension) if scene == "towers" else scene,
                 [*axes_of(dimension), CHOSEN, STRIPES, SWEEP], boxes=BOXES, dimension=dimension,
                 effort=effort) for scene, dimension in SCENES]
    return worlds + axes


def over_bounded(results: Results, world: str, spec: str, what: str) -> Estimate:
    """The ratio of tests, memory or time to those in the bounded world."""
    def figure(run, case: str) -> float:
        if what == "tests":
            return run.count(case, spec, "tests")
        return run.memory(case, spec, "peak") if what == "memory" else run.time(case, spec)

    return results.between(lambda run: figure(run, world) / figure(run, BOUNDLESS[world]))


def worst_axis(results: Results, scene: str, dimension: int) -> Estimate:
    case = axis_case(scene, dimension)
    axes = results.timed(case, axes_of(dimension))
    best = results.fastest(case, axes)
    return results.between(lambda run: max(run.ratio(case, axis, best) for axis in axes))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    asked = {}
    beside = {}
    for world in BOUNDLESS:
        asked[world] = {
            f"tests, {world}": Asked(over_bounded(results, world, SWEEP, "tests"), below=rules.twice),
            f"memory, {world}": Asked(over_bounded(results, world, SWEEP, "memory"), below=rules.twice),
            f"time, {world}": Asked(over_bounded(results, world, SWEEP, "time"), below=rules.clearly),
        }
        for spec in ("sweep_and_prune", *BOUNDED):
            if not results.timed(world, [spec]) or not results.timed(BOUNDLESS[world], [spec]):
                continue  # it was too slow
            beside[f"tests of {figures.NAMES[spec]}, {world}"] = over_bounded(results, world, spec, "tests")
    for at in SCENES:
        beside[f"our sweep along its worst axis over its best, {axis_case(*at)}"] = worst_axis(results, *at)
    for one, name in ((CHOSEN, "the axis that it chooses"), (STRIPES, "two axes"), (SWEEP, "the draft's")):
        best = {axis_case(*at): results.fastest(axis_case(*at), axes_of(at[1])) for at in SCENES}
        beside[f"{name} over our sweep along its best axis, mean over scenes"] = results.between(
            lambda run: geometric_mean([run.ratio(case, one, axis) for case, axis in best.items()]))
    return [judged_all("6a", asked, where="there is {}", beside=beside)]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (axes,) = figures.new(height=2.8)
    worst = [worst_axis(results, *at) for at in SCENES]
    bars = numpy.abs(numpy.nan_to_num([[at.value - at.low, at.high - at.value] for at in worst])).T
    axes.errorbar([at.value for at in worst], [axis_case(*at) for at in SCENES], xerr=bars, fmt="o", capsize=2)
    axes.invert_yaxis()
    figures.label(axes, "time along the worst axis over that along the best", "", log="x")
    yield figures.Figure("sweep_axis", f"What the choice of its axis costs our sweep, on {BOXES:,} boxes. Bars: "
                         "95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="A sweep needs no world, but an axis",
    measured=f"Tests, memory and time of the draft's sweep on {BOXES:,} boxes in the plane, where some are far away "
             "or infinite, over those in the same world with bounds; and the time of our sweep along each axis.",
    claims=[
        Claim("6a",
              "In a world a thousand times as wide, with a box far away and with infinite boxes, tests and memory are "
              "below {twice} times and time is below {clearly} times those in the same world with bounds.",
              "In each of these, tests, memory or time are above."),
    ],
    cases=cases, judge=judge, figures=draw)

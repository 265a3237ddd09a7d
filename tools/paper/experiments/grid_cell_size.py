"""Section III: the size of a grid's cells is a trade-off; must it be tuned?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Asked, Finding, judged, judged_all
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate, geometric_mean

# The mean length of a scene's boxes in the plane and in space, by `broadside scene`: the unit of cells.
LENGTHS = {"uniform": (1.0, 1.0), "clustered": (1.0, 1.0), "mixed": (2.0, 2.0), "power_law": (2.8, 2.9),
           "thin": (25.4, 17.4)}

# Cell sizes in mean lengths of a box, up to one that contains the world of every scene.
SIZES = tuple(2.0**power for power in range(-3, 10))

# As many boxes as the grid can test in one cell, where the draft's grid tests all pairs.
GRIDS = {("paper_grid", 2): 10_000, ("grid", 2): 40_000, ("grid", 3): 40_000}


def case_of(grid: str, dimension: int, scene: str) -> str:
    return f"{figures.NAMES[grid]} in {dimension}D on {scene} boxes"


def spec(grid: str, dimension: int, scene: str, size: float) -> str:
    cell = f"{grid}:cell={size * LENGTHS[scene][dimension - 2]:g}"
    return cell + (":limit=none" if grid == "paper_grid" else "")


def specs(grid: str, dimension: int, scene: str) -> list[str]:
    return [spec(grid, dimension, scene, size) for size in SIZES]


def cases() -> list[Case]:
    return [Case(case_of(grid, dimension, scene), scene, [grid, *specs(grid, dimension, scene)], boxes=boxes,
                 dimension=dimension, take=["time", "counts"])
            for (grid, dimension), boxes in GRIDS.items() for scene in LENGTHS]


def over_best(results: Results, grid: str, dimension: int, scene: str, one: str) -> Estimate:
    """The ratio of a spec's time to that of the best cell size on this scene."""
    case = case_of(grid, dimension, scene)
    return results.ratio(case, one, results.fastest(case, specs(grid, dimension, scene)))


def mean_over_best(results: Results, grid: str, dimension: int, size: float | None) -> Estimate:
    """Likewise for one cell size on all scenes, or for the size that the grid chooses: the mean over the scenes."""
    ways = {}
    for scene in LENGTHS:
        case = case_of(grid, dimension, scene)
        one = grid if size is None else spec(grid, dimension, scene, size)
        ways[case] = (one, results.fastest(case, specs(grid, dimension, scene)))

    def mean(run: Run) -> float:
        return geometric_mean([run.ratio(case, one, best) for case, (one, best) in ways.items()])

    return results.between(mean)


def untuned(results: Results, grid: str, dimension: int) -> Estimate:
    """The single cell size with the best mean over all scenes."""
    everywhere = [size for size in SIZES
                  if all(results.timed(case_of(grid, dimension, scene), [spec(grid, dimension, scene, size)])
                         for scene in LENGTHS)]
    return min((mean_over_best(results, grid, dimension, size) for size in everywhere), key=lambda at: at.value)


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    balance = {}
    for scene in LENGTHS:
        case = case_of("paper_grid", 2, scene)
        sizes = specs("paper_grid", 2, scene)
        smallest, *_, largest = results.timed(case, sizes)
        best = results.fastest(case, sizes)
        boxes = f"{scene.replace('_', ' ')} boxes"
        balance[boxes] = asked = {}
        for end, one, what in (("smallest", smallest, "references"), ("largest", largest, "tests")):
            count = results.between(lambda run: run.count(case, one, what) / run.count(case, best, what))
            asked[f"time with the {end} cells on {boxes}"] = Asked(
                results.ratio(case, one, best), above=rules.clearly)
            asked[f"{what} with the {end} cells on {boxes}"] = Asked(count, above=rules.clearly)
    tuned = {
        "one size, in lengths of a box, for all scenes": untuned(results, "paper_grid", 2),
        "a size by rule, twice a mean box": mean_over_best(results, "paper_grid", 2, None),
    }
    ours = {}
    for dimension in (2, 3):
        ours[f"our grid in {dimension}D, one size for all scenes"] = untuned(results, "grid", dimension)
        ours[f"our grid in {dimension}D, its own choice"] = mean_over_best(results, "grid", dimension, None)
    return [
        judged_all("5a", balance, where="there are {}"),
        judged("5b", tuned, above=rules.level, where="the choice is {}", beside=ours),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, axes = figures.new(columns=2)
    for place, (grid, title) in zip(axes, (("paper_grid", "The draft's grid"), ("grid", "Our grid"))):
        for scene in LENGTHS:
            timed = [size for size in SIZES
                     if results.timed(case_of(grid, 2, scene), [spec(grid, 2, scene, size)])]
            figures.line(place, timed, [over_best(results, grid, 2, scene, spec(grid, 2, scene, size))
                                        for size in timed], scene.replace("_", " "))
        figures.label(place, "cell length, in mean box lengths", "time over the best", title)
    figures.legend(axes[0], is_shared=True)
    yield figures.Figure("grid_cell_size", "Time by the size of cells, over that with the best size, on five scenes "
                         "in the plane: the draft's grid on 10,000 boxes, ours on 40,000. Bars: 95% intervals between "
                         "runs.", drawing)


EXPERIMENT = Experiment(
    title="The size of cells is a balance",
    measured="The draft's grid on 10,000 boxes in the plane, with cells as small as they are asked for, and ours on "
             "40,000 in the plane and in space, with cells from an eighth of a box up to the world and with the size "
             "that the grid chooses itself, in five scenes.",
    claims=[
        Claim("5a",
              "In each scene, both the smallest cells and the largest take more than {clearly} times as long as the "
              "best size; the smallest have more than {clearly} times its references, and the largest more than "
              "{clearly} times its tests.", "In every scene one of these does not hold."),
        Claim("5b",
              "On the draft's grid, both the one size, in lengths of a box, that does best on all scenes and the size "
              "by the rule of the mended listing take more than {level} times as long as each scene's best, as a "
              "mean.", "Both take less."),
    ],
    cases=cases, judge=judge, figures=draw)

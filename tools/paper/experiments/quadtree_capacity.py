"""Section V: a quadtree trades tests for references, which slow it down in dense worlds; larger leaves help."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Asked, Finding, judged, judged_all
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate

NEIGHBOURS = (1, 4, 16, 64, 256)  # number of others that a box overlaps: more and more boxes in a world of one size
BOXES = 10_000
SMALL = (2, 4, 8)                 # the draft specifies no capacity
CAPACITIES = tuple(2**power for power in range(1, 11))
OWN_CAPACITIES = tuple(2**power for power in range(3, 12))
CELLS = tuple(f"paper_grid:cell={size:g}:limit=none" for size in (0.5, 1, 2, 4))
FILLING = (1_000, 10_000, 100_000)  # numbers of boxes in one world, in which each of a thousand has half a neighbour


def spec(capacity: int, tree: str = "paper_quadtree") -> str:
    return f"{tree}:capacity={capacity}"


def world(neighbours: int) -> str:
    return f"{neighbours} neighbour{'s' if neighbours != 1 else ''}"


def the_draft(neighbours: int) -> str:
    return f"the draft's tree, {world(neighbours)}"


def ours(neighbours: int) -> str:
    return f"our tree, {world(neighbours)}"


def filled(boxes: int) -> str:
    return f"{boxes:,} boxes in one world"


def cases() -> list[Case]:
    found = [Case(filled(boxes), f"uniform:neighbours={boxes / FILLING[0] / 2:g}", [*map(spec, SMALL)], boxes=boxes,
                  seeds=max(100_000 // boxes, 2), take=["counts"]) for boxes in FILLING]
    for neighbours in NEIGHBOURS:
        scene = f"uniform:neighbours={neighbours}"
        found.append(Case(the_draft(neighbours), scene, [*map(spec, CAPACITIES), *CELLS, "auto"],
                          boxes=BOXES, take=["time", "counts"]))
        found.append(Case(ours(neighbours), scene, [*(spec(one, "quadtree") for one in OWN_CAPACITIES), "auto"],
                          boxes=BOXES))
    return found


def references_grown(results: Results, dense: str, sparse: str, capacity: int) -> Estimate:
    """A box's references in one case over those in another."""
    return results.between(lambda run: run.count(dense, spec(capacity), "references")
                           / run.count(sparse, spec(capacity), "references"))


def is_dense(results: Results, rules: Rules, neighbours: int) -> bool:
    return all(references_grown(results, the_draft(neighbours), the_draft(NEIGHBOURS[0]), capacity)
               .is_above(rules.dense) for capacity in SMALL)


def place(capacity: int, neighbours: int) -> str:
    return f"leaves of {capacity} at {world(neighbours)}"


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    sparsest, *_, densest = NEIGHBOURS
    grown = {}
    for capacity in SMALL:
        grown[place(capacity, densest)] = references_grown(results, the_draft(densest), the_draft(sparsest), capacity)
        grown[f"leaves of {capacity}, {filled(FILLING[-1])}"] = references_grown(
            results, filled(FILLING[-1]), filled(FILLING[0]), capacity)
    references = {f"references, {place(8, n)}": results.count(the_draft(n), spec(8), "references") for n in NEIGHBOURS}
    references |= {f"references, leaves of 8, {filled(n)}": results.count(filled(n), spec(8), "references")
                   for n in FILLING}
    slower = {}
    small = {}
    for neighbours in NEIGHBOURS:
        case = the_draft(neighbours)
        for capacity in SMALL:
            larger = [one for one in CAPACITIES if one > capacity]
            here = place(capacity, neighbours)
            small[f"{here} over the larger leaves with the fewest tests"] = results.between(
                lambda run: run.count(case, spec(capacity), "tests")
                / min(run.count(case, spec(one), "tests") for one in larger))
            if not is_dense(results, rules, neighbours):
                continue
            best = results.fastest(case, [*map(spec, larger)])
            fewer = results.between(lambda run: run.count(case, best, "references")
                                    / run.count(case, spec(capacity), "references"))
            slower[here] = {f"time over the best larger leaves, {here}": Asked(
                                results.ratio(case, spec(capacity), best), above=rules.level),
                            f"references of these over its own, {here}": Asked(fewer, below=1)}
    return [
        judged("8a", grown, above=rules.twice, fails_at=rules.clearly, where="it has {}", beside=references),
        judged_all("8b", slower, where="it has {}", beside=beside_times(results)),
        judged("8c", tests_over_others(results), below=1, where="they are compared with those of {}", beside=small),
    ]


def beside_times(results: Results) -> dict[str, Estimate]:
    found = {}
    for neighbours in NEIGHBOURS:
        best = results.fastest(ours(neighbours), [spec(one, "quadtree") for one in OWN_CAPACITIES])
        found[f"our tree with its usual leaves over its best, {world(neighbours)}"] = results.ratio(
            ours(neighbours), spec(128, "quadtree"), best)
        found[f"the draft's tree, leaves of 8, over our own choice, {world(neighbours)}"] = results.ratio(
            the_draft(neighbours), spec(8), "auto")
    return found


def tests_over_others(results: Results) -> dict[str, Estimate]:
    """With leaves of 8: tests over those of all pairs, and over those of the grid with its fastest cell size."""
    def tests(run: Run, case: str, one: str) -> float:
        return run.count(case, one, "tests")

    found = {}
    for neighbours in NEIGHBOURS:
        case = the_draft(neighbours)
        best = results.fastest(case, CELLS)
        found[f"brute force at {world(neighbours)}"] = results.between(
            lambda run: tests(run, case, spec(8)) / ((run.boxes(case) - 1) / 2))
        found[f"the grid at {world(neighbours)}"] = results.between(
            lambda run: tests(run, case, spec(8)) / tests(run, case, best))
    return found


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (times, references) = figures.new(columns=2)
    for neighbours in NEIGHBOURS:
        case = the_draft(neighbours)
        timed = [one for one in CAPACITIES if results.timed(case, [spec(one)])]
        best = results.fastest(case, [*map(spec, timed)])
        figures.line(times, timed, [results.ratio(case, spec(one), best) for one in timed], f"{neighbours}")
        figures.line(references, timed, [results.count(case, spec(one), "references") for one in timed])
    figures.label(times, "boxes that a leaf holds", "time over the best")
    figures.label(references, "boxes that a leaf holds", "references of a box")
    figures.legend(times, "neighbours of a box", is_shared=True)
    yield figures.Figure("quadtree_capacity", f"The draft's quadtree on {BOXES:,} uniform boxes in the plane, by the "
                         "capacity of a leaf. Left: time over that with the best capacity. Right: references. A line "
                         "for each number of others that a box overlaps on average. Bars: 95% intervals between "
                         "runs.", drawing)


EXPERIMENT = Experiment(
    title="Larger leaves for denser worlds",
    measured=f"The draft's quadtree and ours with leaves of each capacity, and the draft's grid, on {BOXES:,} "
             "uniform boxes in the plane that overlap 1 to 256 others, and ever more boxes in one world: tests, "
             "references and time. The mended listing splits no further where a box would have 16 references.",
    claims=[
        Claim("8a",
              "With leaves of 2, of 4 and of 8 boxes, a box has more than {twice} times as many references in the "
              "densest world as in the sparsest, and among 100,000 boxes as among 1,000 in the same world.",
              "In each of these it has fewer than {clearly} times as many."),
        Claim("8b",
              "In every dense world (more than {dense} times the references of the sparsest), leaves of 2, of 4 and "
              "of 8 take more than {level} times as long as the best larger leaves, in which a box has fewer "
              "references.", "In none they do."),
        Claim("8c",
              "In every world, the tree with leaves of 8 makes fewer tests than brute force, and fewer than the grid "
              "with the cells that take least time.", "In none it does, of either."),
    ],
    cases=cases, judge=judge, figures=draw)

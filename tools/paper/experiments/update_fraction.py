"""Section VI-A: updates only what changed: how much this saves, how changes are detected, and the cost of searching
for each object."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import isfinite

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Finding, Verdict, judged, listing
from ..results import WHOLE, Results
from ..rules import Rules
from ..statistics import Estimate, crossing

# With one overlapping neighbour per box, building, the part that can be saved, is a good part of a frame; and with
# sixteen.
SCENE, DENSE = "uniform:neighbours=1", "uniform:neighbours=16"
FRAMES = 6
MENDING = ("mending",)

# Ways to update each structure. The first one finds a box by its previous state.
WAYS = {"paper_grid": ("reinsert", "translate"),
        "paper_sweep_and_prune": ("binary", "insertion", "heap"),
        "paper_quadtree": ("root", "relative", "cousins")}
STRUCTURES = {"paper_grid": "grid", "paper_sweep_and_prune": "sweep", "paper_quadtree": "quadtree"}
OURS = ("grid", "bvh", "auto")

# VI-A: searches the structure for each moved box, one after the other.
SEARCH = "search_delete_reinsert"

# How many of how many boxes move.
BOXES = 10_000
MOVERS = (1, 3, 10, 30, 100, 300, 1_000, 3_000, 10_000)
FEWEST, FEW = 10, 100    # one in a thousand, and one in a hundred
SEARCHED = (1, 3, 10, 30, 100)
FEWER_BOXES = 1_000      # the same number of movers among fewer boxes
DENSE_CASE = f"{FEWEST} of {BOXES} boxes move among many overlaps"

KNOWN = {"by a flag alone": lambda structure: spec(structure, SEARCH),
         "by previous states": lambda structure: spec(structure, WAYS[structure][0])}
DETECTIONS = {"flag": "by a flag", "compare": "by a previous state"}


def spec(structure: str, update: str, detect: str = "") -> str:
    return f"{structure}:update={update}" + (f":detect={detect}" if detect else "")


def anew(one: str) -> str:
    """The spec that rebuilds a spec's structure in each frame."""
    return spec(one.partition(":")[0], "rebuild")


def case_of(movers: int, boxes: int = BOXES) -> str:
    return f"{movers} of {boxes} boxes move"


def ways(structure: str, movers: int) -> list[str]:
    return [spec(structure, way) for way in (*WAYS[structure], *([SEARCH] if movers in SEARCHED else []))]


def specs(movers: int, boxes: int) -> list[str]:
    listed = [one for structure in WAYS for one in (spec(structure, "rebuild"), *ways(structure, movers))]
    if movers in SEARCHED:
        listed.append(spec("paper_grid", "search_once"))
    if boxes == BOXES and movers >= FEWEST:
        listed += [one for ours in OURS for one in (ours, f"{ours}:update=rebuild")]
    if (boxes, movers) == (BOXES, FEW):
        listed += [spec(structure, WAYS[structure][0], detect) for structure in WAYS for detect in DETECTIONS]
    return listed


def cases() -> list[Case]:
    numbers = [(movers, BOXES) for movers in MOVERS] + [(movers, FEWER_BOXES) for movers in SEARCHED]
    motion = {"frames": FRAMES, "drift": 0.2, "take": ["time", "phases"]}
    found = [Case(case_of(movers, boxes), SCENE, specs(movers, boxes), boxes=boxes, moving=movers / boxes, **motion)
             for movers, boxes in numbers]
    return [*found, Case(DENSE_CASE, DENSE, [one for structure in WAYS for one in (
        spec(structure, "rebuild"), *ways(structure, FEWEST))], boxes=BOXES, moving=FEWEST / BOXES, **motion)]


def over_rebuilding(results: Results, case: str, one: str, part: Sequence[str] = MENDING) -> Estimate:
    """The time of updating over that of rebuilding; likewise for whole frames."""
    return results.ratio(case, one, anew(one), part, WHOLE if part == WHOLE else MENDING)


def best(results: Results, structure: str, movers: int, part: Sequence[str]) -> str:
    """The way with the fastest update, or with the fastest frame. A heap restores its order only when it is searched.
    """
    mended = [one for one in ways(structure, movers) if part == WHOLE or not one.endswith("heap")]
    return results.fastest(case_of(movers), mended, part)


def even(results: Results, numbers: Sequence[int], boxes: int, way: Callable[[int], str],
         part: Sequence[str]) -> Estimate:
    """The number of movers from which updating takes longer than rebuilding."""
    ways_of = {movers: way(movers) for movers in numbers}
    return results.between(lambda run: crossing(numbers, [
        run.ratio(case_of(movers, boxes), one, anew(one), part) for movers, one in ways_of.items()]), "movers")


def reached(figures_by_name: Mapping[str, Estimate]) -> dict[str, Estimate]:
    """Without crossings outside the measured range."""
    return {name: at for name, at in figures_by_name.items() if isfinite(at.value)}


def judge_mending(number: str, part: Sequence[str], results: Results, rules: Rules,
                  beside: Mapping[str, Estimate]) -> Finding:
    """Decides by the result with the fewest movers; reports beside it how far this extends."""
    shown = {}
    for structure, name in STRUCTURES.items():
        shown[f"no longer faster in the {name} from"] = even(
            results, [movers for movers in MOVERS if movers >= FEWEST], BOXES,
            lambda movers: best(results, structure, movers, part), part)
        shown[f"where all boxes move, {name}"] = over_rebuilding(
            results, case_of(BOXES), best(results, structure, BOXES, part), part)
    return judged(number, {f"the structure is the {name}": over_rebuilding(
        results, case_of(FEWEST), best(results, structure, FEWEST, part), part)
        for structure, name in STRUCTURES.items()}, below=1 / rules.level, beside={**reached(shown), **beside})


def judge_detection(results: Results, rules: Rules) -> Finding:
    case, places, shares = case_of(FEW), {}, {}
    for structure, name in STRUCTURES.items():
        for detect, words in DETECTIONS.items():
            one = spec(structure, WAYS[structure][0], detect)
            places[f"{words} in the {name}"] = over_rebuilding(results, case, one, ("detecting", *MENDING))
            shares[f"detecting {words}, of a frame of the {name}"] = results.ratio(case, one, one, ["detecting"],
                                                                                  WHOLE)
    return judged("9c", places, below=1 / rules.level, where="it is known {}", beside=shares)


def judge_searching(results: Results, rules: Rules) -> Finding:
    """With only a flag, a box is searched for in the whole structure; with its previous state, at its previous place.
    """
    places, shown, held = {}, {}, []
    for words, way in KNOWN.items():
        for movers in (FEWEST, FEW):
            ratios = {name: over_rebuilding(results, case_of(movers), way(structure))
                      for structure, name in STRUCTURES.items()}
            places |= {f"{words} in the {name}, {movers:,} movers": at for name, at in ratios.items()}
            if names := [name for name, at in ratios.items() if at.is_below(1 / rules.level)]:
                held.append(f"{words} where {movers:,} of {BOXES:,} move: {listing(names)}")
    for structure, name in STRUCTURES.items():
        for boxes in (BOXES, FEWER_BOXES):
            shown[f"by a flag alone in the {name} of {boxes:,}, no longer faster from"] = even(
                results, SEARCHED, boxes, lambda _: spec(structure, SEARCH), MENDING)
    for movers in (FEWEST, FEW):
        shown[f"the grid searched once for all, {movers:,} movers"] = over_rebuilding(
            results, case_of(movers), spec("paper_grid", "search_once"))
    finding = judged("9d", places, below=1 / rules.level, beside=reached(shown))
    is_bounded = finding.verdict is Verdict.WITHIN_BOUNDS
    return replace(finding, condition="; ".join(held)) if is_bounded else finding


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    ours = {f"{figures.NAMES[one]}, where {movers:,} of {BOXES:,} move": over_rebuilding(
        results, case_of(movers), one, WHOLE) for one in OURS for movers in (FEWEST, BOXES)}
    for structure, name in STRUCTURES.items():
        ours[f"the {name}, where a box overlaps 16 others"] = over_rebuilding(
            results, DENSE_CASE, results.fastest(DENSE_CASE, ways(structure, FEWEST)), WHOLE)
    return [judge_mending("9a", MENDING, results, rules, {}), judge_mending("9b", WHOLE, results, rules, ours),
            judge_detection(results, rules), judge_searching(results, rules)]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (frames, mending) = figures.new(columns=2)
    for structure, name in STRUCTURES.items():
        moving = [movers for movers in MOVERS if movers >= FEWEST]
        figures.line(frames, [100 * movers / BOXES for movers in moving], [over_rebuilding(
            results, case_of(movers), best(results, structure, movers, WHOLE), WHOLE) for movers in moving], name)
        figures.line(mending, SEARCHED, [over_rebuilding(results, case_of(movers), spec(structure, SEARCH))
                                         for movers in SEARCHED], name)
    figures.label(frames, "% of the boxes that move", "frame over one built anew", "whole frames")
    figures.label(mending, f"boxes that move, of {BOXES:,}", "mending over building", "each mover searched")
    for axes in (frames, mending):
        axes.axhline(1, color="black", linewidth=0.8)
    figures.legend(frames, is_shared=True)
    yield figures.Figure("update_fraction", f"The draft's listings on {BOXES:,} uniform boxes in the plane, each of "
                         "which overlaps one other on average. Left: the time of a whole frame, mended by the fastest "
                         "way, over one that builds anew. Right: the time of mending alone, where each mover is "
                         "searched in the whole structure, deleted and inserted again, over building. Bars: 95% "
                         "intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="Updating only what changed",
    measured="Frames of the draft's grid, sweep and quadtree, uniform boxes in the plane of which each overlaps one "
             "other on average: the structure mended in each way of section VI, by how many boxes move, or built "
             "anew; the time to detect what moved, by a flag or by comparing each box with its previous state; and "
             "mending by searching each mover in the whole structure.",
    claims=[
        Claim("9a", "Where one box in a thousand moves, mending takes less time than building anew, by more than "
              "{level} times, in the grid, the sweep and the quadtree, each by its fastest way.",
              "In none of them it does."),
        Claim("9b", "Where one box in a thousand moves and a box overlaps one other, so that building is a good part "
              "of a frame (the draft says that they can benefit), a whole frame takes less time than one that builds "
              "anew, by more than {level} times, in the grid, the sweep and the quadtree.",
              "In none of them it does."),
        Claim("9c", "Where one box in a hundred moves, to detect what changed, by a flag as by a previous state, and "
              "to mend that takes less time than building anew, by more than {level} times, in all three.",
              "In none of them it does, by either."),
        Claim("9d", "Where one box in a thousand and where one in a hundred moves, to search, delete and insert each "
              "takes less time than building anew, by more than {level} times, in all three: by a flag alone, so that "
              "the whole structure is searched for each, as by its previous state, which says where it was.",
              "Nowhere it does."),
    ],
    cases=cases, judge=judge, figures=draw)

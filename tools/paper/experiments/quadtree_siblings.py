"""Section VI-D: a box that moves in a quadtree is inserted from the root, or from near its previous place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Asked, Finding, judged, judged_all
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate, crossing

BOXES, MORE = 8_000, 64_000
CAPACITIES = (8, 2)
NEIGHBOURS = (0.05, 0.5, 2, 8, 32, 128)  # others that a box overlaps; the more, the larger boxes are against leaves
STEP = 0.2                 # of a mover, in its sizes
STEPS = {0.05: 5, 0.5: 2}  # longer if boxes are in few leaves, so that many movers leave these
DRIFTS = (0.02, 2, 10)
WAYS = {"root": "from the root", "relative": "from the node that holds it", "siblings": "by siblings",
        "cousins": "by siblings and cousins"}
ACROSS = ("siblings", "cousins")
At = tuple[int, float, int]
EVERYWHERE: list[At] = [(capacity, neighbours, BOXES) for capacity in CAPACITIES for neighbours in NEIGHBOURS]
DEEPER: list[At] = [(capacity, neighbours, MORE) for capacity in CAPACITIES for neighbours in (0.05, 2)]


def spec(update: str, capacity: int = CAPACITIES[0]) -> str:
    return f"paper_quadtree:capacity={capacity}:update={update}"


def case_of(at: At) -> str:
    return f"leaves of {at[0]} at {at[1]:g} neighbours" + (f", {at[2]:,} boxes" if at[2] != BOXES else "")


def step_case(drift: float) -> str:
    return f"steps of {drift:g} boxes"


def cases() -> list[Case]:
    motion = {"moving": 0.1, "frames": 6, "take": ["phases"], "effort": {"min_rounds": 12}}
    ways = [Case(case_of(at), f"uniform:neighbours={at[1]}", [spec(way, at[0]) for way in WAYS], boxes=at[2],
                 drift=STEPS.get(at[1], STEP), **motion) for at in EVERYWHERE + DEEPER]
    return ways + [Case(step_case(drift), "uniform", [*map(spec, WAYS)], boxes=BOXES, drift=drift, **motion)
                   for drift in DRIFTS]


def leaves(run: Run, at: At) -> float:
    """The number of leaves that a box is in."""
    return run.count(case_of(at), spec("root", at[0]), "references")


def mending(run: Run, at: At, way: str, other: str) -> float:
    """The ratio of one way's mending time to another's."""
    return run.ratio(case_of(at), spec(way, at[0]), spec(other, at[0]), ["mending"])


def over(results: Results, at: At, way: str, other: str) -> Estimate:
    return results.ratio(case_of(at), spec(way, at[0]), spec(other, at[0]), ["mending"])


def nodes(results: Results, at: At, one: str, other: str) -> Estimate:
    """The ratio of the nodes visited in one way to those visited in another."""
    return results.between(lambda run: run.per_mover(case_of(at), spec(one, at[0]), "visited")
                           / run.per_mover(case_of(at), spec(other, at[0]), "visited"))


def horrible(results: Results, rules: Rules, at: At) -> dict[str, Asked]:
    return {f"nodes visited, {case_of(at)}": Asked(nodes(results, at, "cousins", "root"), above=rules.clearly,
                                                   fails_at=rules.level),
            f"time, {case_of(at)}": Asked(over(results, at, "cousins", "root"), above=rules.level)}


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    spans = {at: results.between(lambda run: leaves(run, at), "leaves of a box") for at in EVERYWHERE}
    in_one = [at for at in EVERYWHERE if spans[at].is_below(rules.one_leaf)]
    spanning = [at for at in EVERYWHERE if spans[at].is_above(rules.spanning)]
    others = {case_of(at): span for at, span in spans.items()}
    others |= {f"time from the root over that from near, {case_of(at)}": over(results, at, "root", "relative")
               for at in EVERYWHERE + DEEPER}
    for capacity in CAPACITIES:
        line = [(capacity, neighbours, BOXES) for neighbours in NEIGHBOURS]
        others[f"as fast as from the root at, leaves of {capacity}"] = results.between(lambda run: crossing(
            [leaves(run, at) for at in line], [mending(run, at, "relative", "root") for at in line]),
            "leaves of a box")
    for drift in DRIFTS:
        for one in list(WAYS)[1:]:
            others[f"from the root over {WAYS[one]}, {step_case(drift)}"] = results.ratio(
                step_case(drift), spec("root"), spec(one), ["mending"])
    elsewhere = {f"from the root over {WAYS[way]}, {case_of(at)}": over(results, at, "root", way)
                 for at in EVERYWHERE if at not in in_one for way in ACROSS}
    return [
        judged("14a", {case_of(at): nodes(results, at, "root", "relative") for at in EVERYWHERE + DEEPER},
               above=rules.level, where="there are {}", beside=others),
        judged("14b", {f"{case_of(at)}, {WAYS[way]}": over(results, at, "root", way) for at in in_one
                       for way in ACROSS}, above=rules.level, where="there are {}", beside=elsewhere),
        judged_all("14c", {case_of(at): horrible(results, rules, at) for at in spanning}, where="there are {}",
                   beside={f"by siblings over from the root, {case_of(at)}": over(results, at, "siblings", "root")
                           for at in spanning}),
    ]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, axes = figures.new(columns=2)
    for place, capacity in zip(axes, CAPACITIES):
        line = [(capacity, neighbours, BOXES) for neighbours in NEIGHBOURS]
        spans = [results.between(lambda run: leaves(run, at)).value for at in line]
        for way in list(WAYS)[1:]:
            figures.line(place, spans, [over(results, at, way, "root") for at in line], WAYS[way])
        figures.label(place, "leaves of a box", "time over that from the root", f"Leaves of {capacity} boxes")
    figures.legend(axes[0], is_shared=True)
    yield figures.Figure("quadtree_siblings", "Mending the draft's quadtree without beginning at the root: its time, "
                         "by the leaves that a box is in. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="By siblings and cousins, or from the root",
    measured=f"Nodes visited and time in mending the draft's quadtree, in leaves of {CAPACITIES[0]} and of "
             f"{CAPACITIES[1]}, where a tenth of {BOXES:,} or {MORE:,} uniform boxes move by {STEP:g} of their size, "
             f"or, in the fewest leaves, by {max(STEPS.values())} and {min(STEPS.values())} times their size.",
    claims=[
        Claim("14a",
              f"With {BOXES:,} boxes of {NEIGHBOURS[0]} to {NEIGHBOURS[-1]} neighbours and {MORE:,} of a few, "
              "inserting from the root visits more than {level} times as many nodes for a mover as from the least "
              "node above the old leaf that holds the box.", "Nowhere it does."),
        Claim("14b",
              "Wherever a box is in fewer than {one_leaf} leaves on average (statement 14c is about the others), to "
              "insert from the root takes more than {level} times as long as by siblings, and as by siblings and "
              "cousins.", "Nowhere it does."),
        Claim("14c",
              "Wherever a box is in more than {spanning} leaves on average, siblings and cousins visit more than "
              "{clearly} times as many nodes, and take more than {level} times as long, as from the root.",
              "Everywhere they visit fewer than {level} times as many, or take less than {level} times as long."),
    ],
    cases=cases, judge=judge, figures=draw)

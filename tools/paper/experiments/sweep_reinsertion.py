"""Section VI-C: inserts a few boxes into the order by binary search, and uses the heap."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import log2

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results, Run
from ..rules import Rules
from ..statistics import Estimate

COUNTS = (1_000, 4_000, 16_000, 64_000, 256_000)
MOVERS = 256
BOXES = 10_000
JUMPING = (1, 10, 100, 1_000, 10_000)  # of these

# In the worst case, boxes jump.
FAR = "anywhere"
GOING = {FAR: 1.0, "a fifth of their size": 0.0}  # the fraction that jumps; the others drift

# Sweeps of many boxes take long, and counts decide.
FEW_ROUNDS = {"min_rounds": 2, "max_rounds": 2, "history_seconds": 60}

UPDATES = {"binary": "binary search", "insertion": "insertion sort", "heap": "heap", "rebuild": "sorted anew"}


def spec(update: str) -> str:
    return f"paper_sweep_and_prune:update={update}"


BINARY = spec("binary")


def growth_case(going: str, boxes: int) -> str:
    return f"{MOVERS} of {boxes} boxes go {going}"


def heap_case(jumping: int) -> str:
    return f"{jumping} of {BOXES} boxes jump"


def cases() -> list[Case]:
    growing = [Case(growth_case(going, boxes), "uniform", [BINARY], boxes=boxes, frames=2, moving=MOVERS / boxes,
                    drift=0.2, teleport=teleport, take=["phases"], effort=FEW_ROUNDS if boxes > 50_000 else {})
               for going, teleport in GOING.items() for boxes in COUNTS]
    jumping = [Case(heap_case(jumping), "uniform", [*map(spec, UPDATES), "sweep_and_prune", "auto"], boxes=BOXES,
                    frames=6, moving=jumping / BOXES, teleport=1, take=["time", "phases"]) for jumping in JUMPING]
    return growing + jumping


def work(run: Run, going: str, boxes: int) -> float:
    """Comparisons and moved entries per box that is inserted at its place."""
    case = growth_case(going, boxes)
    return run.per_mover(case, BINARY, "visited") + run.per_mover(case, BINARY, "moved")


def comparisons(run: Run, going: str, boxes: int) -> float:
    """Per binary search: one finds the old place and one the new place."""
    return run.per_mover(growth_case(going, boxes), BINARY, "visited") / 2


def time(run: Run, going: str, boxes: int) -> float:
    return run.time(growth_case(going, boxes), BINARY, ["mending"])


def growth_beyond(results: Results, going: str, of: Callable[[Run, str, int], float]) -> Estimate:
    """The growth of an amount relative to lg n, from the fewest boxes to the most."""
    def beyond(run: Run) -> float:
        fewest, most = COUNTS[0], COUNTS[-1]
        return of(run, going, most) / of(run, going, fewest) / (log2(most) / log2(fewest))
    return results.between(beyond)


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    nearby = [going for going in GOING if going != FAR]
    beside = {f"work beyond lg n where they go {going}": growth_beyond(results, going, work) for going in nearby}
    for going in GOING:
        beside[f"comparisons of a search beyond lg n where they go {going}"] = growth_beyond(
            results, going, comparisons)
        beside[f"time beyond lg n where they go {going}"] = growth_beyond(results, going, time)
    for jumping in JUMPING:
        for other, name in ((BINARY, "binary search"), (spec("rebuild"), "sorting anew")):
            beside[f"a frame by the heap over {name} where {jumping:,} of {BOXES:,} jump"] = results.ratio(
                heap_case(jumping), spec("heap"), other)
    return [judged("13b", {f"boxes go {FAR}": growth_beyond(results, FAR, work)}, below=rules.twice, beside=beside)]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    drawing, (growing, frames) = figures.new(columns=2)
    for going in GOING:
        figures.line(growing, COUNTS, [results.between(lambda run: work(run, going, boxes)) for boxes in COUNTS],
                     f"all work, {going}")
    figures.line(growing, COUNTS, [results.between(lambda run: comparisons(run, FAR, boxes)) for boxes in COUNTS],
                 "comparisons of a search")
    figures.label(growing, "boxes", "steps")
    figures.legend(growing)
    for update, name in UPDATES.items():
        figures.line(frames, JUMPING, [results.time(heap_case(jumping), spec(update)) for jumping in JUMPING], name)
    figures.label(frames, f"boxes that jump, of {BOXES:,}", "milliseconds of a frame")
    figures.legend(frames)
    yield figures.Figure("sweep_reinsertion", f"Left: comparisons and places moved for each of {MOVERS} boxes that "
                         "are put into the order by binary search, and the comparisons of one search. Right: a frame "
                         "of the draft's sweep where boxes jump, by how its order is kept. Bars: 95% intervals "
                         "between runs.",
                         drawing)


EXPERIMENT = Experiment(
    title="Reinsertion by binary search, and the heap",
    measured=f"The draft's sweep where {MOVERS} boxes move: the comparisons and the places moved for each of them, by "
             "the number of all boxes; and the time of frames where some jump, the order kept by binary search, by "
             "insertion sort or as a heap, or sorted anew.",
    claims=[Claim("13b", "Where boxes go anywhere, which is the worst case, comparisons and places moved for each "
                  f"grow at most {{twice}} times as much as lg n, from {COUNTS[0]:,} to {COUNTS[-1]:,} boxes.",
                  "They grow more than that.")],
    cases=cases, judge=judge, figures=draw)

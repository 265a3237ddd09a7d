"""Verdicts by intervals: what became of each statement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

from .experiment import Experiment, Unusable
from .results import Results
from .rules import RuleBook
from .statistics import Estimate


class Verdict(str, Enum):
    CONFIRMED = "confirmed"
    WITHIN_BOUNDS = "holds within bounds"
    REFUTED = "refuted"
    OPEN = "open"  # intervals hold the threshold
    NOT_TESTABLE = "not testable"


@dataclass(frozen=True)
class Finding:
    """What the figures say of one statement."""

    number: str
    verdict: Verdict
    evidence: Mapping[str, Estimate]
    condition: str = ""  # of a statement within bounds: where it holds; of one that is not testable: why
    beside: Mapping[str, Estimate] = field(default_factory=dict)  # figures that decide nothing


@dataclass(frozen=True)
class Split:
    """Places by what their intervals say of a threshold."""

    held: Sequence[str]
    failed: Sequence[str]
    undecided: Sequence[str]

    def verdict(self) -> Verdict:
        if self.held and not self.failed and not self.undecided:
            return Verdict.CONFIRMED
        if self.held:
            return Verdict.WITHIN_BOUNDS
        return Verdict.OPEN if self.undecided else Verdict.REFUTED


def split(places: Mapping[str, Estimate], *, above: float | None = None, below: float | None = None,
          fails_at: float | None = None) -> Split:
    """Divides places by whether their figure is above (or below) the threshold with its whole interval.

    It fails where the whole interval is on the other side of `fails_at`, which is the threshold unless it is
    given.
    """
    if not places or (above is None) == (below is None):
        raise ValueError("expected places, and either `above` or `below`")
    if above is not None:
        least = above if fails_at is None else fails_at
        holds = {name: (at.is_above(above), at.is_below(least)) for name, at in places.items()}
    else:
        most = below if fails_at is None else fails_at
        holds = {name: (at.is_below(below), at.is_above(most)) for name, at in places.items()}
    return Split([name for name, (yes, _) in holds.items() if yes],
                 [name for name, (_, no) in holds.items() if no],
                 [name for name, (yes, no) in holds.items() if not yes and not no])


def judged(number: str, places: Mapping[str, Estimate], *, above: float | None = None,
           below: float | None = None, fails_at: float | None = None, where: str = "{}",
           beside: Mapping[str, Estimate] | None = None) -> Finding:
    """The verdict on a statement that is to hold at each of these places.

    Confirmed where all intervals are on the right side, refuted where all are on the wrong one; within
    bounds where some are on the right one: `where` then makes a condition of their names.
    """
    if not places:
        return Finding(number, Verdict.OPEN, {}, "nothing that was measured is what it is about", beside or {})
    parts = split(places, above=above, below=below, fails_at=fails_at)
    verdict = parts.verdict()
    condition = ""
    if verdict is Verdict.WITHIN_BOUNDS:
        condition = where.format(listing(parts.held))
        if parts.undecided:
            condition += f"; open: {listing(parts.undecided)}"
    return Finding(number, verdict, dict(places), condition, dict(beside or {}))


def listing(names: Sequence[str]) -> str:
    """ "a", "a and b", "a, b and c"."""
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


def judge(experiment: Experiment, results: Results, book: RuleBook) -> list[Finding]:
    """The findings of an experiment, one for each of its claims, in their order.

    With fewer runs than the rules ask for, every verdict that rests on an interval is open.
    """
    rules = book.of(experiment.name)
    found = {finding.number: finding for finding in experiment.judge(results, rules)}
    expected = [claim.number for claim in experiment.claims]
    if sorted(found) != sorted(expected):
        raise Unusable(f"experiment {experiment.name} judges {listing(sorted(found))}; expected its claims, "
                       f"{listing(expected)}")
    findings = [found[number] for number in expected]
    if len(results.runs) >= rules.min_runs:
        return findings
    return [finding if finding.verdict is Verdict.NOT_TESTABLE else
            replace(finding, verdict=Verdict.OPEN,
                    condition=f"{len(results.runs)} of {rules.min_runs} runs; so far {finding.verdict.value}")
            for finding in findings]

"""Verdicts by intervals: the outcome of each statement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

from .experiment import NAME_FROM_THE_CODE, Experiment, Unusable
from .results import Results
from .rules import RuleBook
from .statistics import Estimate


class Verdict(str, Enum):
    CONFIRMED = "confirmed"
    WITHIN_BOUNDS = "holds within bounds"
    REFUTED = "refuted"
    OPEN = "open"  # intervals contain the threshold


@dataclass(frozen=True)
class Finding:
    """The outcome of one statement."""

    number: str
    verdict: Verdict
    evidence: Mapping[str, Estimate]
    condition: str = ""  # where it holds; if open, why
    share: str = ""      # of the places at which it holds
    beside: Mapping[str, Estimate] = field(default_factory=dict)  # figures that do not decide anything


@dataclass(frozen=True)
class Asked:
    """What a statement requires of a figure: that its whole interval is above or below a threshold, or between two.

    It fails if the whole interval is on the other side of the first threshold or, if given, of `fails_at`.
    """

    at: Estimate
    above: float | None = None
    below: float | None = None
    fails_at: float | None = None

    def holds(self) -> bool:
        return ((self.above is None or self.at.is_above(self.above))
                and (self.below is None or self.at.is_below(self.below)))

    def fails(self) -> bool:
        least, most = self.above, self.below
        if self.fails_at is not None:
            least, most = (self.fails_at, most) if least is not None else (least, self.fails_at)
        return (least is not None and self.at.is_below(least)) or (most is not None and self.at.is_above(most))

    def misses(self) -> bool:
        """The whole interval is on the other side of the first threshold: the statement does not hold, whether or not
        it fails."""
        return replace(self, fails_at=None).fails()


def judged(number: str, places: Mapping[str, Estimate], *, above: float | None = None,
           below: float | None = None, fails_at: float | None = None, where: str = "{}",
           beside: Mapping[str, Estimate] | None = None) -> Finding:
    """The verdict on a statement that requires one thing, and must hold at each of these places."""
    if above is None and below is None:
        raise ValueError("expected `above` or `below`")
    return judged_all(number, {name: {name: Asked(at, above, below, fails_at)} for name, at in places.items()},
                      where=where, beside=beside)


def judged_all(number: str, places: Mapping[str, Mapping[str, Asked]], *, where: str = "{}",
               beside: Mapping[str, Estimate] | None = None) -> Finding:
    """The verdict on a statement that requires several things, by name, of each place.

    At a place, it holds if all hold, and fails if one fails. It is confirmed if it holds at all places, refuted if it
    fails at all of them, and within bounds if it holds at some and is missed at others: `where` then makes a condition
    of the names of the former. If the intervals cannot tell whether there are others, it is open.
    """
    if not places:
        return Finding(number, Verdict.OPEN, {}, "nothing that was measured is what it is about",
                       beside=dict(beside or {}))
    held = [name for name, asked in places.items() if all(one.holds() for one in asked.values())]
    missed = [name for name, asked in places.items() if any(one.misses() for one in asked.values())]
    failed = [name for name, asked in places.items() if any(one.fails() for one in asked.values())]
    undecided = [name for name in places if name not in held and name not in missed]
    condition = ""
    if len(held) == len(places):
        verdict = Verdict.CONFIRMED
    elif held:
        verdict = Verdict.WITHIN_BOUNDS if missed else Verdict.OPEN
        condition = ("" if missed else "it holds where ") + where.format(listing(held))
        condition += f"; open: {listing(undecided)}" if undecided else ""
    else:
        verdict = Verdict.REFUTED if len(failed) == len(places) else Verdict.OPEN
    evidence = {name: one.at for asked in places.values() for name, one in asked.items()}
    return Finding(number, verdict, evidence, condition, f"{len(held)} of {len(places)} places", dict(beside or {}))


def listing(names: Sequence[str]) -> str:
    """ "a", "a and b", "a, b and c"."""
    return " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))


def judge(experiment: Experiment, results: Results, book: RuleBook) -> list[Finding]:
    """The findings of an experiment, one for each of its claims, in their order.

    With fewer runs than the rules require, every verdict that rests on an interval is open.
    """
    rules = book.of(experiment.name)
    found = {finding.number: finding for finding in experiment.judge(results, rules)}
    expected = [claim.number for claim in experiment.claims]
    if sorted(found) != sorted(expected):
        raise Unusable(f"experiment {experiment.name} judges {listing(sorted(found)) or 'nothing'}; expected its "
                       f"claims, {listing(expected)}")
    findings = [found[number] for number in expected]
    for name in (name for finding in findings for name in (*finding.evidence, *finding.beside)):
        if NAME_FROM_THE_CODE.search(name):
            raise Unusable(f"experiment {experiment.name}: '{name}' is a name from the code; expected words")
    if len(results.runs) >= rules.min_runs:
        return findings
    return [replace(finding, verdict=Verdict.OPEN,
                    condition=f"{len(results.runs)} of {rules.min_runs} runs; so far {finding.verdict.value}")
            for finding in findings]

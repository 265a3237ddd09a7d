"""The names for templates: figures, verdicts and drawings of experiments; facts and tables of the comparison."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from . import draft, figures
from .experiment import Unusable
from .judge import Verdict
from .statistics import Estimate
from .tables import Table

if TYPE_CHECKING:
    from .comparison import Comparison
    from .print import JudgedClaim

NOT_MEASURED = "(not measured)"
NONE = "none that was measured"
DIAGRAMS = ("swept_grid", "packed_tree")  # docs/paper/diagrams/


class Words:
    """The functions that templates call. An unknown name raises Unusable, in a line that lists the known ones; results
    that were not measured are marked as such."""

    def __init__(self, claims: Iterable[JudgedClaim], unmeasured: Iterable[str],
                 statements: Mapping[str, draft.DraftStatement], drawings: Iterable[figures.Figure],
                 comparison: Comparison | None):
        self._claims = {claim.number: claim for claim in claims}
        self._unmeasured = set(unmeasured)
        self._statements = statements
        self._drawings = {drawing.name: drawing for drawing in drawings}
        self._comparison = comparison
        self._pictures: list[str] = []  # in the order of the text, which numbers them

    def names(self) -> dict[str, Callable]:
        names = ("figure", "span", "verdict", "by", "picture", "see", "fact", "table")
        return {name: getattr(self, name) for name in names}

    def claim(self, number: str) -> JudgedClaim | None:
        """None if no run covers it."""
        if number in self._claims:
            return self._claims[number]
        if number in self._unmeasured:
            return None
        known = [*self._claims, *sorted(self._unmeasured)]
        raise Unusable(f"no claim '{number}'; expected one of: {', '.join(known)}")

    def estimates(self, number: str, part: str = "") -> dict[str, Estimate]:
        """A claim's figures whose names contain a text."""
        claim = self.claim(number)
        if claim is None:
            return {}
        every = {**claim.finding.evidence, **claim.finding.beside}
        found = {name: at for name, at in every.items() if part in name}
        if not found:
            raise Unusable(f"no figure of {number} has '{part}' in its name; expected one of: {'; '.join(every)}")
        return found

    def figure(self, number: str, name: str) -> str:
        """A figure with its interval."""
        claim = self.claim(number)
        if claim is None:
            return NOT_MEASURED
        at = named({**claim.finding.evidence, **claim.finding.beside}, name, f"figure of {number}")
        return at.text() if math.isfinite(at.value) else NONE

    def span(self, number: str, part: str = "") -> str:
        """ "between 1.42 (1.38 to 1.46) and 3.20 (3.11 to 3.29)", for the figures whose names contain a text. Counts
        crossings that were not reached separately."""
        every = self.estimates(number, part)
        if not every:
            return NOT_MEASURED
        found = sorted((at for at in every.values() if math.isfinite(at.value)), key=lambda at: at.value)
        if not found:
            return NONE
        least, greatest = found[0], found[-1]
        if least.unit == greatest.unit:
            least = replace(least, unit="")
        is_one = found[0].text() == greatest.text()
        text = greatest.text() if is_one else f"between {least.text()} and {greatest.text()}"
        missing = len(every) - len(found)
        return text + (f" (and nowhere in {missing} of {len(every)} series)" if missing else "")

    def verdict(self, number: str) -> str:
        """ "is confirmed", "holds within bounds": the condition is in the table of verdicts."""
        claim = self.claim(number)
        value = claim.finding.verdict.value if claim else NOT_MEASURED
        return value if value.startswith("holds") else f"is {value}"

    def by(self, number: str, *, confirmed: str, bounds: str, refuted: str, otherwise: str) -> str:
        """The text for the outcome; `otherwise` if it is open."""
        claim = self.claim(number)
        texts = {Verdict.CONFIRMED: confirmed, Verdict.WITHIN_BOUNDS: bounds, Verdict.REFUTED: refuted}
        return texts.get(claim.finding.verdict, otherwise) if claim else otherwise

    def picture(self, name: str, caption: str = "") -> str:
        """A drawing with its number and caption."""
        drawing = None
        if name in DIAGRAMS:
            path = f"diagrams/{name}.svg"
        elif self._is_missing(name):
            return f"*The figure {name} was not drawn: nothing was measured.*"
        else:
            drawing = named(self._drawings, name, "figure")
            path = f"figures/{name}"
        if name not in self._pictures:
            self._pictures.append(name)
        return f"![{self.see(name)}. {caption or drawing.caption}]({path})"

    def see(self, name: str) -> str:
        """ "Figure 3". Pages are filled twice, so that this may precede the picture."""
        if name not in self._drawings and name not in DIAGRAMS and not self._is_missing(name):
            named(self._drawings, name, "figure")
        return f"Figure {self._pictures.index(name) + 1 if name in self._pictures else 0}"

    def _is_missing(self, name: str) -> bool:
        return name not in self._drawings and (
            self._comparison is None if name.startswith("comparison") else bool(self._unmeasured))

    def fact(self, name: str) -> str | bool:
        return named(self._comparison.facts, name, "fact of the comparison") if self._comparison else NOT_MEASURED

    def table(self, name: str, without: Sequence[str] = ()) -> str:
        """A table of the comparison, without some columns."""
        if self._comparison is None:
            return NOT_MEASURED
        table = named(self._comparison.tables, name, "table of the comparison")
        for heading in without:
            named(dict.fromkeys(table.headings), heading, f"column of {name}")
        kept = [i for i, heading in enumerate(table.headings) if heading not in without]
        return Table([table.headings[i] for i in kept], [[row[i] for i in kept] for row in table.rows]).markdown()


def named(things: Mapping, name: str, what: str):
    if name not in things:
        raise Unusable(f"no {what} '{name}'; expected one of: {'; '.join(map(str, things))}")
    return things[name]

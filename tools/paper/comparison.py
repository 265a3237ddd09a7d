"""The comparison with other libraries: what its committed results come to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from .experiment import Unusable
from .figures import Figure
from .tables import Table


@dataclass(frozen=True)
class Comparison:
    """What templates may name: facts, ready to print with their intervals, tables and figures."""

    facts: Mapping[str, str | bool]
    tables: Mapping[str, Table]
    figures: Sequence[Figure]


def comparison(folder: Path) -> Comparison:
    """Throws Unusable, in one line, where there are no results of this version."""
    raise Unusable(f"{folder} has no comparison; expected one")

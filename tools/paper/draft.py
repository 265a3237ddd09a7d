"""The statements of the draft, and our own claims, from docs/draft.md."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

KINDS = ("claim", "definition", "opinion", "listing", "our claim")
PATH = Path(__file__).parents[2] / "docs" / "draft.md"


@dataclass(frozen=True)
class DraftStatement:
    number: str   # "8a", "V.1", "Algorithm 7"
    section: str  # "V. Quadtree"
    says: str
    kind: str     # claim, definition, opinion or listing; or our claim


def statements(path: Path = PATH) -> dict[str, DraftStatement]:
    """All statements by number, in the order of the draft."""
    found: dict[str, DraftStatement] = {}
    sections = ["", ""]
    for line in path.read_text(encoding="utf-8").splitlines():
        if heading := re.match(r"(##+) (.*)", line):
            level = len(heading[1]) - 2
            sections[level] = heading[2]
            sections[level + 1:] = [""] * (1 - level)
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if sections[0] and len(cells) == 4 and cells[2] in KINDS:
            section = ", ".join(part for part in sections if part)
            found[cells[0]] = DraftStatement(cells[0], section, cells[1], cells[2])
    return found

"""Markdown tables with columns as wide in print as their contents need."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

LINE = 110   # width of a printed table line, in characters
SHORT = 22   # columns up to this width keep it; the others share the rest


@dataclass(frozen=True)
class Table:
    """Cells are Markdown; a column whose heading ends in a colon is aligned to the right."""

    headings: Sequence[str]
    rows: Sequence[Sequence[str]]

    def markdown(self) -> str:
        for row in self.rows:
            if len(row) != len(self.headings):
                raise ValueError(f"a row of {len(row)} cells; expected {len(self.headings)}: {row}")
        is_right = [heading.endswith(":") for heading in self.headings]
        lines = [[heading.removesuffix(":") for heading in self.headings], *self.rows]
        dashes = ["-" * max(width - right, 3) + (":" if right else "")
                  for width, right in zip(self.widths(), is_right)]
        texts = [" | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in line) for line in lines]
        return "\n".join(f"| {text} |" for text in [texts[0], " | ".join(dashes), *texts[1:]])

    def widths(self) -> list[int]:
        """The width of each column in characters: pandoc divides the line by these widths if a row is longer than the
        line."""
        columns = [[printed(row[i]) for row in self.rows] for i in range(len(self.headings))]
        longest = [max([len(cell) for cell in column] + [longest_word([heading.removesuffix(":")])])
                   for heading, column in zip(self.headings, columns)]
        if sum(longest) + 3 * len(longest) <= LINE:
            return [width + 2 for width in longest]
        left = LINE - sum(width + 2 for width in longest if width <= SHORT)
        shares = [math.sqrt(sum(map(len, column))) if width > SHORT else 0
                  for width, column in zip(longest, columns)]
        return [width + 2 if width <= SHORT else
                max(round(left * share / sum(shares)), min(longest_word(column), 24) + 2)
                for width, share, column in zip(longest, shares, columns)]


def printed(cell: str) -> str:
    """Without link addresses and the markup of code and emphasis."""
    return re.sub(r"[`*]", "", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", cell))


def longest_word(cells: Sequence[str]) -> int:
    return max((len(word) for cell in cells for word in printed(cell).split()), default=1)

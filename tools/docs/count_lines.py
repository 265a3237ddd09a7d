#!/usr/bin/python3
"""Counts lines of code by part of the project, for one revision or several: tools/docs/count_lines.py [REVISION ...]

Counts every line of tracked source files. Moved folders count for the part to which they belong today.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tarfile
from collections import Counter

SOURCES = (".c", ".cmake", ".cpp", ".h", ".hpp", ".mjs", ".py", ".ts", ".tsx")
PARTS = {
    "library (include, src)": ("include", "src"),
    "tools": ("tools", "lab", "cli", "bench", "paper", "web", "scripts", "packaging"),
    "bindings, distributed, integrations": ("bindings", "distributed", "integrations"),
    "tests": ("tests",),
    "examples, cmake": ("examples", "cmake"),
}
PART_OF = {folder: part for part, folders in PARTS.items() for folder in folders}


def lines_of(revision: str) -> Counter[str]:
    packed = subprocess.run(["git", "archive", revision], check=True, capture_output=True).stdout
    counted: Counter[str] = Counter()
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        for member in archive:
            part = PART_OF.get(member.name.split("/", 1)[0])
            file = archive.extractfile(member) if part and member.name.endswith(SOURCES) else None
            if part and file:
                counted[part] += file.read().count(b"\n")
    return counted


def main() -> None:
    revisions = sys.argv[1:] or ["HEAD"]
    counts = {revision: lines_of(revision) for revision in revisions}
    print("| part |", " | ".join(revisions), "|")
    print("|---|" + "---:|" * len(revisions))
    for part in PARTS:
        print(f"| {part} |", " | ".join(f"{counts[revision][part]:,}" for revision in revisions), "|")
    print("| all |", " | ".join(f"{counts[revision].total():,}" for revision in revisions), "|")


if __name__ == "__main__":
    main()

"""broadside.pairs against other libraries for Python: verified in the same run, alternating rounds, Markdown.

    python3 -m venv build/python/peers
    build/python/peers/bin/pip install --requirement tools/bench/python/requirements.txt build/python/wheels/*.whl
    build/python/peers/bin/python tools/bench/python/compare.py [--boxes 1000,10000,100000,1000000] [--threads 2]

Each library makes its structures anew in each call, as broadside does, except in `queries`, where all keep an index. It
runs in a process of its own; one that is not installed is left out by name. The table's columns:

    ms           a call: median of the rounds. What the library takes (its geometries, tables, objects) lies ready
    CPU ms       processor time of a call, which tells how many threads were used, and on a busy machine more than ms
    broadside x  its time over broadside's in the same round: median, lowest and highest; then the same of CPU ms
    in, out      ms for making what it takes of arrays (in queries, its index), and an array of what it returns: not in ms
    empty        us for a call with two boxes that do not overlap: in ms

With --cpp FILE it also compares with find_pairs() in C++, called by tools/bench/python/cpp_times.cpp, which says how to
build it.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import os
import platform
import re
import statistics
import subprocess
import sys
from collections.abc import Sequence
from datetime import date
from pathlib import Path

import numpy as np

import broadside
from libraries import LIBRARIES
from rounds import KINDS, Case, Library, Result, Runner, compare, scattered, seconds


def version(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def availability(library: Library) -> str:
    """Versions of what a library takes, or how to install what is missing."""
    versions = {package: version(package) for package in library.packages}
    missing = [package for package, found in versions.items() if found is None]
    if not missing:
        return ", ".join(f"{package} {found}" for package, found in versions.items())
    pins = Path(__file__).with_name("requirements.txt").read_text()
    wanted = [match[0] if (match := re.search(f"^{package}==.*", pins, re.MULTILINE)) else package for package in library.packages]
    return f"left out: {', '.join(missing)} not installed (`pip install {' '.join(wanted)}`)"


def lines_of(case: Case, results: dict[str, Result]) -> list[str]:
    start = f"| {case.n:,} | {case.dimension}D | {case.kind} |"
    lines = []
    own_work = statistics.median(next(iter(results.values())).work or [np.nan])
    timed = {name: result for name, result in results.items() if not result.note}
    for name, one in sorted(timed.items(), key=lambda item: statistics.median(item[1].times)):
        work, pairs = statistics.median(one.work), f"{one.pairs:,}" + (" (counted)" if one.is_counted else "")
        lines.append(
            f"{start} {name} | {statistics.median(one.times) * 1e3:,.2f} | {work * 1e3:,.2f} | "
            f"{statistics.median(one.ratios):,.1f} ({min(one.ratios):,.1f} to {max(one.ratios):,.1f}); {work / own_work:,.1f} | "
            f"{one.taking * 1e3:,.2f}, {one.listing * 1e3:,.2f} | {one.empty * 1e6:,.0f} | {pairs} |"
        )
    return lines + [f"{start} {name} | {one.note} | | | | | |" for name, one in results.items() if one.note]


def overhead(program: str) -> list[str]:
    """Time of Python over C++ for the same task: the same boxes, one thread, pairs in an array."""
    lines = []
    for n in (10, 100_000):
        boxes = scattered(n, 2, 1).astype(np.float32)
        calls = 20_000 if n == 10 else 5
        ratios, ours, theirs = [], [], []
        boxes.tofile(f"{program}.boxes")
        for _ in range(9):
            one = min(seconds(lambda: [broadside.pairs(boxes, threads=1) for _ in range(calls)])[0] / calls for _ in range(3))
            done = subprocess.run([program, f"{program}.boxes", str(calls)], capture_output=True, text=True, check=True)
            count, other = done.stdout.split()
            assert int(count) == broadside.count(boxes)
            ours.append(one)
            theirs.append(float(other))
            ratios.append(one / float(other))
        lines.append(
            f"| {n:,} | {statistics.median(ours) * 1e6:,.2f} | {statistics.median(theirs) * 1e6:,.2f} | "
            f"{statistics.median(ratios):.2f} |"
        )
    os.remove(f"{program}.boxes")
    return lines


def chosen(name: str, choices: Sequence[str]) -> list[str]:
    found = [choice for choice in choices if name.lower() in choice.lower()]
    if not found:
        raise SystemExit(f"compare.py: no library '{name}'; there are: {', '.join(choices)}")
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boxes", default="1000,10000,100000")
    parser.add_argument("--dimensions", default="2,3", help="1: intervals")
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--libraries", help="parts of names: only these")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--threads", type=int, default=1, help="more than one: only libraries that have threads")
    parser.add_argument("--limit", type=float, default=120, help="seconds after which a call is stopped")
    parser.add_argument("--slow", type=float, default=5, help="a library is called once if that takes more seconds")
    parser.add_argument("--cpp", help="the program made of tools/bench/python/cpp_times.cpp")
    arguments = parser.parse_args()

    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, NumPy {np.__version__}, "
          f"Broadside {broadside.__version__}, {date.today()}, threads: {arguments.threads}; `{' '.join(sys.argv)}`\n")
    names = [library.name for library in LIBRARIES]
    if arguments.libraries:
        names = [name for part in ["broadside", *arguments.libraries.split(",")] for name in chosen(part, names)]
    runners = []
    for library in LIBRARIES:
        if library.name in names:
            found = availability(library)
            if arguments.threads > 1 and not library.has_threads and "broadside" not in library.packages:
                found = "left out: it has no threads"
            print(f"- {library.name}: {found}")
            if not found.startswith("left out"):
                runners.append(Runner(library, arguments.threads))

    print("\n| boxes | | sets | library | ms | CPU ms | broadside x; by CPU | in, out, ms | empty, us | pairs |")
    print("|---:|---|---|---|---:|---:|---:|---:|---:|---:|")
    for dimension in map(int, arguments.dimensions.split(",")):
        for n in map(int, arguments.boxes.split(",")):
            for kind in arguments.kinds.split(","):
                here = [one for one in runners if dimension in one.library.dimensions and kind in one.library.kinds]
                if len(here) < 2:
                    continue
                case = Case(n, dimension, kind)
                results = compare(here, case, arguments.rounds, arguments.limit, arguments.slow)
                print("\n".join(lines_of(case, results)), flush=True)
    for runner in runners:
        runner.stop()
    if arguments.cpp:
        print("\n| boxes | Python, us | C++, us | ratio |\n|---:|---:|---:|---:|")
        print("\n".join(overhead(arguments.cpp)))


if __name__ == "__main__":
    main()

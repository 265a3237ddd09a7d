"""broadside.pairs(points, within=r) against SciPy's k-d tree and the neighbour lists of particle codes: the same pairs in
the same run, Markdown.

    build/python/tester/bin/python tools/bench/python/within.py [--points 10000,1000000] [--neighbours 6,30] [--rounds 3]
        [--limit 60] [--libraries scipy,vesin]

Points are uniform in a cube, in double. Each library gets the array of points and returns an array of pairs, with what it
builds for that, in one thread; "search" is broadside alone for boxes that overlap on each axis, without the distance. A
library whose first call takes longer than --limit seconds is called only once. freud, vesin and MDAnalysis take part where
they are installed (pip install freud-analysis vesin MDAnalysis). freud stores floats, and is measured with every pair in both
directions and its distance, as it makes them; the others give each pair once.
"""

from __future__ import annotations

import argparse
import importlib
import os
import platform
import statistics
from collections.abc import Callable
from datetime import date
from typing import Any

import numpy as np
from rounds import seconds

import broadside

Call = Callable[[np.ndarray, float], Any]


def search_alone(points: np.ndarray, r: float) -> Any:
    return broadside.pairs(np.hstack([points - r / 2, points + r / 2]), threads=1)


def by_broadside(points: np.ndarray, r: float) -> Any:
    return broadside.pairs(points, within=r, threads=1)


def full_lists(points: np.ndarray, r: float) -> Any:
    pairs = by_broadside(points, r)
    lists = broadside.neighbour_lists(pairs, len(points))
    return pairs, lists, broadside.distances(points, pairs)


def make_scipy() -> Call:
    tree = importlib.import_module("scipy.spatial").cKDTree
    return lambda points, r: tree(points).query_pairs(r, output_type="ndarray")


def make_freud() -> Call:
    freud = importlib.import_module("freud")
    freud.parallel.set_num_threads(1)

    def call(points: np.ndarray, r: float) -> Any:
        box = freud.box.Box.cube(4)  # larger than the cloud by more than r: nothing is periodic
        query = freud.locality.AABBQuery(box, points - 0.5).query(points - 0.5, {"r_max": r, "exclude_ii": True})
        return query.toNeighborList()[:]

    return call


def make_vesin() -> Call:
    vesin = importlib.import_module("vesin")

    def call(points: np.ndarray, r: float) -> Any:
        lists = vesin.NeighborList(cutoff=r, full_list=False)
        i, j = lists.compute(points=points, box=np.zeros((3, 3)), periodic=False, quantities="ij")
        return np.column_stack([i, j])

    return call


def make_mdanalysis() -> Call:
    distances = importlib.import_module("MDAnalysis.lib.distances")
    return lambda points, r: distances.self_capped_distance(
        points.astype(np.float32), r, method="nsgrid", return_distances=False
    )


OTHERS: dict[str, Callable[[], Call]] = {
    "scipy cKDTree.query_pairs": make_scipy,
    "freud AABBQuery": make_freud,
    "vesin NeighborList": make_vesin,
    "MDAnalysis self_capped_distance": make_mdanalysis,
}


def keys(pairs: np.ndarray, n: int) -> np.ndarray:
    """Each pair once, as a number, sorted."""
    rows = np.sort(np.asarray(pairs).astype(np.int64), axis=1)
    return np.unique(rows[:, 0] * n + rows[:, 1])


def difference(found: np.ndarray, expected: np.ndarray, points: np.ndarray, r: float) -> str:
    """Empty, or how many pairs differ. Libraries that store floats may differ where the distance is r, rounded."""
    wrong = np.setxor1d(found, expected, assume_unique=True)
    a, b = np.divmod(wrong, len(points))
    off = np.abs(np.linalg.norm(points[a] - points[b], axis=1) - r)
    far = int((off > 1e-5 * r).sum())
    if far:
        return f"{far} pairs differ"
    return f"{len(wrong)} of {len(expected)} pairs differ, where floats round" if len(wrong) else ""


def measure(points: np.ndarray, r: float, calls: dict[str, Call], rounds: int, limit: float) -> list[str]:
    times: dict[str, list[float]] = {name: [] for name in calls}
    notes: dict[str, str] = {}
    expected = keys(by_broadside(points, r), len(points))
    for turn in range(rounds):
        for name, call in calls.items():
            if times[name] and times[name][0] > limit:
                continue
            took, found = seconds(lambda call=call: call(points, r))
            times[name].append(took)
            if turn == 0 and name in OTHERS:
                notes[name] = difference(keys(found, len(points)), expected, points, r)
    medians = {name: statistics.median(of_name) for name, of_name in times.items()}
    base = {"freud AABBQuery": "broadside, full lists and distances"}
    lines = []
    for name, median in medians.items():
        ours = medians[base.get(name, "broadside within")]
        lines.append(f"| {name} | {1e3 * median:.1f} | {median / ours:.2f} | {notes.get(name, '')} |")
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", default="10000,1000000")
    parser.add_argument("--neighbours", default="6,30")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--limit", type=float, default=60)
    parser.add_argument("--libraries", default="", help="parts of names: only these besides broadside")
    options = parser.parse_args()
    calls: dict[str, Call] = {
        "search on each axis alone": search_alone,
        "broadside within": by_broadside,
        "broadside, full lists and distances": full_lists,
    }
    for name, make in OTHERS.items():
        if not any(part in name for part in options.libraries.split(",")):
            continue
        try:
            calls[name] = make()
        except ImportError as error:
            print(f"{name} is left out: {error}")
    print(f"{date.today()}, {platform.processor() or platform.machine()}, {os.cpu_count()} cores, broadside {broadside.__version__}")
    for n in map(int, options.points.split(",")):
        points = np.random.default_rng(n).random((n, 3))
        for neighbours in map(float, options.neighbours.split(",")):
            r = (neighbours / n / (4 / 3 * np.pi)) ** (1 / 3)
            print(f"\n{n:,} points, about {neighbours:g} neighbours each: {len(by_broadside(points, r)):,} pairs\n")
            print("| | ms | times broadside's | |\n|---|---:|---:|---|")
            print("\n".join(measure(points, r, calls, options.rounds, options.limit)), flush=True)


if __name__ == "__main__":
    main()

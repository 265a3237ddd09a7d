"""broadside.nearest_pairs against other k-nearest joins for Python: distances compared in the same run, Markdown.

    build/python/peers/bin/pip install pykdtree
    build/python/peers/bin/python tools/bench/python/nearest.py [--points 10000,1000000] [--k 1,10] [--threads 1,2]

Random points, of float64 or of --dtype float32, one set (a point is not its own neighbour) and two sets. Each call
makes its tree anew and finds the k nearest of every point. In one set, the others search for k + 1 and drop the
nearest, which is the point itself. Rounds alternate. Distances must agree to a relative 1e-6: pykdtree computes in
float if it is given float32.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.metadata
import os
import platform
import statistics
import sys
from collections.abc import Callable
from datetime import date
from typing import Any

import numpy as np

import broadside
from rounds import seconds

Points = np.ndarray
Search = Callable[[Points, Points, int, int], np.ndarray]  # (left, right, k, threads) to distances, shape (n, k)


def by_broadside(left: Points, right: Points, k: int, threads: int) -> np.ndarray:
    other = None if right is left else right
    return np.sqrt(broadside.nearest_pairs(left, other, k, threads=threads).distance_squared)


def by_scipy(left: Points, right: Points, k: int, threads: int) -> np.ndarray:
    tree = importlib.import_module("scipy.spatial").cKDTree(right)
    skipped = int(right is left)
    return tree.query(left, k + skipped, workers=threads)[0].reshape(len(left), -1)[:, skipped:]


def by_pykdtree(left: Points, right: Points, k: int, threads: int) -> np.ndarray:
    tree = importlib.import_module("pykdtree.kdtree").KDTree(right)
    skipped = int(right is left)
    return tree.query(left, k + skipped)[0].reshape(len(left), -1)[:, skipped:]


def by_shapely(left: Points, right: Points, k: int, threads: int) -> np.ndarray:
    """What geopandas.sjoin_nearest calls."""
    shapely = importlib.import_module("shapely")
    tree = shapely.STRtree(shapely.points(right))
    found = tree.query_nearest(shapely.points(left), exclusive=right is left, all_matches=False, return_distance=True)
    return found[1].reshape(-1, 1)


# name: the search, its package, its dimensions, its greatest k; compared with one thread, except SciPy
PEERS: dict[str, tuple[Search, str, tuple[int, ...], int]] = {
    "scipy cKDTree": (by_scipy, "scipy", (2, 3), 1000),
    "pykdtree": (by_pykdtree, "pykdtree", (2, 3), 1000),
    "shapely query_nearest": (by_shapely, "shapely", (2,), 1),
}


def numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]


def version(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def compare(left: Points, right: Points, k: int, threads: int, searches: dict[str, Search], rounds: int) -> list[str]:
    times: dict[str, list[float]] = {name: [] for name in searches}
    expected: Any = None
    for turn in range(rounds):
        for name in list(searches) if turn % 2 == 0 else list(searches)[::-1]:
            taken, found = seconds(lambda: searches[name](left, right, k, threads))
            expected = found if expected is None else expected
            if not np.allclose(found, expected, rtol=1e-6, atol=1e-12):
                raise SystemExit(f"{name} finds other distances")
            times[name].append(taken)
    own = times["broadside"]
    start = f"| {len(left):,} | {left.shape[1]}D | {'one' if right is left else 'two'} | {k} | {threads} |"
    return [
        f"{start} {name} | {statistics.median(taken) * 1e3:,.1f} | "
        f"{statistics.median(theirs / ours for theirs, ours in zip(taken, own)):.1f} |"
        for name, taken in times.items()
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=numbers, default=[10_000, 1_000_000])
    parser.add_argument("--dimensions", type=numbers, default=[2, 3])
    parser.add_argument("--k", type=numbers, default=[1, 10])
    parser.add_argument("--threads", type=numbers, default=[1, 2])
    parser.add_argument("--dtype", choices=["float32", "float64"], default="float64")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    found = {package: version(package) for _, package, _, _ in PEERS.values()}
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, NumPy {np.__version__}, "
          f"Broadside {broadside.__version__}, {date.today()}; `{' '.join(sys.argv)}`\n")
    for package, one in found.items():
        print(f"- {package}: {one or f'left out, not installed (`pip install {package}`)'}")
    print("\n| points | | sets | k | threads | library | ms | broadside x |\n|---:|---|---|---:|---:|---|---:|---:|")
    for n in options.points:
        for dimension in options.dimensions:
            left, other = (np.random.default_rng(seed).random((n, dimension), options.dtype) for seed in (1, 2))
            for k in options.k:
                for threads in options.threads:
                    for right in (left, other):
                        searches: dict[str, Search] = {"broadside": by_broadside}
                        for name, (search, package, dimensions, most) in PEERS.items():
                            if found[package] is None or dimension not in dimensions or k > most:
                                continue
                            if threads > 1 and name != "scipy cKDTree":
                                continue
                            searches[name] = search
                        print("\n".join(compare(left, right, k, threads, searches, options.rounds)), flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # pykdtree's threads
    main()

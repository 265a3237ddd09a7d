"""broadside.pairs against other libraries for Python: verified in the same run, medians of alternating rounds, Markdown.

    build/python/tester/bin/pip install --requirement tools/bench/python/requirements.txt
    build/python/tester/bin/python tools/bench/python/compare.py [--boxes 10000,100000,1000000] [--rounds 7] [--threads 1]

With --cpp FILE it also compares with find_pairs() in C++, called by tools/bench/python/cpp_times.cpp, which says how to
build it. Each library rebuilds its structures from the arrays in each call, as broadside does.
"""

from __future__ import annotations

import argparse
import importlib
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from datetime import date
from typing import Any

import numpy as np

import broadside

Pairs = Any  # an array of pairs, or their number
SLOW_SECONDS = 60.0  # a library is left out of the rounds if its first call takes longer


def scattered(n: int, dimension: int, seed: int) -> np.ndarray:
    """Boxes that each overlap about two others."""
    rng = np.random.default_rng(seed)
    minima = rng.random((n, dimension))
    sides = rng.random((n, dimension)) * 2 / n ** (1 / dimension)
    return np.hstack([minima, minima + sides])


def self_pairs(rows: np.ndarray) -> np.ndarray:
    """Keeps each pair of a self-join once."""
    return rows[rows[:, 0] < rows[:, 1]]


def make_broadside(threads: int) -> Callable[..., Pairs]:
    return lambda a, b: broadside.pairs(a, b, threads=threads)


def make_shapely(threads: int) -> Callable[..., Pairs] | None:
    shapely = importlib.import_module("shapely")

    def search(a: np.ndarray, b: np.ndarray | None) -> Pairs:
        left = shapely.box(*a.T)
        tree = shapely.STRtree(left if b is None else shapely.box(*b.T))
        rows = tree.query(left).T  # by the bounds alone
        return self_pairs(rows) if b is None else rows

    return search


def make_geopandas(threads: int) -> Callable[..., Pairs] | None:
    geopandas = importlib.import_module("geopandas")
    shapely = importlib.import_module("shapely")

    def search(a: np.ndarray, b: np.ndarray | None) -> Pairs:
        left = geopandas.GeoDataFrame(geometry=shapely.box(*a.T))
        right = left if b is None else geopandas.GeoDataFrame(geometry=shapely.box(*b.T))
        joined = geopandas.sjoin(left, right, predicate="intersects")
        rows = np.column_stack([joined.index.to_numpy(), joined["index_right"].to_numpy()])
        return self_pairs(rows) if b is None else rows

    return search


def make_rtree(threads: int) -> Callable[..., Pairs] | None:
    index = importlib.import_module("rtree.index")

    def search(a: np.ndarray, b: np.ndarray | None) -> Pairs:
        half = a.shape[1] // 2
        right = np.ascontiguousarray(a if b is None else b)
        tree = index.Index((np.arange(len(right)), right[:, :half], right[:, half:]), properties=index.Property(dimension=half))
        found, counts = tree.intersection_v(a[:, :half], a[:, half:])
        rows = np.column_stack([np.repeat(np.arange(len(a)), counts.astype(np.int64)), found])
        return self_pairs(rows) if b is None else rows

    return search


def make_prtree(threads: int) -> Callable[..., Pairs] | None:
    prtree = importlib.import_module("python_prtree")

    def search(a: np.ndarray, b: np.ndarray | None) -> Pairs:
        kind = prtree.PRTree2D if a.shape[1] == 4 else prtree.PRTree3D
        right = a if b is None else b
        tree = kind(np.arange(len(right)), right)
        found = tree.batch_query(a)
        counts = [len(one) for one in found]
        rows = np.column_stack(
            [np.repeat(np.arange(len(a)), counts), np.concatenate([np.asarray(one, np.int64) for one in found])]
        )
        return self_pairs(rows) if b is None else rows

    return search


def make_scipy(threads: int) -> Callable[..., Pairs] | None:
    """A tree of points: finds centres within the longest side, and filters the overlapping boxes."""
    spatial = importlib.import_module("scipy.spatial")

    def search(a: np.ndarray, b: np.ndarray | None) -> Pairs:
        half = a.shape[1] // 2
        right = a if b is None else b
        reach = (a[:, half:] - a[:, :half]).max() / 2 + (right[:, half:] - right[:, :half]).max() / 2
        tree = spatial.cKDTree((right[:, :half] + right[:, half:]) / 2)
        # Rounding of centres must lose no pair.
        radius = reach * (1 + 1e-9)
        if b is None:
            rows = tree.query_pairs(radius, p=np.inf, output_type="ndarray")
        else:
            found = spatial.cKDTree((a[:, :half] + a[:, half:]) / 2).sparse_distance_matrix(tree, radius, p=np.inf, output_type="ndarray")
            rows = np.column_stack([found["i"], found["j"]])
        left, other = a[rows[:, 0]], right[rows[:, 1]]
        overlap = ((left[:, :half] <= other[:, half:]) & (other[:, :half] <= left[:, half:])).all(axis=1)
        return rows[overlap]

    return search


def make_coal(threads: int) -> Callable[..., Pairs] | None:
    """Its broad phase as a physics engine uses it, with an object per box. Python can only count the pairs."""
    coal = importlib.import_module("coal")

    def manager_of(boxes: np.ndarray) -> tuple[Any, list[Any]]:
        manager = coal.DynamicAABBTreeCollisionManager()
        objects = [
            coal.CollisionObject(coal.Box(*(row[3:] - row[:3])), np.eye(3), (row[3:] + row[:3]) / 2) for row in boxes
        ]
        for one in objects:
            manager.registerObject(one)
        manager.setup()
        return manager, objects

    def search(a: np.ndarray, b: np.ndarray | None) -> Pairs:
        manager, kept = manager_of(a)
        counter = coal.CollisionCallBackCollect(100 * len(a))
        if b is None:
            manager.collide(counter)
            return counter.numCollisionPairs()
        other, also_kept = manager_of(b)
        manager.collide(other, counter)
        return counter.numCollisionPairs()

    return search


def make_duckdb(threads: int) -> Callable[..., Pairs] | None:
    duckdb = importlib.import_module("duckdb")
    connection = duckdb.connect(config={"threads": threads})

    def search(a: np.ndarray, b: np.ndarray | None) -> Pairs:
        half = a.shape[1] // 2
        axes = "xyz"[:half]

        def columns(boxes: np.ndarray) -> dict[str, np.ndarray]:
            named = {f"min_{axis}": boxes[:, i] for i, axis in enumerate(axes)}
            named |= {f"max_{axis}": boxes[:, half + i] for i, axis in enumerate(axes)}
            return {"id": np.arange(len(boxes))} | named

        left = columns(a)
        right = left if b is None else columns(b)
        touching = " and ".join(f"l.min_{x} <= r.max_{x} and r.min_{x} <= l.max_{x}" for x in axes)
        connection.register("l_boxes", importlib.import_module("pyarrow").table(left))
        connection.register("r_boxes", importlib.import_module("pyarrow").table(right))
        found = connection.execute(
            f"select l.id as i, r.id as j from l_boxes l join r_boxes r on {touching}" + (" and l.id < r.id" if b is None else "")
        ).fetchnumpy()
        return np.column_stack([found["i"], found["j"]])

    return search


LIBRARIES = {
    "broadside": (make_broadside, (2, 3)),
    "shapely.STRtree": (make_shapely, (2,)),
    "geopandas.sjoin": (make_geopandas, (2,)),
    "rtree": (make_rtree, (2, 3)),
    "python-prtree": (make_prtree, (2, 3)),
    "scipy.cKDTree": (make_scipy, (2, 3)),
    "coal": (make_coal, (3,)),
    "DuckDB": (make_duckdb, (2, 3)),
}


def keys(rows: Pairs, is_self: bool) -> np.ndarray:
    rows = np.asarray(rows, np.int64).reshape(-1, 2)
    if is_self:
        rows = np.sort(rows, axis=1)
    return np.sort(rows[:, 0] << 32 | rows[:, 1])


def seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    began = time.perf_counter()
    result = call()
    return time.perf_counter() - began, result


def compare(n: int, dimension: int, two_sets: bool, rounds: int, threads: int) -> list[str]:
    a = scattered(n, dimension, 1)
    b = scattered(n, dimension, 2) if two_sets else None
    searches: dict[str, Callable[..., Pairs]] = {}
    notes: dict[str, str] = {}
    expected = None
    for name, (make, dimensions) in LIBRARIES.items():
        if dimension not in dimensions:
            continue
        try:
            search = make(threads)
            taken, rows = seconds(lambda: search(a, b))
        except Exception as error:  # an unsupported case is reported in the library's line
            notes[name] = f"{type(error).__name__}: {str(error).splitlines()[0][:60]}"
            continue
        if isinstance(rows, int):
            is_right, count = expected is not None and rows == len(expected), rows
        else:
            found = keys(rows, not two_sets)
            expected = found if expected is None else expected
            is_right, count = np.array_equal(found, expected), len(found)
        if not is_right:
            notes[name] = f"wrong: {count:,} pairs, {len(expected):,} expected"
            continue
        if taken > SLOW_SECONDS:
            notes[name] = f"one call: {taken:,.1f} s"
        else:
            searches[name] = search
    times: dict[str, list[float]] = {name: [] for name in searches}
    for _ in range(rounds):
        for name, search in searches.items():
            times[name].append(seconds(lambda: search(a, b))[0])
    best = statistics.median(times["broadside"])
    sets = "two sets" if two_sets else "one set"
    lines = []
    for name in sorted(times, key=lambda one: statistics.median(times[one])):
        median = statistics.median(times[name])
        lines.append(f"| {n:,} | {dimension}D | {sets} | {name} | {median * 1e3:,.2f} | {median / best:,.1f} |")
    lines += [f"| {n:,} | {dimension}D | {sets} | {name} | {note} | |" for name, note in notes.items()]
    return lines


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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boxes", default="10000,100000,1000000")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--dimensions", default="2,3")
    parser.add_argument("--cpp", help="the program made of tools/bench/python/cpp_times.cpp")
    arguments = parser.parse_args()
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, NumPy {np.__version__}, "
          f"Broadside {broadside.__version__}, {date.today()}, threads: {arguments.threads}; `{' '.join(sys.argv)}`\n")
    print("| boxes | | sets | library | ms | times broadside |\n|---:|---|---|---|---:|---:|")
    for dimension in map(int, arguments.dimensions.split(",")):
        for n in map(int, arguments.boxes.split(",")):
            for two_sets in (False, True):
                print("\n".join(compare(n, dimension, two_sets, arguments.rounds, arguments.threads)), flush=True)
    if arguments.cpp:
        print("\n| boxes | Python, us | C++, us | ratio |\n|---:|---:|---:|---:|")
        print("\n".join(overhead(arguments.cpp)))


if __name__ == "__main__":
    main()

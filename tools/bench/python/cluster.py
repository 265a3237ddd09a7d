"""broadside.dask.pairs against dask-geopandas' spatial join and DuckDB's range join: verified in the same run, Markdown.

    build/python/tester/bin/python tools/bench/python/cluster.py [--boxes 100000,1000000] [--rounds 3] [--workers 2]
        [--chunks 8] [--slow 8] [--limit 60]

The Dask libraries run on one LocalCluster, which already holds the boxes, with one process and thread per worker; DuckDB
uses as many threads. All send their pairs to this process. A library is called only once if its first call takes longer
than --slow seconds; a call that takes longer than --limit is stopped. Sorting boxes spatially is timed separately.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import sys
import threading
import time
from collections.abc import Callable
from datetime import date
from typing import Any

import dask
import dask.array
import dask_geopandas
import distributed
import duckdb
import geopandas
import numpy as np
import pyarrow
import shapely

import broadside
import broadside.dask
from rounds import keys, scattered, seconds

COLUMNS = ("xmin", "ymin", "xmax", "ymax")


class Stopped(Exception):
    """A call that exceeded the time limit."""


def within(client: distributed.Client, collection: Any, limit: float) -> Any:
    future = client.compute(collection)
    try:
        return future.result(timeout=limit)
    except (TimeoutError, distributed.TimeoutError) as error:
        future.cancel()
        raise Stopped from error


def columns_of(frame: Any, first: str, second: str) -> np.ndarray:
    return np.column_stack([frame[first].to_numpy(), frame[second].to_numpy()])


def geo_frame(boxes: np.ndarray, row: str, chunks: int) -> Any:
    frame = geopandas.GeoDataFrame({row: np.arange(len(boxes))}, geometry=shapely.box(*boxes.T))
    return dask_geopandas.from_geopandas(frame, npartitions=chunks)


def joined(client: distributed.Client, left: Any, right: Any, limit: float) -> np.ndarray:
    frame = dask_geopandas.sjoin(left, right, predicate="intersects")[["i", "j"]]
    return columns_of(within(client, frame, limit), "i", "j")


def searches_of(
    client: distributed.Client, left: np.ndarray, right: np.ndarray, options: argparse.Namespace
) -> tuple[dict[str, Callable[[], np.ndarray]], float]:
    """The searches by name, and the seconds for sorting the boxes spatially."""
    rows = (len(left) + options.chunks - 1) // options.chunks
    arrays = [dask.array.from_array(boxes, chunks=(rows, 4)).persist() for boxes in (left, right)]
    frames = [geo_frame(boxes, row, options.chunks).persist() for boxes, row in ((left, "i"), (right, "j"))]
    distributed.wait([*arrays, *frames])

    def put_in_order() -> list[Any]:
        # By tasks: the alternative ("p2p") waits forever for frames that the cluster already holds.
        with dask.config.set({"dataframe.shuffle.method": "tasks"}):
            ordered = [frame.spatial_shuffle(npartitions=options.chunks).persist() for frame in frames]
        distributed.wait(ordered)
        return ordered

    order_seconds, ordered = seconds(put_in_order)
    connection = duckdb.connect(config={"threads": options.workers})
    for name, boxes in (("l_boxes", left), ("r_boxes", right)):
        table = pyarrow.table({"id": np.arange(len(boxes))} | dict(zip(COLUMNS, boxes.T)))
        connection.register("arrow", table)
        connection.execute(f"create table {name} as select * from arrow")

    def by_duckdb() -> np.ndarray:
        stop = threading.Timer(options.limit, connection.interrupt)
        stop.start()
        try:
            found = connection.execute(
                "select l.id as i, r.id as j from l_boxes l join r_boxes r on "
                "l.xmin <= r.xmax and r.xmin <= l.xmax and l.ymin <= r.ymax and r.ymin <= l.ymax"
            ).fetchnumpy()
        except duckdb.InterruptException as error:
            raise Stopped from error
        finally:
            stop.cancel()
        return np.column_stack([found["i"], found["j"]])

    def by_dask(sets: list[Any], sort: bool = False) -> np.ndarray:
        return columns_of(within(client, broadside.dask.pairs(*sets, sort=sort), options.limit), "first", "second")

    return {
        "broadside.dask, arrays": lambda: by_dask(arrays),
        "the same, sorted": lambda: by_dask(arrays, sort=True),
        "broadside.dask, GeoDataFrames": lambda: by_dask(frames),
        "dask-geopandas": lambda: joined(client, *frames, options.limit),
        "dask-geopandas, in spatial order": lambda: joined(client, *ordered, options.limit),
        "DuckDB": by_duckdb,
        "broadside.pairs, without Dask": lambda: broadside.pairs(left, right, threads=options.workers),
    }, order_seconds


def compare(client: distributed.Client, n: int, options: argparse.Namespace) -> list[str]:
    left, right = scattered(n, 2, 1), scattered(n, 2, 2)
    expected = keys(broadside.pairs(left, right), False)
    searches, order_seconds = searches_of(client, left, right, options)
    times: dict[str, list[float]] = {name: [] for name in searches}
    notes: dict[str, str] = {}
    for turn in range(options.rounds + 1):
        for name, search in searches.items():
            if name in notes:
                continue
            try:
                taken, rows = seconds(search)
            except Stopped:
                notes[name] = f"stopped after {options.limit:,.0f} s"
                continue
            if not np.array_equal(keys(rows, False), expected):
                notes[name] = f"wrong: {len(rows):,} pairs, {len(expected):,} expected"
            elif turn > 0 or taken > options.slow:  # the first call warms up
                times[name].append(taken)
                if turn == 0:
                    notes[name] = "one call"
    base = statistics.median(times["broadside.dask, arrays"])
    lines = []
    for name in searches:
        if times[name]:
            # Ratios within the same round, if there are several rounds.
            pairs = zip(times[name], times["broadside.dask, arrays"]) if name not in notes else [(times[name][0], base)]
            ratio = statistics.median(one / other for one, other in pairs)
            lines.append(f"| {n:,} | {name} | {statistics.median(times[name]):,.3f} | {ratio:,.2f} | {notes.get(name, '')} |")
        else:
            lines.append(f"| {n:,} | {name} | | | {notes[name]} |")
    return [*lines, f"| {n:,} | spatial order of both, by dask-geopandas | {order_seconds:,.3f} | {order_seconds / base:,.2f} | once |"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--boxes", default="100000,1000000", help="of each of the two sets")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--chunks", type=int, default=8)
    parser.add_argument("--slow", type=float, default=8)
    parser.add_argument("--limit", type=float, default=60)
    options = parser.parse_args()
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, Dask {dask.__version__}, "
          f"dask-geopandas {dask_geopandas.__version__}, DuckDB {duckdb.__version__}, Broadside {broadside.__version__}, "
          f"{date.today()}; `{' '.join(sys.argv)}`\n")
    print("| boxes, two sets of | library | seconds | times broadside.dask | |\n|---:|---|---:|---:|---|", flush=True)
    # The default memory limit is the machine's share; nothing here comes near it.
    with distributed.LocalCluster(n_workers=options.workers, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            for n in map(int, options.boxes.split(",")):
                began = time.perf_counter()
                print("\n".join(compare(client, n, options)), flush=True)
                print(f"{n:,}: {time.perf_counter() - began:,.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()

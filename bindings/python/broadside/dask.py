"""Pairs of boxes that Dask holds: on the threads of one machine or the workers of a cluster.

Import it by name, ``import broadside.dask``; it needs Dask (``pip install "broadside[dask]"``).
"""

from __future__ import annotations

import math
from importlib import import_module
from typing import Any, Literal

import numpy as np

from broadside import _arguments, _convert
from broadside._columns import Columns
from broadside._errors import InvalidBoxError
from broadside._pairs import count
from broadside._partition import Partition

try:
    dask = import_module("dask")
    dask_frame = import_module("dask.dataframe")
    dask_delayed = import_module("dask.delayed")
except ImportError as _error:
    raise ImportError(f'broadside.dask: {_error}; expected Dask: pip install "broadside[dask]"') from _error

from broadside import _dask_tasks as work
from broadside._dask_chunks import ChunkedSet, Key, Tasks, chunked_set
from broadside._dask_tasks import Look, LookOptions, Plan, Side

__all__ = ["pairs"]

# How many boxes the cuts are made from: of all, for each part, and at least of each chunk.
_SAMPLE, _SAMPLE_OF_PART, _SAMPLE_OF_CHUNK = 2**15, 128, 256

# With more links between chunks and parts, pieces are routed through groups: 2 n sqrt(n) tasks instead of n * n.
_MOST_DIRECT_LINKS = 2**14


@_arguments.suggests
def pairs(
    boxes: Any,
    other: Any = None,
    *,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
    ids: Literal["row", "index"] = "row",
    parts: int | None = None,
    sort: bool = False,
    algorithm: str = "auto",
    threads: int | None = 1,
    quarantine: bool = False,
) -> Any:
    """Every pair of overlapping boxes, once, as a Dask DataFrame; boxes are closed, so boxes that touch overlap.

    Space is cut into parts of about equal cost. Each part is given the boxes that touch it and joined by one task,
    which reports the pairs that belong to the part. No part needs another part: when a worker dies, only what it held
    is computed again. The pairs are those of ``broadside.pairs``, whatever the chunks, parts and workers.

    Args:
        boxes: n boxes in chunks, in 2D or 3D. A Dask array of shape (n, 4) or (n, 6), minima first. A Dask DataFrame, as
            ``dask.dataframe.read_parquet`` gives it, with columns xmin, ymin, xmax, ymax, in 3D zmin and zmax as well, or
            others that ``broadside.pairs`` knows; only these are read. A GeoDataFrame or GeoSeries of dask-geopandas: the
            bounds of its geometries. A list of chunks: delayed objects, DataFrames, GeoDataFrames, GeoSeries and arrays.
            Whatever else ``broadside.pairs`` takes is cut into chunks and travels with the tasks.
        other: A second set, of the same dimension. Then only pairs of a box of `boxes` and a box of `other` are found.
        columns: The names of the frames' columns of bounds, or a layout such as "xywh": see ``broadside.pairs``.
        other_columns: Likewise of `other`.
        ids: How the result names a box: ``"row"``, its row number counted over all chunks; or ``"index"``, its label in
            the index of its frame. Labels need not be unique.
        parts: The number of parts; by default as many as both sets have chunks. There are fewer if no cut separates the
            boxes.
        sort: Sort all pairs, by row numbers. The result then has a partition for each chunk of `boxes`, in their order,
            with the pairs whose first box is in the chunk. Otherwise it has one for each part.
        algorithm: A spec: see `algorithms`. Each part is joined by it.
        threads: The maximum number of threads of one task; None: all cores. 1 suits workers that run a task on each
            core. If the spec gives a number of threads, this must be None.
        quarantine: Leave invalid boxes out instead of raising.

    Returns:
        A Dask DataFrame with the columns ``first`` and ``second``: int64, or of the index's dtype. Nothing is joined
        until it is computed or written: ``.compute()``, ``.to_parquet(folder)``. In one set, the first box has the
        lower row number; of two sets, it is a box of `boxes`.

    Raises:
        InvalidBoxError: A box has a NaN or a minimum greater than its maximum. ``row`` is its row number over all chunks,
            and the text says which chunk it is in.
        InvalidAlgorithmError: As ``broadside.pairs`` does.
        TypeError, ValueError: As ``broadside.pairs`` does; the text names the chunk. When the result is computed,
            ValueError if a chunk then has another number of boxes, or boxes in parts where it had none.

    The call computes all chunks once, to check the boxes and to make the cuts from a sample of some ten thousand. The
    result computes them again. If chunks are costly to compute, ``boxes.persist()`` saves that. Both use Dask's default
    scheduler, such as a ``distributed.Client``. Unlike ``broadside.pairs``, it takes no filters and no ignored pairs.

    Cost: a task has one chunk, or one part's boxes and pairs, in memory. Dask's workers keep the data between tasks, as
    much as all boxes and pairs, and spill it to disk. There are about ``chunks * parts`` tasks, or fewer if chunks lie
    apart in space. If there would be more than 16384, there are about ``chunks * sqrt(parts) + parts * sqrt(chunks)``.
    """
    sets = [chunked_set(boxes, "boxes", columns, ids)]
    if other is not None:
        _convert.common_crs(_convert.crs_of(boxes), "boxes", other, "other")
        sets.append(chunked_set(other, "other", other_columns, ids))
    elif other_columns is not None:
        raise ValueError("other_columns are given without other boxes; expected both or neither")
    if ids not in ("row", "index"):
        raise ValueError(f"ids is {ids!r}; expected 'row' or 'index'")
    if sort and ids == "index":
        raise ValueError("sort is true and ids is 'index'; expected ids of 'row', which pairs are sorted by")
    chunks = sum(len(one.chunks) for one in sets)
    wanted = max(chunks, 1) if parts is None else _arguments.integer(parts, "parts", 1, 2**31 - 2)
    count(np.empty((0, 4)), algorithm=algorithm, threads=threads)  # refuses what no task could do

    looks = _look_at(sets, wanted, quarantine)
    width, dtype = _kind(sets, looks)
    partition = _partition_of(looks, width, dtype, wanted)
    sides = tuple(_side(one, its, ids) for one, its in zip(sets, looks, strict=True))
    sorts, skips = _arguments.truth(sort, "sort"), _arguments.truth(quarantine, "quarantine")
    plan = Plan(partition, sides, width, dtype, algorithm, threads, sorts, skips)
    return _frame(sets, looks, plan)


def _look_at(sets: list[ChunkedSet], parts: int, quarantine: bool) -> list[list[Look]]:
    """Computes all chunks once. Raises InvalidBoxError about the first invalid box, unless it is quarantined."""
    chunks = sum(len(one.chunks) for one in sets)
    most = max(_SAMPLE_OF_CHUNK, math.ceil(max(_SAMPLE, _SAMPLE_OF_PART * parts) / max(chunks, 1)))
    name = f"broadside-look-{dask.base.tokenize([(one.chunks, one.columns, one.has_index) for one in sets], most)}"
    tasks: Tasks = {}
    keys: list[list[Key]] = []
    for side, one in enumerate(sets):
        tasks.update(one.tasks)
        keys.append([(name, side, number) for number in range(len(one.chunks))])
        for number, chunk in enumerate(one.chunks):
            options = LookOptions(one.name, number, one.columns, one.has_index, most)
            tasks[name, side, number] = (work.look, chunk, options)
    tasks[name] = (_as_lists, keys)
    (looks,) = dask.compute(dask_delayed.Delayed(name, tasks))
    for one, its in zip(sets, looks, strict=True):
        rows = 0
        for number, look in enumerate(its):
            if look.fault is not None and not quarantine:
                row, fault = look.fault
                text = f"box {rows + row} of {one.name}, row {row} of chunk {number}, has {fault}"
                raise InvalidBoxError(text, rows + row, one.name)
            rows += look.rows
    found: list[list[Look]] = looks
    return found


def _as_lists(lists: list[list[Look]]) -> list[list[Look]]:
    return lists


def _kind(sets: list[ChunkedSet], looks: list[list[Look]]) -> tuple[int, np.dtype[Any]]:
    """How many columns all boxes have, and their dtype. Float64 holds all float32."""
    all_looks = [(one.name, number, look) for one, its in zip(sets, looks, strict=True) for number, look in enumerate(its)]
    if not all_looks:
        return 4, np.dtype(np.float32)
    first_name, first_number, first = all_looks[0]
    for name, number, look in all_looks:
        if look.width != first.width:
            raise ValueError(
                f"chunk {first_number} of {first_name} is in {first.width // 2}D and chunk {number} of {name} in "
                f"{look.width // 2}D; expected boxes of the same dimension"
            )
    return first.width, np.result_type(*(look.dtype for _, _, look in all_looks))


def _partition_of(looks: list[list[Look]], width: int, dtype: np.dtype[Any], parts: int) -> Partition:
    """From a sample in which chunks count by their boxes, however many were drawn of each."""
    present = [look for its in looks for look in its if look.present]
    if not present:
        return Partition(np.empty((0, width), dtype), 1)
    rate = min(len(look.sample) / look.present for look in present)
    sample = np.concatenate([look.sample[: math.ceil(rate * look.present)] for look in present])
    return Partition(sample.astype(dtype, copy=False), parts, boxes=sum(look.present for look in present))


def _side(one: ChunkedSet, looks: list[Look], ids: str) -> Side:
    starts = (0, *np.cumsum([look.rows for look in looks], dtype=np.int64).tolist())
    if ids == "row":
        return Side(one.name, one.columns, starts, None)
    dtypes = {number: look.index for number, look in enumerate(looks) if look.rows}
    first = next(iter(dtypes.items()), (0, np.dtype(np.int64)))
    for number, dtype in dtypes.items():
        if dtype != first[1]:
            raise TypeError(
                f"the index of chunk {first[0]} of {one.name} has dtype {first[1]} and that of chunk {number} {dtype}; expected "
                "one dtype, since ids is 'index'"
            )
    return Side(one.name, one.columns, starts, first[1])


def _frame(sets: list[ChunkedSet], looks: list[list[Look]], plan: Plan) -> Any:
    token = dask.base.tokenize([one.chunks for one in sets], looks, plan)
    names = {name: f"broadside-{name}-{token}" for name in ("plan", "split", "piece", "join", "run", "sort")}
    tasks: Tasks = {names["plan"]: plan}
    pieces: list[dict[int, list[Key]]] = []
    links_of_first: list[tuple[int, int]] = []
    for side, (one, its) in enumerate(zip(sets, looks, strict=True)):
        tasks.update(one.tasks)
        links = _links(plan, its)
        if side == 0:
            links_of_first = links
        splits = _add_splits(tasks, names["split"], names["plan"], one, side, links)
        pieces.append(_add_routes(tasks, f"{names['piece']}-{side}", splits, links))
    parts = range(len(plan.partition))
    for part in parts:
        tasks[names["join"], part] = (work.join, names["plan"], part, [its.get(part, []) for its in pieces])
    keys = [(names["join"], part) for part in parts]
    if plan.sort:
        runs = _add_routes(tasks, names["run"], dict(enumerate(keys)), sorted((part, chunk) for chunk, part in links_of_first))
        keys = [(names["sort"], chunk) for chunk in range(max(len(sets[0].chunks), 1))]
        for chunk, key in enumerate(keys):
            tasks[key] = (work.sort, names["plan"], runs.get(chunk, []))
    empty = work.as_frame(plan, *(side.labels(np.empty(0, np.int64)).to_numpy() for side in (plan.sides[0], plan.sides[-1])))
    return dask_frame.from_graph(tasks, empty, (None,) * (len(keys) + 1), keys, "broadside-pairs")


def _links(plan: Plan, looks: list[Look]) -> list[tuple[int, int]]:
    """The chunks, each with the parts that its bounds touch: others get nothing of it."""
    there = [number for number, look in enumerate(looks) if look.present]
    if not there:
        return []
    bounds = np.concatenate([looks[number].bounds for number in there]).astype(plan.dtype, copy=False)
    start, row = plan.partition.assign(bounds)
    part = np.repeat(np.arange(len(plan.partition)), np.diff(start))
    return sorted(zip(np.array(there)[row].tolist(), part.tolist(), strict=True))


def _add_splits(tasks: Tasks, name: str, plan: Key, one: ChunkedSet, side: int, links: list[tuple[int, int]]) -> dict[int, Key]:
    touched: dict[int, list[int]] = {}
    for chunk, part in links:
        touched.setdefault(chunk, []).append(part)
    for chunk, parts in touched.items():
        tasks[name, side, chunk] = (work.split, one.chunks[chunk], plan, side, chunk, np.array(parts))
    return {chunk: (name, side, chunk) for chunk in touched}


def _add_routes(tasks: Tasks, name: str, sources: dict[int, Key], links: list[tuple[int, int]]) -> dict[int, list[Key]]:
    """Tasks that take from each source what it has for each target; the keys that each target gets, in order of sources.

    Very many links go from each source to groups of targets, are merged for batches of sources, and go on from there.
    """
    ends: dict[int, list[Key]] = {}
    if len(links) <= _MOST_DIRECT_LINKS:
        for source, target in links:
            tasks[name, source, target] = (work.take, sources[source], target, target + 1)
            ends.setdefault(target, []).append((name, source, target))
        return ends
    source_count, target_count = (1 + max(numbers) for numbers in zip(*links, strict=True))
    batch, group = math.isqrt(source_count), math.isqrt(target_count)
    merged: dict[tuple[int, int], list[Key]] = {}
    for source, there in sorted({(source, target // group) for source, target in links}):
        tasks[f"{name}-group", source, there] = (work.take, sources[source], there * group, min((there + 1) * group, target_count))
        merged.setdefault((source // batch, there), []).append((f"{name}-group", source, there))
    for (some, there), keys in merged.items():
        tasks[f"{name}-batch", some, there] = (work.merge, keys)
    for some, target in sorted({(source // batch, target) for source, target in links}):
        tasks[name, some, target] = (work.take, (f"{name}-batch", some, target // group), target, target + 1)
        ends.setdefault(target, []).append((name, some, target))
    return ends

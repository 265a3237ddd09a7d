"""Pairs of boxes that Dask holds: on the threads of one machine or the workers of a cluster.

Import it by name, ``import broadside.dask``; it needs Dask (``pip install "broadside[dask]"``).
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from broadside import _arguments, _convert, _core
from broadside._errors import InvalidBoxError
from broadside._pairs import count, invalid_rows
from broadside._partition import Partition

try:
    dask = import_module("dask")
    pandas = import_module("pandas")
    dask_array = import_module("dask.array")
    dask_frame = import_module("dask.dataframe")
    dask_delayed = import_module("dask.delayed")
except ImportError as error:
    raise ImportError(f'broadside.dask: {error}; expected Dask: pip install "broadside[dask]"') from error

__all__ = ["pairs"]

Rows = NDArray[Any]
Key = Any  # of a task: a str, or a tuple that begins with one
Tasks = dict[Key, Any]

# Boxes in memory are cut into chunks of so many rows.
_ROWS_OF_CHUNK = 2**17

# How many boxes the cuts are made from: of all, for each part, and at least of each chunk.
_SAMPLE, _SAMPLE_OF_PART, _SAMPLE_OF_CHUNK = 2**15, 128, 256

# Above so many links of chunks and parts they go by way of groups of both: 2 n sqrt(n) tasks instead of n * n.
_MOST_DIRECT_LINKS = 2**14


def pairs(
    boxes: Any,
    other: Any = None,
    *,
    columns: Sequence[str] | None = None,
    other_columns: Sequence[str] | None = None,
    ids: Literal["row", "index"] = "row",
    parts: int | None = None,
    sort: bool = False,
    algorithm: str = "auto",
    threads: int | None = 1,
    quarantine: bool = False,
) -> Any:
    """Every pair of overlapping boxes, once, as a Dask DataFrame; boxes are closed, so boxes that touch overlap.

    Space is cut into parts of about equal cost. Each part is given the boxes that touch it and joined by one task, which
    reports the pairs that belong to the part. No part needs another one: when a worker dies, what it held is computed
    again, and nothing else. The pairs are those of ``broadside.pairs``, whatever the chunks, parts and workers.

    Args:
        boxes: n boxes in chunks, in 2D or 3D. A Dask array of shape (n, 4) or (n, 6), minima first. A Dask DataFrame, as
            ``dask.dataframe.read_parquet`` gives it, with columns xmin, ymin, xmax, ymax, in 3D zmin and zmax as well, or
            others that ``broadside.pairs`` knows; only these are read. A GeoDataFrame or GeoSeries of dask-geopandas: the
            bounds of its geometries. A list of chunks: delayed objects, DataFrames, GeoDataFrames, GeoSeries and arrays.
            Whatever else ``broadside.pairs`` takes is cut into chunks and travels with the tasks.
        other: A second set, of the same dimension. Then only pairs of a box of `boxes` and a box of `other` are found.
        columns: Of frames: the names of the columns of bounds, minima first, where they are others.
        other_columns: Likewise of `other`.
        ids: What a box is called: ``"row"``, its row number counted over all chunks; or ``"index"``, its label in the
            index of its frame. Labels need not be unique.
        parts: How many parts; by default as many as both sets have chunks. There are fewer where no cut tells boxes
            apart.
        sort: Sort all pairs, by row numbers. The result then has a partition for each chunk of `boxes`, in their order,
            with the pairs whose first box is in the chunk. Otherwise it has one for each part.
        algorithm: A spec: see `algorithms`. Each part is joined by it.
        threads: The most threads of one task; None: all cores. 1 suits workers that run a task on each core. A spec that
            says how many threads needs None here.
        quarantine: Leave invalid boxes out instead of raising.

    Returns:
        A Dask DataFrame with the columns ``first`` and ``second``: int64, or of the index's dtype. Nothing is joined
        until it is computed or written: ``.compute()``, ``.to_parquet(folder)``. Of one set the first box has the lesser
        row number; of two sets it is one of `boxes`.

    Raises:
        InvalidBoxError: A box has a NaN or a minimum greater than its maximum. ``row`` is its row number over all chunks,
            and the text says which chunk it is in.
        InvalidAlgorithmError: As ``broadside.pairs`` does.
        TypeError, ValueError: As ``broadside.pairs`` does; the text names the chunk. When the result is computed,
            ValueError if a chunk then has another number of boxes, or boxes in parts where it had none.

    The call computes all chunks once, to check the boxes and to make the cuts from a sample of some ten thousand; the
    result computes them again. ``boxes.persist()`` saves that where they are costly. Both use Dask's default scheduler,
    such as a ``distributed.Client``. Filters and ignored pairs, which ``broadside.pairs`` takes, are not taken.

    Cost: a task has one chunk, or one part's boxes and pairs, in memory. What waits between tasks, as much as all boxes
    and pairs, is kept by Dask's workers, which spill it to disk. There are about ``chunks * parts`` tasks, fewer where
    chunks lie apart in space, and where there would be more than 16384, about ``chunks * sqrt(parts) + parts *
    sqrt(chunks)``.
    """
    sets = [_set_of(boxes, "boxes", columns, ids)]
    if other is not None:
        sets.append(_set_of(other, "other", other_columns, ids))
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
    plan = _Plan(partition, sides, width, dtype, algorithm, threads, bool(sort), bool(quarantine))
    return _frame(sets, looks, plan)


# What a chunk is, and what it holds


@dataclass(frozen=True)
class _Set:
    """One set of boxes as chunks that tasks make."""

    name: str
    columns: tuple[str, ...] | None
    has_index: bool  # whether the index is asked for
    tasks: Tasks
    chunks: list[Key]


class _Look(NamedTuple):
    """What is known of a chunk before anything is joined."""

    rows: int
    width: int
    dtype: np.dtype[Any]
    present: int
    bounds: Rows  # one box around all, or none where no box is present
    sample: Rows  # in random order
    index: Any  # the dtype of the index, where it is asked for
    fault: tuple[int, str] | None  # the first invalid row and what is wrong with it


def _set_of(found: Any, name: str, columns: Sequence[str] | None, ids: str) -> _Set:
    if isinstance(columns, str) or (columns is not None and not all(isinstance(column, str) for column in columns)):
        raise TypeError(f"the columns of {name} are {columns!r}; expected a list of names")
    if columns is not None and len(columns) not in (4, 6):
        raise ValueError(f"the columns of {name} are {len(columns)}; expected 4 or 6: the minima, then the maxima")
    names = None if columns is None else tuple(columns)
    tasks, chunks = _chunks_of(found, name, names)
    return _Set(name, names, ids == "index", tasks, chunks)


def _chunks_of(found: Any, name: str, columns: tuple[str, ...] | None) -> tuple[Tasks, list[Key]]:
    """Tasks that make the chunks, and their keys."""
    if isinstance(found, dask_array.Array):
        if found.ndim != 2 or found.shape[1] not in (4, 6):
            raise ValueError(
                f"{name} has shape {found.shape}; expected (n, 4) or (n, 6): the minima of each box, then its maxima"
            )
        array = found.rechunk({1: -1})
        tasks, keys = _tasks_of(array.to_delayed().ravel())
        return tasks | _futures_in(array.__dask_graph__()), keys
    if isinstance(found, (dask_frame.DataFrame, dask_frame.Series)):
        return _tasks_of(_bounds_of(found, name, columns).to_delayed())
    if isinstance(found, dask_delayed.Delayed):
        return _tasks_of([found])
    if dask.is_dask_collection(found):
        raise TypeError(f"{name} is of {type(found).__name__}; expected a Dask array, a Dask DataFrame or delayed objects")
    if _convert.is_empty_sequence(found):
        return {}, []
    if isinstance(found, (list, tuple)) and all(map(_is_chunk, found)):
        tasks, keys = _tasks_of(chunk for chunk in found if isinstance(chunk, dask_delayed.Delayed))
        of_delayed = iter(keys)
        return _with_data(tasks, [next(of_delayed) if isinstance(chunk, dask_delayed.Delayed) else [chunk] for chunk in found])
    if isinstance(found, (pandas.DataFrame, pandas.Series)):
        cut = [found.iloc[row : row + _ROWS_OF_CHUNK] for row in range(0, max(len(found), 1), _ROWS_OF_CHUNK)]
    else:
        array = _convert.boxes(found, name)
        cut = [array[row : row + _ROWS_OF_CHUNK] for row in range(0, max(len(array), 1), _ROWS_OF_CHUNK)]
    return _with_data({}, [[chunk] for chunk in cut])


def _is_chunk(found: Any) -> bool:
    """Whether an element of a list is a chunk of boxes, not a box."""
    is_frame = isinstance(found, (dask_delayed.Delayed, pandas.DataFrame, pandas.Series))
    return is_frame or (isinstance(found, np.ndarray) and found.ndim == 2)


def _bounds_of(frame: Any, name: str, columns: tuple[str, ...] | None) -> Any:
    """What the bounds are computed from, so that no other columns are read."""
    if columns is not None:
        missing = [column for column in columns if column not in frame.columns]
        if missing:
            raise ValueError(
                f"{name} has the columns {', '.join(map(str, frame.columns)) or 'none'}; expected {', '.join(missing)} as well"
            )
        return frame[list(columns)]
    geometry = getattr(frame._meta, "geometry", None)
    if str(getattr(geometry, "dtype", "")) == "geometry":
        return frame.geometry
    if isinstance(frame, dask_frame.Series):
        raise TypeError(f"{name} is a Series of {frame.dtype}; expected a DataFrame of bounds, or geometries")
    by_text = {str(column): column for column in frame.columns}
    return frame[[by_text[column] for column in _convert.columns_of_bounds(by_text, name)]]


def _tasks_of(delayed: Iterable[Any]) -> tuple[Tasks, list[Key]]:
    chunks = list(delayed)
    graphs = {id(graph): graph for graph in (chunk.dask for chunk in chunks)}  # those of a collection share one
    tasks: Tasks = {}
    for graph in graphs.values():
        tasks.update(dict(graph))
    keys = [chunk.key for chunk in chunks]
    for key in keys:
        tasks.setdefault(key, key)  # one without a task is known to the cluster, which holds it already
    return tasks, keys


def _futures_in(graph: Any) -> Tasks:
    """What a cluster has computed already, which Dask leaves out when it optimises the graph of an array."""
    distributed = sys.modules.get("distributed")
    if distributed is None:
        return {}
    return {key: task for key, task in dict(graph).items() if isinstance(task, distributed.Future)}


def _with_data(tasks: Tasks, chunks: Iterable[Any]) -> tuple[Tasks, list[Key]]:
    """Keys of chunks, of which those in a list are data that have none yet."""
    keys: list[Key] = []
    for chunk in chunks:
        if isinstance(chunk, list):
            key = f"broadside-chunk-{dask.base.tokenize(chunk[0])}"
            tasks[key] = chunk[0]
            keys.append(key)
        else:
            keys.append(chunk)
    return tasks, keys


def _rows_of(chunk: Any, columns: tuple[str, ...] | None, where: str) -> Rows:
    """The boxes of a chunk as an array."""
    if columns is None:
        return _convert.boxes(chunk, where)
    if not isinstance(chunk, pandas.DataFrame):
        raise TypeError(f"{where} is of {type(chunk).__name__}; expected a DataFrame, since columns are given")
    missing = [column for column in columns if column not in chunk.columns]
    if missing:
        raise ValueError(f"{where} has the columns {', '.join(map(str, chunk.columns))}; expected {', '.join(missing)} as well")
    return _convert.boxes(np.column_stack([chunk[column].to_numpy() for column in columns]), where)


def _index_of(chunk: Any, where: str) -> Any:
    if not isinstance(chunk, (pandas.DataFrame, pandas.Series)):
        raise TypeError(f"{where} is of {type(chunk).__name__}; expected a DataFrame, since ids is 'index'")
    if chunk.index.nlevels > 1:
        raise TypeError(f"{where} has an index of {chunk.index.nlevels} levels; expected one level, since ids is 'index'")
    return chunk.index


# Before the join: all chunks are looked at, and space is cut


def _look_at(sets: list[_Set], parts: int, quarantine: bool) -> list[list[_Look]]:
    """Computes all chunks once. Raises InvalidBoxError about the first invalid box, unless it is quarantined."""
    chunks = sum(len(one.chunks) for one in sets)
    most = max(_SAMPLE_OF_CHUNK, math.ceil(max(_SAMPLE, _SAMPLE_OF_PART * parts) / max(chunks, 1)))
    name = f"broadside-look-{dask.base.tokenize([one.chunks for one in sets])}"
    tasks: Tasks = {}
    keys: list[list[Key]] = []
    for side, one in enumerate(sets):
        tasks.update(one.tasks)
        keys.append([(name, side, number) for number in range(len(one.chunks))])
        for number, chunk in enumerate(one.chunks):
            options = _Options(one.name, number, one.columns, one.has_index, most)
            tasks[name, side, number] = (_look, chunk, options)
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
    found: list[list[_Look]] = looks
    return found


@dataclass(frozen=True)
class _Options:
    """How a chunk is looked at."""

    name: str
    number: int
    columns: tuple[str, ...] | None
    has_index: bool
    most_sampled: int


def _as_lists(lists: list[list[_Look]]) -> list[list[_Look]]:
    return lists


def _look(chunk: Any, options: _Options) -> _Look:
    where = f"chunk {options.number} of {options.name}"
    rows = _rows_of(chunk, options.columns, where)
    half = rows.shape[1] // 2
    present = rows[(rows[:, :half] <= rows[:, half:]).all(axis=1)]
    if len(present):
        bounds = np.concatenate([present[:, :half].min(axis=0), present[:, half:].max(axis=0)])[None, :]
    else:
        bounds = present
    rng = np.random.default_rng(options.number)
    sample = present[rng.choice(len(present), min(options.most_sampled, len(present)), replace=False)]
    index = _index_of(chunk, where).dtype if options.has_index else None
    return _Look(len(rows), rows.shape[1], rows.dtype, len(present), bounds, sample, index, _fault_of(rows))


def _fault_of(rows: Rows) -> tuple[int, str] | None:
    invalid = invalid_rows(rows)
    if not invalid.size:
        return None
    row = int(invalid[0])
    try:
        count(rows[row : row + 1])
    except InvalidBoxError as error:
        return row, str(error).partition(" has ")[2]
    raise AssertionError(f"row {row} is invalid and was not refused")


def _kind(sets: list[_Set], looks: list[list[_Look]]) -> tuple[int, np.dtype[Any]]:
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


def _partition_of(looks: list[list[_Look]], width: int, dtype: np.dtype[Any], parts: int) -> Partition:
    """From a sample in which chunks count by their boxes, however many were drawn of each."""
    present = [look for its in looks for look in its if look.present]
    if not present:
        return Partition(np.empty((0, width), dtype), 1)
    rate = min(len(look.sample) / look.present for look in present)
    sample = np.concatenate([look.sample[: math.ceil(rate * look.present)] for look in present])
    return Partition(sample.astype(dtype, copy=False), parts, boxes=sum(look.present for look in present))


# The join: what tasks do


@dataclass(frozen=True)
class _Side:
    """What tasks know of a set of boxes."""

    name: str
    columns: tuple[str, ...] | None
    starts: tuple[int, ...]  # the first row of each chunk, and the number of rows
    index: Any  # the dtype of its index; None where boxes are called by rows

    def ids_of(self, chunk: Any, number: int) -> NDArray[Any]:
        where = f"chunk {number} of {self.name}"
        if self.index is not None:
            ids: NDArray[Any] = _index_of(chunk, where).to_numpy()
            return ids
        return np.arange(self.starts[number], self.starts[number + 1], dtype=np.int64)

    def labels(self, ids: NDArray[Any]) -> Any:
        return pandas.Index(ids, dtype=np.int64 if self.index is None else self.index)


@dataclass(frozen=True)
class _Plan:
    """What all tasks share."""

    partition: Partition
    sides: tuple[_Side, ...]
    width: int
    dtype: np.dtype[Any]
    algorithm: str
    threads: int | None
    sort: bool
    quarantine: bool


def _side(one: _Set, looks: list[_Look], ids: str) -> _Side:
    starts = (0, *np.cumsum([look.rows for look in looks], dtype=np.int64).tolist())
    if ids == "row":
        return _Side(one.name, one.columns, starts, None)
    dtypes = {number: look.index for number, look in enumerate(looks) if look.rows}
    first = next(iter(dtypes.items()), (0, np.dtype(np.int64)))
    for number, dtype in dtypes.items():
        if dtype != first[1]:
            raise TypeError(
                f"the index of chunk {first[0]} of {one.name} is of {first[1]} and that of chunk {number} of {dtype}; expected "
                "one dtype, since ids is 'index'"
            )
    return _Side(one.name, one.columns, starts, first[1])


class _Pieces(NamedTuple):
    """Arrays of equal length, cut for targets that follow each other: the parts of space or, later, the chunks."""

    target: int  # the first
    start: NDArray[np.int64]  # where each target's begin, and the end
    arrays: tuple[NDArray[Any], ...]


def _take(pieces: _Pieces, begin: int, end: int) -> _Pieces:
    """What the targets from `begin` to `end` get: a copy, which does not keep the rest alive."""
    start = pieces.start[begin - pieces.target : end - pieces.target + 1]
    arrays = tuple(array[start[0] : start[-1]].copy() for array in pieces.arrays)
    return _Pieces(begin, start - start[0], arrays)


def _merge(several: list[_Pieces]) -> _Pieces:
    """For each target what all have for it, in their order."""
    lengths = np.array([np.diff(pieces.start) for pieces in several])
    start = np.concatenate([[0], np.cumsum(lengths.sum(axis=0))])
    targets = range(lengths.shape[1])
    arrays = tuple(
        np.concatenate([several[i].arrays[k][several[i].start[t] : several[i].start[t + 1]] for t in targets for i in range(len(several))])
        for k in range(len(several[0].arrays))
    )
    return _Pieces(several[0].target, start, arrays)


def _split(chunk: Any, plan: _Plan, side: int, number: int, touched: NDArray[np.int64]) -> _Pieces:
    """The boxes of a chunk and their ids, by the parts that they touch; a box on a cut several times."""
    this = plan.sides[side]
    where = f"chunk {number} of {this.name}"
    rows = _rows_of(chunk, this.columns, where)
    expected = this.starts[number + 1] - this.starts[number]
    if len(rows) != expected or rows.shape[1] != plan.width:
        raise ValueError(f"{where} has shape {rows.shape}; expected ({expected}, {plan.width}), as it had when it was looked at")
    ids = this.ids_of(chunk, number)
    start, row = plan.partition.assign(rows.astype(plan.dtype, copy=False), quarantine=plan.quarantine)
    if np.diff(start)[touched].sum() != len(row):
        raise ValueError(f"{where} has boxes where it had none when it was looked at; expected the same boxes")
    return _Pieces(0, start, (rows.astype(plan.dtype, copy=False)[row], ids[row]))


def _join(plan: _Plan, part: int, sides: list[list[_Pieces]]) -> Any:
    """The pairs that belong to a part: a frame, or where all are to be sorted, arrays cut by the chunk of the first box."""
    boxes, ids = zip(*(_gathered(plan, side, pieces) for side, pieces in enumerate(sides)), strict=True)
    other = boxes[1] if len(boxes) == 2 else None
    # Ids ascend, so sorted rows are sorted ids.
    rows = plan.partition.pairs(part, boxes[0], other, algorithm=plan.algorithm, sort=plan.sort, threads=plan.threads)
    found = (ids[0][rows[:, 0]], ids[-1][rows[:, 1]])
    if plan.sort:
        return _Pieces(0, np.searchsorted(found[0], plan.sides[0].starts), found)
    return _as_frame(plan, *found)


def _gathered(plan: _Plan, side: int, several: list[_Pieces]) -> tuple[Rows, NDArray[Any]]:
    boxes = np.concatenate([np.empty((0, plan.width), plan.dtype), *(pieces.arrays[0] for pieces in several)])
    if not several:
        return boxes, plan.sides[side].labels(np.empty(0, np.int64)).to_numpy()
    return boxes, np.concatenate([pieces.arrays[1] for pieces in several])


def _sorted(plan: _Plan, several: list[_Pieces]) -> Any:
    """All pairs whose first box is in one chunk."""
    empty = np.empty(0, np.int64)
    first, second = (np.concatenate([empty, *(pieces.arrays[k] for pieces in several)]) for k in (0, 1))
    order = np.lexsort((second, first))
    return _as_frame(plan, first[order], second[order])


def _as_frame(plan: _Plan, first: NDArray[Any], second: NDArray[Any]) -> Any:
    return pandas.DataFrame({"first": plan.sides[0].labels(first), "second": plan.sides[-1].labels(second)})


# The join: which tasks there are


def _frame(sets: list[_Set], looks: list[list[_Look]], plan: _Plan) -> Any:
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
        tasks[names["join"], part] = (_join, names["plan"], part, [its.get(part, []) for its in pieces])
    keys = [(names["join"], part) for part in parts]
    if plan.sort:
        runs = _add_routes(tasks, names["run"], dict(enumerate(keys)), sorted((part, chunk) for chunk, part in links_of_first))
        keys = [(names["sort"], chunk) for chunk in range(max(len(sets[0].chunks), 1))]
        for chunk, key in enumerate(keys):
            tasks[key] = (_sorted, names["plan"], runs.get(chunk, []))
    empty = _as_frame(plan, *(side.labels(np.empty(0, np.int64)).to_numpy() for side in (plan.sides[0], plan.sides[-1])))
    return dask_frame.from_graph(tasks, empty, (None,) * (len(keys) + 1), keys, "broadside-pairs")


def _links(plan: _Plan, looks: list[_Look]) -> list[tuple[int, int]]:
    """The chunks, each with the parts that its bounds touch: others get nothing of it."""
    there = [number for number, look in enumerate(looks) if look.present]
    if not there:
        return []
    bounds = np.concatenate([looks[number].bounds for number in there]).astype(plan.dtype, copy=False)
    start, row = plan.partition.assign(bounds)
    part = np.repeat(np.arange(len(plan.partition)), np.diff(start))
    return sorted(zip(np.array(there)[row].tolist(), part.tolist(), strict=True))


def _add_splits(tasks: Tasks, name: str, plan: Key, one: _Set, side: int, links: list[tuple[int, int]]) -> dict[int, Key]:
    touched: dict[int, list[int]] = {}
    for chunk, part in links:
        touched.setdefault(chunk, []).append(part)
    for chunk, parts in touched.items():
        tasks[name, side, chunk] = (_split, one.chunks[chunk], plan, side, chunk, np.array(parts))
    return {chunk: (name, side, chunk) for chunk in touched}


def _add_routes(tasks: Tasks, name: str, sources: dict[int, Key], links: list[tuple[int, int]]) -> dict[int, list[Key]]:
    """Tasks that take from each source what it has for each target; the keys that each target gets, in order of sources.

    Very many links go from each source to groups of targets, are merged for batches of sources, and go on from there.
    """
    ends: dict[int, list[Key]] = {}
    if len(links) <= _MOST_DIRECT_LINKS:
        for source, target in links:
            tasks[name, source, target] = (_take, sources[source], target, target + 1)
            ends.setdefault(target, []).append((name, source, target))
        return ends
    source_count, target_count = (1 + max(numbers) for numbers in zip(*links, strict=True))
    batch, group = math.isqrt(source_count), math.isqrt(target_count)
    merged: dict[tuple[int, int], list[Key]] = {}
    for source, there in sorted({(source, target // group) for source, target in links}):
        tasks[f"{name}-group", source, there] = (_take, sources[source], there * group, min((there + 1) * group, target_count))
        merged.setdefault((source // batch, there), []).append((f"{name}-group", source, there))
    for (some, there), keys in merged.items():
        tasks[f"{name}-batch", some, there] = (_merge, keys)
    for some, target in sorted({(source // batch, target) for source, target in links}):
        tasks[name, some, target] = (_take, (f"{name}-batch", some, target // group), target, target + 1)
        ends.setdefault(target, []).append((name, some, target))
    return ends

"""The chunks that Dask holds a set of boxes in, for broadside.dask: the tasks that make them."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from broadside import _arguments, _columns, _convert
from broadside._columns import Columns

dask = import_module("dask")
dask_array = import_module("dask.array")
dask_frame = import_module("dask.dataframe")
dask_delayed = import_module("dask.delayed")
pandas = import_module("pandas")

Key = Any  # of a task: a str, or a tuple that begins with one
Tasks = dict[Key, Any]

# Rows of a chunk that boxes in memory are cut into.
ROWS_OF_CHUNK = 2**17


@dataclass(frozen=True)
class ChunkedSet:
    """A set of boxes as chunks that tasks make."""

    name: str
    columns: str | list[str] | None
    has_index: bool  # whether the index is asked for
    tasks: Tasks
    chunks: list[Key]


def chunked_set(found: Any, name: str, columns: Columns | None, ids: str) -> ChunkedSet:
    """The chunks of whatever `pairs` takes. Raises TypeError and ValueError about what tells without computing a chunk."""
    chosen = _columns.checked(columns, name)
    tasks, chunks = _chunks_of(found, name, chosen)
    return ChunkedSet(name, chosen, ids == "index", tasks, chunks)


def _chunks_of(found: Any, name: str, columns: str | list[str] | None) -> tuple[Tasks, list[Key]]:
    """Tasks that make the chunks, and their keys."""
    if isinstance(found, dask_array.Array):
        if found.ndim != 2 or (columns is None and found.shape[1] not in (4, 6)):
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
        raise TypeError(f"{name} is {_arguments.kind_of(found)}; expected a Dask array, a Dask DataFrame or delayed objects")
    if _convert.is_empty_sequence(found):
        return {}, []
    if isinstance(found, (list, tuple)) and all(map(_is_chunk, found)):
        return _tasks_of(found)
    is_kept = isinstance(found, (pandas.DataFrame, pandas.Series)) or (columns is not None and isinstance(found, np.ndarray))
    whole = found if is_kept else _convert.boxes(found, name, columns)
    rows = getattr(whole, "iloc", whole)
    return _tasks_of(rows[row : row + ROWS_OF_CHUNK] for row in range(0, max(len(whole), 1), ROWS_OF_CHUNK))


def _is_chunk(found: Any) -> bool:
    """Whether an element of a list is a chunk of boxes, not a box."""
    is_frame = isinstance(found, (dask_delayed.Delayed, pandas.DataFrame, pandas.Series))
    return is_frame or (isinstance(found, np.ndarray) and found.ndim == 2)


def _bounds_of(frame: Any, name: str, columns: str | list[str] | None) -> Any:
    """What the bounds are computed from, so that no other columns are read."""
    geometry = getattr(frame._meta, "geometry", None)
    if columns is None and str(getattr(geometry, "dtype", "")) == "geometry":
        return frame.geometry
    if isinstance(frame, dask_frame.Series):
        raise TypeError(f"{name} is a Series of {frame.dtype}; expected a DataFrame of bounds, or geometries")
    places = _columns.choose([str(column) for column in frame.columns], name, columns).places
    return frame[[frame.columns[place] for place in places]]


def _tasks_of(found: Iterable[Any]) -> tuple[Tasks, list[Key]]:
    """Of delayed objects, and of data, which become tasks of their own."""
    graphs: dict[int, Any] = {}  # delayed objects of one collection share one
    tasks: Tasks = {}
    keys: list[Key] = []
    for chunk in found:
        if isinstance(chunk, dask_delayed.Delayed):
            graph = chunk.dask
            graphs[id(graph)] = graph
            keys.append(chunk.key)
        else:
            keys.append(f"broadside-chunk-{dask.base.tokenize(chunk)}")
            tasks[keys[-1]] = chunk
    for graph in graphs.values():
        tasks.update(dict(graph))
    for key in keys:
        tasks.setdefault(key, key)  # one without a task is known to the cluster, which holds it already
    return tasks, keys


def _futures_in(graph: Any) -> Tasks:
    """What a cluster has computed already, which Dask leaves out when it optimises the graph of an array."""
    distributed = sys.modules.get("distributed")
    if distributed is None:
        return {}
    return {key: task for key, task in dict(graph).items() if isinstance(task, distributed.Future)}

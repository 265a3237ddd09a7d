"""What the tasks of broadside.dask do: look at a chunk, split it by parts, join a part, sort pairs."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from broadside import _arguments, _convert
from broadside._errors import InvalidBoxError
from broadside._pairs import count, invalid_rows
from broadside._partition import Partition

pandas = import_module("pandas")

Rows = NDArray[Any]


@dataclass(frozen=True)
class LookOptions:
    """How a chunk is looked at."""

    name: str
    number: int
    columns: str | list[str] | None
    has_index: bool
    max_sampled: int


class Look(NamedTuple):
    """What is known of a chunk before anything is joined."""

    rows: int
    width: int
    dtype: np.dtype[Any]
    present: int
    bounds: Rows  # one box around all, or none where no box is present
    sample: Rows  # in random order
    index: Any  # the dtype of the index, where it is asked for
    fault: tuple[int, str] | None  # the first invalid row and what is wrong with it


def look(chunk: Any, options: LookOptions) -> Look:
    """The first task of a chunk, before space is cut."""
    where = f"chunk {options.number} of {options.name}"
    rows = _convert.boxes(chunk, where, options.columns)
    half = rows.shape[1] // 2
    present = rows[(rows[:, :half] <= rows[:, half:]).all(axis=1)]
    if len(present):
        bounds = np.concatenate([present[:, :half].min(axis=0), present[:, half:].max(axis=0)])[None, :]
    else:
        bounds = present
    rng = np.random.default_rng(options.number)
    sample = present[rng.choice(len(present), min(options.max_sampled, len(present)), replace=False)]
    index = _index_of(chunk, where).dtype if options.has_index else None
    return Look(len(rows), rows.shape[1], rows.dtype, len(present), bounds, sample, index, _fault_of(rows))


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


@dataclass(frozen=True)
class Side:
    """What tasks know of a set of boxes."""

    name: str
    columns: str | list[str] | None
    starts: tuple[int, ...]  # the first row of each chunk, and the number of rows
    index: Any  # the dtype of its index; None where boxes are called by rows

    def ids_of(self, chunk: Any, number: int) -> NDArray[Any]:
        """What the boxes of a chunk are called."""
        where = f"chunk {number} of {self.name}"
        if self.index is not None:
            ids: NDArray[Any] = _index_of(chunk, where).to_numpy()
            return ids
        return np.arange(self.starts[number], self.starts[number + 1], dtype=np.int64)

    def labels(self, ids: NDArray[Any]) -> Any:
        """Ids as a pandas Index, which keeps the dtypes that NumPy does not have."""
        return pandas.Index(ids, dtype=np.int64 if self.index is None else self.index)


@dataclass(frozen=True)
class Plan:
    """What all tasks share."""

    partition: Partition
    sides: tuple[Side, ...]
    width: int
    dtype: np.dtype[Any]
    algorithm: str
    threads: int | None
    sort: bool
    quarantine: bool


class Pieces(NamedTuple):
    """Arrays of equal length, cut for targets that follow each other: the parts of space or, later, the chunks."""

    target: int  # the first
    start: NDArray[np.int64]  # where each target's begin, and the end
    arrays: tuple[NDArray[Any], ...]


def take(pieces: Pieces, begin: int, end: int) -> Pieces:
    """What the targets from `begin` to `end` get: a copy, which does not keep the rest alive."""
    start = pieces.start[begin - pieces.target : end - pieces.target + 1]
    arrays = tuple(array[start[0] : start[-1]].copy() for array in pieces.arrays)
    return Pieces(begin, start - start[0], arrays)


def merge(several: list[Pieces]) -> Pieces:
    """For each target what all have for it, in their order."""
    lengths = np.array([np.diff(pieces.start) for pieces in several])
    start = np.concatenate([[0], np.cumsum(lengths.sum(axis=0))])
    targets = range(lengths.shape[1])
    slices = [(pieces, slice(pieces.start[target], pieces.start[target + 1])) for target in targets for pieces in several]
    arrays = tuple(np.concatenate([pieces.arrays[k][rows] for pieces, rows in slices]) for k in range(len(several[0].arrays)))
    return Pieces(several[0].target, start, arrays)


def split(chunk: Any, plan: Plan, side: int, number: int, touched: NDArray[np.int64]) -> Pieces:
    """The boxes of a chunk and their ids, by the parts that they touch; a box on a cut several times."""
    this = plan.sides[side]
    where = f"chunk {number} of {this.name}"
    rows = _convert.boxes(chunk, where, this.columns).astype(plan.dtype, copy=False)
    expected = this.starts[number + 1] - this.starts[number]
    if len(rows) != expected or rows.shape[1] != plan.width:
        raise ValueError(f"{where} has shape {rows.shape}; expected ({expected}, {plan.width}), as it had when it was looked at")
    ids = this.ids_of(chunk, number)
    start, row = plan.partition.assign(rows, quarantine=plan.quarantine)
    if np.diff(start)[touched].sum() != len(row):
        raise ValueError(f"{where} has boxes where it had none when it was looked at; expected the same boxes")
    return Pieces(0, start, (rows[row], ids[row]))


def join(plan: Plan, part: int, sides: list[list[Pieces]]) -> Any:
    """The pairs that belong to a part: a frame, or where all are to be sorted, arrays cut by the chunk of the first box."""
    boxes, ids = zip(*(_gathered(plan, side, pieces) for side, pieces in enumerate(sides)), strict=True)
    other = boxes[1] if len(boxes) == 2 else None
    # Ids ascend, so sorted rows are sorted ids.
    rows = plan.partition.pairs(part, boxes[0], other, algorithm=plan.algorithm, sort=plan.sort, threads=plan.threads)
    found = (ids[0][rows[:, 0]], ids[-1][rows[:, 1]])
    if plan.sort:
        return Pieces(0, np.searchsorted(found[0], plan.sides[0].starts), found)
    return as_frame(plan, *found)


def _gathered(plan: Plan, side: int, several: list[Pieces]) -> tuple[Rows, NDArray[Any]]:
    boxes = np.concatenate([np.empty((0, plan.width), plan.dtype), *(pieces.arrays[0] for pieces in several)])
    if not several:
        return boxes, plan.sides[side].labels(np.empty(0, np.int64)).to_numpy()
    return boxes, np.concatenate([pieces.arrays[1] for pieces in several])


def sort(plan: Plan, several: list[Pieces]) -> Any:
    """All pairs whose first box is in one chunk."""
    empty = np.empty(0, np.int64)
    first, second = (np.concatenate([empty, *(pieces.arrays[k] for pieces in several)]) for k in (0, 1))
    order = np.lexsort((second, first))
    return as_frame(plan, first[order], second[order])


def as_frame(plan: Plan, first: NDArray[Any], second: NDArray[Any]) -> Any:
    """Pairs of ids as a DataFrame."""
    return pandas.DataFrame({"first": plan.sides[0].labels(first), "second": plan.sides[-1].labels(second)})


def _index_of(chunk: Any, where: str) -> Any:
    if not isinstance(chunk, (pandas.DataFrame, pandas.Series)):
        raise TypeError(f"{where} is {_arguments.kind_of(chunk)}; expected a DataFrame, since ids is 'index'")
    if chunk.index.nlevels > 1:
        raise TypeError(f"{where} has an index of {chunk.index.nlevels} levels; expected one level, since ids is 'index'")
    return chunk.index

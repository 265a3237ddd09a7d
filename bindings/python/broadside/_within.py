"""Pairs within a distance or around an edge: the arguments `within` and `period`, distances and neighbour lists
of pairs."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from broadside import _arguments, _convert, _core
from broadside._columns import Columns


_PERIODS = "a number, or one for each axis, with None (or infinity) for an axis that does not repeat"


def checked(within: Any, period: Any, boxes: Any, other: Any) -> Any:
    """The reach and the periods as the extension module takes them; None if there are neither."""
    if within is None and period is None:
        return None
    return _reach(within, other is not None), periods(period, boxes, other)


def periods(period: Any, boxes: Any, other: Any) -> NDArray[np.float64]:
    """An array of the periods on each axis of these rows, infinite where they are None; empty for None."""
    if period is None:
        return np.empty(0)
    if np.ndim(period) == 0:
        if isinstance(period, (str, bytes)):
            raise TypeError(f"period is {period!r}; expected {_PERIODS}")
        # An empty list has no dimension.
        columns = next((rows.shape[1] for rows in (boxes, other) if hasattr(rows, "shape")), 4)
        return np.full(columns // 2, _arguments.number(period, "period"))
    if len(period) == 0:
        raise ValueError(f"period is empty; expected {_PERIODS}")
    return np.array([np.inf if one is None else _arguments.number(one, "period") for one in period], np.float64)


def _reach(within: Any, is_between: bool) -> Any:
    """A float, or the radii of both sets."""
    if within is None:
        return 0.0
    if is_between and isinstance(within, (tuple, list)):
        if len(within) != 2:
            raise ValueError(f"within has {len(within)} elements; expected a number, or the radii of both sets")
        return _radii(within[0]), _radii(within[1])
    if np.ndim(within) == 0:
        return _arguments.number(within, "within")
    if is_between:
        raise TypeError("within is an array; expected a number, or the radii of both sets as a tuple")
    return _radii(within), np.empty(0)


def _radii(found: Any) -> NDArray[np.float64]:
    array = np.asarray(found)
    if array.size and array.dtype.kind not in "iuf":
        raise TypeError(f"within has dtype {array.dtype}; expected numbers")
    if array.ndim != 1:
        raise ValueError(f"within has shape {array.shape}; expected a number, or (n,): a radius for each box")
    return np.ascontiguousarray(array, np.float64)


class NeighbourLists(NamedTuple):
    """The neighbours of every box, ascending: those of box i are ``ids[offsets[i]:offsets[i + 1]]``.

    They are a matrix in CSR form: ``scipy.sparse.csr_array((values, ids, offsets))``.
    """

    offsets: NDArray[np.int64]
    """shape (n + 1,)"""
    ids: NDArray[np.uint32]
    """shape (k,)"""


@_arguments.suggests
def distances(
    boxes: Any,
    pairs: ArrayLike,
    other: Any = None,
    *,
    period: Any = None,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
) -> NDArray[np.float64]:
    """The Euclidean distance of the boxes of each pair: 0 for boxes that overlap.

    Args:
        boxes: The boxes, or points, that the pairs were found in, as `pairs` takes them.
        pairs: Rows of two ids, shape (k, 2), such as ``pairs(boxes, within=r)``, whose distances are at most r.
        other: The second set, if the pairs are of two sets.
        period: As in `pairs`.
        columns: As in `pairs`.
        other_columns: As in `pairs`.

    Raises ValueError for an id that is out of range.
    """
    left = _convert.given(boxes, "boxes", columns, or_points=True)
    right = None if other is None else _convert.given(other, "other", other_columns, or_points=True)
    return _core.distances(left, right, pairs, periods(period, left, right))


@_arguments.suggests
def neighbour_lists(pairs: ArrayLike, n: int, *, full: bool = True) -> NeighbourLists:
    """The neighbours of each of `n` boxes, from pairs in any order.

    Args:
        pairs: Rows of two ids, shape (k, 2), such as ``pairs(points, within=cutoff)``.
        n: The number of boxes; of two sets, of the first.
        full: If True, each box of a pair is a neighbour of the other, so each pair is listed twice. If False, only the
            second is a neighbour of the first: a half list, or a list between two sets.

    Raises ValueError for an id that is out of range.
    """
    count = _arguments.integer(n, "n", 0, 2**32 - 1)
    return NeighbourLists(*_core.neighbours(pairs, count, _arguments.truth(full, "full")))

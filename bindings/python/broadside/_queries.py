"""Queries in bulk to boxes that do not change."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from broadside import _arguments, _convert, _core, _pickling
from broadside._columns import Columns
from broadside._errors import InvalidBoxError


class Found(NamedTuple):
    """What overlaps or contains: two arrays of the same length, ordered by query."""

    query: NDArray[np.uint32]
    """The rows of the queries."""
    box: NDArray[Any]
    """The boxes found: rows (uint32), of a world handles (uint64)."""


class Hits(NamedTuple):
    """What rays hit: three arrays of the same length, ordered by ray."""

    query: NDArray[np.uint32]
    """The rows of the rays."""
    box: NDArray[Any]
    """The boxes hit: rows (uint32), of a world handles (uint64)."""
    t: NDArray[Any]
    """Where: at origin + t * direction the ray enters the box; 0 where it begins in it."""


class FirstHits(NamedTuple):
    """What each ray hits first: a row for each ray. One that hits nothing has the greatest number and ``inf``."""

    box: NDArray[Any]
    """The box hit: a row (uint32), of a world a handle (uint64). Of several at the same t, the least row."""
    t: NDArray[Any]
    """Where, as in Hits."""


class Neighbours(NamedTuple):
    """The nearest boxes of each query, shape (m, k). Places without a box hold the greatest number and ``inf``."""

    box: NDArray[Any]
    """By distance, then by row: rows (uint32), of a world handles (uint64)."""
    distance_squared: NDArray[np.float64]
    """The square of the Euclidean distance from the query to the box; 0 where they overlap. The gap on each axis,
    its square and their sum are rounded to float64, also for boxes of float32."""

    def pairs(self) -> Found:
        """Each query with each of its neighbours: two arrays of the same length, without places that hold no box."""
        rows, places = np.nonzero(self.box != np.iinfo(self.box.dtype).max)
        return Found(rows.astype(np.uint32), self.box[rows, places])


class Index:
    """Boxes for queries: which overlap a box, contain a point, meet a ray, or are nearest to a point or a box.

    Args:
        boxes: n boxes, whatever `pairs` takes. They are copied.
        columns: A table's columns of bounds, or the meaning of the numbers in a row: see `pairs`.
        filters: A filter for each box, made by `broadside.filters`, for queries with filters.
        dtype: float32 or float64, to widen the boxes. Queries are of the same dtype: those of float64 to an index of
            float32 are refused unless they are exact in float32, so that answers are exact.

    Raises:
        InvalidBoxError: A box has a NaN or a minimum greater than its maximum.
        TypeError, ValueError: As `pairs`.

    Cost: about that of finding all pairs; 100 to 200 bytes a box. A query takes some hundred nanoseconds, and what it
    finds. Queries release the GIL, end at Ctrl-C, and may be asked by several threads at once. Making an index releases
    the GIL and is not interrupted. An index can be pickled.

    Each function takes `filters` and `exclude`, with one value for each query or one for all. `filters` are made by
    `broadside.filters`: a query finds only boxes whose filters accept its own. `exclude` names a box that the query leaves
    out, such as the box that a point belongs to. If there is no such box, nothing is left out.
    """

    __slots__ = ("__weakref__", "_boxes", "_crs", "_filters", "_index")

    def __init__(
        self,
        boxes: Any,
        *,
        dtype: DTypeLike | None = None,
        columns: Columns | None = None,
        filters: NDArray[np.void] | None = None,
    ) -> None:
        array = _convert.boxes(boxes, "boxes", columns)
        if dtype is not None:
            has_doubles = _has_doubles(dtype)
            array = _convert.rows_of(array, "boxes", array.shape[1], has_doubles)
        try:
            self._take(array, _convert.crs_of(boxes), filters)
        except InvalidBoxError as error:
            raise _convert.with_other_conventions(error, boxes, "boxes", columns) from None

    def _take(self, array: NDArray[Any], crs: Any, filters: NDArray[np.void] | None) -> None:
        # Bytes are immutable, so an array over them cannot be made writable.
        self._boxes: NDArray[Any] = np.ndarray(array.shape, array.dtype, array.tobytes())
        self._crs = crs
        self._filters = None if filters is None else np.array(filters)
        self._index = _core.make_index(self._boxes, self._filters)

    def __len__(self) -> int:
        """The number of boxes."""
        return len(self._index)

    @property
    def boxes(self) -> NDArray[Any]:
        """The boxes, shape (n, 4) or (n, 6); read-only."""
        return np.ndarray(self._boxes.shape, self._boxes.dtype, self._boxes.base)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._index.dimension()

    @property
    def dtype(self) -> np.dtype[Any]:
        """float32 or float64: of the boxes and of t."""
        return self._boxes.dtype

    @property
    def nbytes(self) -> int:
        """The bytes that the index holds beside its boxes."""
        return self._index.bytes()

    def overlapping(
        self, queries: Any, *, filters: NDArray[np.void] | None = None, exclude: ArrayLike | None = None
    ) -> Found:
        """The boxes that overlap each of `queries`, m boxes. An absent one overlaps nothing."""
        _convert.common_crs(self._crs, "the index", queries, "queries")
        return Found(*self._index.overlapping(queries, filters, exclude))

    def containing(
        self, points: Any, *, filters: NDArray[np.void] | None = None, exclude: ArrayLike | None = None
    ) -> Found:
        """The boxes that contain each of `points`, shape (m, dimension)."""
        return Found(*self._index.containing(points, filters, exclude))

    def hits(
        self,
        origins: Any,
        directions: Any,
        *,
        t_max: float = math.inf,
        entering: bool = False,
        filters: NDArray[np.void] | None = None,
        exclude: ArrayLike | None = None,
    ) -> Hits:
        """All boxes that each ray meets: the points origin + t * direction, 0 <= t <= t_max.

        `origins` and `directions` have shape (m, dimension) and are finite. Raises InvalidQueryError otherwise. With
        `entering`, only boxes that the ray enters: not those that its origin is in or on, unless it is on the border
        and the ray moves into the box.
        """
        limit = _arguments.number(t_max, "t_max")
        return Hits(*self._index.hits(origins, directions, limit, entering, filters, exclude))

    def first_hit(
        self,
        origins: Any,
        directions: Any,
        *,
        t_max: float = math.inf,
        entering: bool = False,
        filters: NDArray[np.void] | None = None,
        exclude: ArrayLike | None = None,
    ) -> FirstHits:
        """The box that each ray, as in `hits`, meets first."""
        limit = _arguments.number(t_max, "t_max")
        return FirstHits(*self._index.first_hit(origins, directions, limit, entering, filters, exclude))

    def nearest(
        self,
        queries: Any,
        k: int = 1,
        *,
        max_distance: float = math.inf,
        threads: int | None = None,
        filters: NDArray[np.void] | None = None,
        exclude: ArrayLike | None = None,
    ) -> Neighbours:
        """The k boxes nearest to each of `queries`, at a distance of at most `max_distance`.

        `queries` are points, shape (m, dimension), or boxes, as for `overlapping`. `k` is from 1 to 65,536, or to the
        number of boxes where these are more. `threads` are the most to use; None: all cores. Raises InvalidQueryError
        for a NaN; an infinite point is infinitely far from every finite box, and nothing is near an absent box.
        """
        return _nearest(self, self._index, queries, _checked_k(k, len(self)), max_distance, threads, filters, exclude)

    def __reduce__(self) -> tuple[Any, ...]:
        made_of = (type(self), self._boxes, self._crs, self._filters)
        return _unpickled_index, made_of, _pickling.state_of(self, Index)

    def __repr__(self) -> str:
        return f"broadside.Index({len(self)} boxes, {self.dimension}D, {self.dtype})"


def _unpickled_index(kind: type[Index], boxes: NDArray[Any], crs: Any, filters: NDArray[np.void] | None) -> Index:
    index = kind.__new__(kind)
    index._take(boxes, crs, filters)
    return index


def _nearest(
    known: Any, asked: Any, queries: Any, k: int, max_distance: float, threads: int | None, filters: Any, exclude: Any
) -> Neighbours:
    """Asks an index or a world, `known` to users, of the extension module."""
    limit = _checked_distance(max_distance)
    are_points = _convert.are_points(queries, "queries", known.dimension)
    if not are_points and isinstance(known, Index):
        _convert.common_crs(known._crs, "the index", queries, "queries")
    return Neighbours(*asked.nearest(queries, are_points, k, limit, threads, filters, exclude))


def nearest_pairs(
    boxes: Any,
    other: Any = None,
    k: int = 1,
    *,
    max_distance: float = math.inf,
    threads: int | None = None,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    other_filters: NDArray[np.void] | None = None,
) -> Neighbours:
    """For each box of a set the k nearest ones: of `other` or, without it, of the same set, itself left out.

    Args:
        boxes: n boxes, whatever `pairs` takes, or points of shape (n, 2) or (n, 3).
        other: A second set, likewise, of the same dimension. If one set is float32 and the other float64, the former
            is widened.
        k: How many, from 1 to 65,536, or to the number of boxes where these are more.
        max_distance: Boxes that are farther away are not found. A box at exactly this distance is.
        threads: The most threads; None: all cores. A thread has at least 4096 boxes.
        columns: As in `pairs`.
        other_columns: As in `pairs`.
        filters: Which boxes may be neighbours: a filter for each, made by `filters`.
        other_filters: Likewise for `other`.

    Returns:
        For each box its neighbours, by distance and then by row, whatever the threads. Two boxes with the same bounds
        are neighbours of each other, at distance 0. ``nearest_pairs(...).pairs()`` lists them as pairs.

    Raises:
        InvalidBoxError, InvalidQueryError: A box has a NaN or a minimum greater than its maximum.
        TypeError, ValueError: As `pairs`.

    Cost: about that of an `Index` and, for each box, some hundred nanoseconds and what it finds.
    """
    left = _convert.boxes_or_points(boxes, "boxes", columns)
    if other is None:
        for value, name in ((other_columns, "other_columns"), (other_filters, "other_filters")):
            if value is not None:
                raise ValueError(f"{name} are given without other boxes; expected both or neither")
        index = Index(left, filters=filters)
        return index.nearest(left, k, max_distance=max_distance, threads=threads, filters=filters, exclude=np.arange(len(left)))
    _convert.common_crs(_convert.crs_of(boxes), "boxes", other, "other")
    right = _convert.boxes_or_points(other, "other", other_columns)
    if left.shape[1] != right.shape[1]:
        raise ValueError(f"boxes have {left.shape[1] // 2} dimensions and other has {right.shape[1] // 2}; expected the same")
    dtype = np.result_type(left, right)
    index = Index(right, dtype=dtype, filters=other_filters)
    return index.nearest(left.astype(dtype, copy=False), k, max_distance=max_distance, threads=threads, filters=filters)


def _checked_k(k: int, boxes: int) -> int:
    return _arguments.integer(k, "k", 1, max(boxes, 65_536))


def _checked_distance(found: float) -> float:
    distance = _arguments.number(found, "max_distance")
    if not distance >= 0:
        raise ValueError(f"max_distance is {found}; expected 0 or more")
    return distance


def _has_doubles(dtype: DTypeLike) -> bool:
    found = np.dtype(dtype)
    if found not in (np.float32, np.float64):
        raise ValueError(f"dtype is {found}; expected float32 or float64")
    return found == np.float64


def _checked_dimension(dimension: int) -> int:
    return _arguments.integer(dimension, "dimension", 2, 3)

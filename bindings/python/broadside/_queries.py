"""Queries in bulk to boxes that do not change."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from broadside import _arguments, _convert, _core, _pickling
from broadside._columns import Columns
from broadside._errors import InvalidBoxError
from broadside._keys import Keyed, groups_of, rows_by_group, with_keys


class Found(NamedTuple):
    """The boxes that queries found: two arrays of the same length, ordered by query."""

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
    """What each ray hits first: a row for each ray.

    A ray that hits nothing has the box 4294967295 (in a world 2**64 - 1) at t ``inf``.
    """

    box: NDArray[Any]
    """The box hit: a row (uint32), of a world a handle (uint64). Of several at the same t, the least row."""
    t: NDArray[Any]
    """Where, as in Hits."""


class Neighbours(NamedTuple):
    """The nearest boxes of each query: two arrays of shape (m, k).

    If a query has fewer than k neighbours, the remaining places have the box 4294967295, the greatest uint32 (in a
    world 2**64 - 1), at the distance ``inf``.
    """

    box: NDArray[Any]
    """By distance, then by row: rows (uint32), of a world handles (uint64)."""
    distance_squared: NDArray[np.float64]
    """The square of the Euclidean distance from the query to the box; 0 where they overlap. The gap on each axis,
    its square and their sum are rounded to float64, also for boxes of float32."""

    def pairs(self) -> Found:
        """Each query with each of its neighbours: two arrays of the same length, in which empty places are left out."""
        rows, places = np.nonzero(self.box != np.iinfo(self.box.dtype).max)
        return Found(rows.astype(np.uint32), self.box[rows, places])


class Index:
    """An index for queries: which boxes overlap a box, contain a point, meet a ray, or are nearest to a point or a box.

    Args:
        boxes: n boxes, whatever `pairs` takes, or points, as `nearest_pairs` takes them. They are copied.
        columns: The names of a table's columns of bounds, or a layout such as "xywh": see `pairs`.
        filters: A filter for each box, made by `broadside.filters`, for queries with filters.
        dtype: float32 or float64, to widen the boxes. Queries have the same dtype. So that answers are exact, an index
            of float32 refuses float64 queries that are not exact in float32.

    Raises:
        InvalidBoxError: A box has a NaN or a minimum greater than its maximum.
        TypeError, ValueError: As `pairs`.

    Cost: about that of finding all pairs; 100 to 200 bytes a box. A query takes some hundred nanoseconds, and the time
    to write what it finds. Queries release the GIL, end at Ctrl-C, and may come from several threads at once. Making an
    index releases the GIL and cannot be interrupted. An index can be pickled.

    Each function takes `filters` and `exclude`, with one value for each query or one for all. `filters` are made by
    `broadside.filters`: a query finds only boxes whose filters accept its own. If boxes and queries have filters with
    ``category=0, mask=0, group=1 + image``, a query finds only boxes of its own image. `exclude` names a box that the
    query leaves out, such as the box that a point belongs to. If there is no such box, nothing is left out.
    """

    __slots__ = ("__weakref__", "_boxes", "_crs", "_filters", "_index")

    @_arguments.suggests
    def __init__(
        self,
        boxes: Any,
        *,
        dtype: DTypeLike | None = None,
        columns: Columns | None = None,
        filters: NDArray[np.void] | None = None,
    ) -> None:
        array = _convert.boxes(boxes, "boxes", columns, or_points=True)
        if dtype is not None:
            has_doubles = _has_doubles(dtype)
            array = _convert.rows_of(array, "boxes", array.shape[1], has_doubles)
        try:
            self._take(array, _convert.crs_of(boxes), filters)
        except InvalidBoxError as error:
            raise _convert.explained(error, boxes, "boxes", columns) from None

    def _take(self, array: NDArray[Any], crs: Any, filters: Any) -> None:
        # Bytes are immutable, so an array over them cannot be made writable.
        self._boxes: NDArray[Any] = np.ndarray(array.shape, array.dtype, array.tobytes())
        self._crs = crs
        self._filters = filters if filters is None or isinstance(filters, Keyed) else np.array(filters)
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
        """The dtype of the boxes and of t: float32 or float64."""
        return self._boxes.dtype

    @property
    def nbytes(self) -> int:
        """The bytes that the index holds besides its boxes."""
        return self._index.bytes()

    def overlapping(
        self, queries: Any, *, filters: NDArray[np.void] | None = None, exclude: ArrayLike | None = None
    ) -> Found:
        """The boxes that overlap each of `queries`, m boxes. An absent box overlaps nothing."""
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
        `entering`, only boxes that the ray enters. A box that holds the origin counts only if the origin is on its
        border and the ray moves into the box.
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
        number of boxes if that is greater. `threads` is the maximum number of threads; None: all cores. Raises
        InvalidQueryError for a NaN; an infinite point is infinitely far from every finite box, and nothing is near an
        absent box.
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


@_arguments.suggests
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
    same: Any = None,
    different: Any = None,
) -> Neighbours:
    """The k nearest boxes of each box: in `other` or, without it, in the same set, without the box itself.

    Args:
        boxes: n boxes, whatever `pairs` takes, or points: arrays of shape (n, 2) or (n, 3), or tables with columns x and
            y, or others that `columns` names.
        other: A second set, likewise, of the same dimension. If one set is float32 and the other float64, the former
            is widened.
        k: The number of neighbours: from 1 to 65,536, or to the number of boxes if that is greater.
        max_distance: Boxes that are farther away are left out. A box at exactly this distance is found.
        threads: The maximum number of threads; None: all cores. A thread has at least 4096 boxes.
        columns: As in `pairs`; two or three names mean points.
        other_columns: Likewise for `other`.
        filters: Which boxes may be neighbours: a filter for each, made by `filters`.
        other_filters: Likewise for `other`.
        same: A key for each box, such as its image or class, as in `pairs`: only boxes with equal keys are neighbours.
        different: Likewise: only boxes with different keys are neighbours. With `same` as well, both must hold.

    Returns:
        The neighbours of each box, ordered by distance and then by row, whatever the threads. Two boxes with the same
        bounds are neighbours of each other, at distance 0. ``nearest_pairs(...).pairs()`` lists them as pairs.

    Raises:
        InvalidBoxError, InvalidQueryError: A box has a NaN or a minimum greater than its maximum.
        TypeError, ValueError: As `pairs`.

    Cost: about that of making an `Index`, and for each box some hundred nanoseconds and the time to write what it
    finds. With `same`, each key costs some ten microseconds more. In periodic space, find neighbours by `pairs` with
    ``within`` and ``period``.
    """
    if other is None:
        for value, name in ((other_columns, "other_columns"), (other_filters, "other_filters")):
            if value is not None:
                raise ValueError(f"{name} are given without other boxes; expected both or neither")
        if same is None:
            rows = _convert.boxes_or_points(boxes, "boxes", columns)
            filters, _, _ = with_keys(filters, None, None, different, boxes, None)
            kind = rows.shape[1], rows.dtype == np.float64
            limit = _checked_distance(max_distance)
            try:
                return Neighbours(*_core.nearest_pairs(rows, *kind, _checked_k(k, len(rows)), limit, threads, filters))
            except InvalidBoxError as error:
                raise _convert.explained(error, boxes, "boxes", columns) from None
    groups = None if same is None else groups_of(same, "same", [boxes] if other is None else [boxes, other])
    as_rows = _convert.boxes if groups is None else _convert.valid_boxes
    left = as_rows(boxes, "boxes", columns, or_points=True)
    if other is None:
        right, exclude = left, np.arange(len(left))
    else:
        _convert.common_crs(_convert.crs_of(boxes), "boxes", other, "other")
        right, exclude = as_rows(other, "other", other_columns, or_points=True), None
        if left.shape[1] != right.shape[1]:
            raise ValueError(
                f"boxes have {left.shape[1] // 2} dimensions and other has {right.shape[1] // 2}; expected the same"
            )
        dtype = np.result_type(left, right)
        left, right = left.astype(dtype, copy=False), right.astype(dtype, copy=False)
        filters = _convert.one_or_each(filters, len(left))
    filters, other_filters, _ = with_keys(filters, other_filters, None, different, boxes, other)
    for given, rows, name in ((filters, left, "filters"), (other_filters, right, "other_filters")):
        if given is not None:
            _convert.filters(given, len(rows), name)
    if other is None:
        other_filters = filters
    how: dict[str, Any] = {"max_distance": _checked_distance(max_distance), "threads": threads}
    if groups is None:
        return Index(right, filters=other_filters).nearest(left, k, filters=filters, **how)
    searched, asked = _Set(right, groups[-1], other_filters), _Set(left, groups[0], filters)
    return _nearest_by_key(asked, searched, _checked_k(k, len(right)), exclude is not None, how)


class _Set:
    """A set of boxes by their keys."""

    def __init__(self, boxes: NDArray[Any], groups: NDArray[np.int64], filters: Any) -> None:
        if len(groups) != len(boxes):
            raise ValueError(f"same has {len(groups)} keys for {len(boxes)} boxes; expected one for each box")
        self.boxes, self.filters = boxes, filters
        self.rows = rows_by_group(groups)

    def part(self, key: int) -> tuple[NDArray[np.uint32], NDArray[Any], Any]:
        """The rows of a key's boxes, these boxes and their filters."""
        rows = self.rows[key]
        return rows, self.boxes[rows], None if self.filters is None else self.filters[rows]


def _nearest_by_key(left: _Set, right: _Set, k: int, is_one_set: bool, how: dict[str, Any]) -> Neighbours:
    """The nearest boxes of equal keys, by an index for each key: a filter would look at all boxes of other keys nearby."""
    none = np.uint32(2**32 - 1)
    box = np.full((len(left.boxes), k), none)
    distances = np.full(box.shape, np.inf)
    Index(right.boxes[:0]).nearest(left.boxes[:0], **how)  # checks `how`, also if the sets have no key in common
    for key in left.rows.keys() & right.rows.keys():
        rows, boxes, filters = left.part(key)
        others, other_boxes, other_filters = right.part(key)
        some = min(k, len(others))
        exclude = np.arange(len(rows)) if is_one_set else None
        near = Index(other_boxes, filters=other_filters).nearest(boxes, some, filters=filters, exclude=exclude, **how)
        box[rows, :some] = np.append(others, none)[np.minimum(near.box, len(others))]
        distances[rows, :some] = near.distance_squared
    return Neighbours(box, distances)


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

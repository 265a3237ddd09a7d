"""All pairs of one set of boxes, or of two."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from broadside import _arguments, _columns, _convert, _core, _within
from broadside._columns import Columns
from broadside._core import PairTable as PairTable
from broadside._errors import InvalidBoxError
from broadside._keys import with_keys

_find = _core.find
_ARRAY = _core.ARRAY


@overload
def pairs(
    boxes: Any,
    other: Any = None,
    *,
    algorithm: str = "auto",
    sort: bool = False,
    output: Literal["numpy"] = "numpy",
    threads: int | None = None,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    other_filters: NDArray[np.void] | None = None,
    ignored: ArrayLike | None = None,
    quarantine: bool = False,
    touching: bool = True,
    same: Any = None,
    different: Any = None,
    within: Any = None,
    period: Any = None,
    to: Any = None,
) -> NDArray[np.uint32]: ...
@overload
def pairs(
    boxes: Any,
    other: Any = None,
    *,
    algorithm: str = "auto",
    sort: bool = False,
    output: Literal["arrow"],
    threads: int | None = None,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    other_filters: NDArray[np.void] | None = None,
    ignored: ArrayLike | None = None,
    quarantine: bool = False,
    touching: bool = True,
    same: Any = None,
    different: Any = None,
    within: Any = None,
    period: Any = None,
    to: Any = None,
) -> PairTable: ...
@overload
def pairs(
    boxes: Any,
    other: Any = None,
    *,
    algorithm: str = "auto",
    sort: bool = False,
    output: Literal["sparse"],
    threads: int | None = None,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    other_filters: NDArray[np.void] | None = None,
    ignored: ArrayLike | None = None,
    quarantine: bool = False,
    touching: bool = True,
    same: Any = None,
    different: Any = None,
    within: Any = None,
    period: Any = None,
    to: Any = None,
) -> Any: ...
@_arguments.suggests
def pairs(
    boxes: Any,
    other: Any = None,
    *,
    algorithm: str = "auto",
    sort: bool = False,
    output: str = "numpy",
    threads: int | None = None,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    other_filters: NDArray[np.void] | None = None,
    ignored: ArrayLike | None = None,
    quarantine: bool = False,
    touching: bool = True,
    same: Any = None,
    different: Any = None,
    within: Any = None,
    period: Any = None,
    to: Any = None,
) -> Any:
    """Every pair of overlapping boxes, once. Boxes that touch overlap, unless `touching` is False.

    Args:
        boxes: n boxes: an array of shape (n, 4) in 2D or (n, 6) in 3D, minima first. C-contiguous arrays of float32 and
            float64 are not copied, and the search gathers rows that lie farther apart. Other strides, float16, integers
            (refused where float64 does not hold one) and nested lists are converted once. So are shapely geometries,
            GeoSeries and GeoDataFrames (by their bounds; empty ones overlap nothing), objects with ``__array__`` or
            ``__dlpack__``, and tables: pandas and polars DataFrames, structured arrays, and Arrow tables and arrays
            (structs of columns, lists of a fixed size). Only a table's columns of bounds are read. A row without any
            bound is an absent box, as an empty geometry is. An empty list stands for no boxes. No other thread may
            change the array during the call.
        other: A second set, of the same dimension. Then only pairs of a box of `boxes` and a box of `other` are
            found. If one set is float32 and the other float64, the former is widened, which is exact.
        algorithm: A spec such as ``"grid:cell=2.5"``: see `algorithms`. ``"auto"`` chooses by the boxes.
        sort: Sort the pairs, which takes longer than the search. Otherwise their order is fixed by the algorithm and
            the boxes, whatever the threads.
        output: ``"numpy"``; ``"arrow"`` for a `PairTable`; ``"sparse"`` for a ``scipy.sparse.csr_array`` of booleans
            with n rows and as many columns as the second set has boxes. Its true elements are the pairs; for one set,
            those above the diagonal.
        threads: The maximum number of threads; None: all cores. A thread gets at least 4096 boxes, so few boxes take
            one thread.
        columns: Either the names of a table's columns, or a layout.
            A list of names, such as ``["x", "y", "w", "h"]``, selects columns of a table and names those of an array.
            Four or six names without a meaning, such as ``["a", "b", "c", "d"]``, are the minima and then the maxima.
            With `within`, two or three names mean points; ``["start", "end"]`` mean intervals.
            A layout, ``"xyxy"``, ``"xywh"``, ``"cxcywh"``, ``"xyzxyz"``, ``"xyzwhd"`` or ``"cxcyczwhd"``, is the
            meaning of the numbers in a row of an array, or in a table's column `bbox` of lists (in Arrow and polars
            lists of a fixed size), and of columns called x, y, w and h.
            By default, a table's bounds are found by the names that CSV uses: xmin, ymin, xmax, ymax; left, top, right,
            bottom; a struct `bbox` ...; and rows without names are minima, then maxima.
        other_columns: Likewise for `other`.
        filters: Which boxes may pair: a filter for each, made by `filters`.
        other_filters: Likewise for `other`.
        ignored: Pairs of one set that never count, shape (m, 2), in either order.
        quarantine: Leave invalid boxes out instead of raising; `invalid_rows` tells which these are.
        touching: Whether boxes that only touch overlap. If False, boxes are half-open (min <= p < max), except on an
            axis where minimum and maximum are equal. Exact.
        same: A key for each box, such as its image, class or layer: only boxes with equal keys pair. Keys are integers,
            strings or categories, in an array or a column of pandas, polars or Arrow; floats that are whole numbers
            count as integers. They are taken row by row, and the index of pandas is ignored. If the boxes are a table,
            the name of its column is enough. Several keys (a tuple of arrays, a list of names or a table) are equal if
            all are. For two sets, give both sets' keys as a tuple, or names of columns that both have. With `same`,
            filters may set only `is_static`.
        different: Likewise: only boxes with different keys pair. Filters of group 0 may leave out more pairs. With
            `same` as well, both must hold, such as the same image and different classes.
        within: A distance, such as a cutoff: find the boxes whose Euclidean distance is at most this, instead of those
            that overlap. Or a radius for each box, shape (n,): two boxes pair if their distance is at most the sum of
            their radii. For two sets, give both sets' radii as a tuple. The boxes may then be points: arrays of shape
            (n, 2) or (n, 3), or tables with columns x and y, or others that `columns` names. `distances` and
            `neighbour_lists` take the pairs.
        period: The length after which space repeats: a number for all axes, or one for each, with None (or infinity)
            for an axis that does not repeat. For ``(360, None)``, longitude and latitude, a box from 170 to 190
            overlaps one from -180 to -175. Boxes may lie in any cell. A box at least as long as the period covers the
            whole axis. With `within`, the distance is that of the nearest images.
        to: The boxes at the end of a step, in the same number; `boxes` are then at its beginning. Each bound moves at a
            constant speed. Two boxes pair if they overlap at some time of the step, but not if they only pass through a
            place one after the other. For two sets, give the ends of both as a tuple. `overlap_times` tells when pairs
            overlap.

    Returns:
        uint32 of shape (k, 2): the rows of each pair's boxes. In one set the first row is the lower one. Of two sets,
        the first is a row of `boxes` and the second a row of `other`. The array owns the memory that the search wrote.

    Raises:
        InvalidBoxError: A box has a NaN or a minimum greater than its maximum; ``row`` and ``argument`` say which.
        InvalidAlgorithmError: `algorithm` does not exist or has no such tunable or value.
        TypeError: An argument has another type or dtype than these.
        InvalidQueryError: `within` has a number that is not finite, or is negative; `period` has a number that is not
            above 0, or does not have one for each axis.
        ValueError: An argument has another shape, or does not fit the others.

    Cost: about that of sorting the boxes, and of writing the pairs. The GIL is released. At Ctrl-C a search ends
    within a few million tests, and sorting pairs within as many comparisons; signals are checked at most once every 50
    milliseconds. Any number of threads may call it at once.
    """
    filters, other_filters, keys = with_keys(filters, other_filters, same, different, boxes, other)
    left, right = boxes, other
    has_reach = within is not None or period is not None
    if other is not None or columns is not None or other_columns is not None or has_reach:
        left, right = _sets(boxes, other, columns, other_columns, has_reach)
    reach = _within.checked(within, period, left, right)
    moving = ends(to, other is not None, columns, other_columns)
    which = (threads, filters, other_filters, ignored, quarantine, touching, reach, moving, keys)
    try:
        if output == "numpy":
            return _find(_ARRAY, left, right, algorithm, sort, *which)
        if output == "arrow":
            return _find(_core.TABLE, left, right, algorithm, sort, *which)
        if output == "sparse":
            return _sparse(left, right, algorithm, *which)
    except InvalidBoxError as error:
        raise _explained(error, boxes, other, columns, other_columns) from None
    raise ValueError(f"output is {output!r}; expected 'numpy', 'arrow' or 'sparse'")


def _explained(
    error: InvalidBoxError, boxes: Any, other: Any, columns: Columns | None, other_columns: Columns | None
) -> InvalidBoxError:
    return _convert.explained(_convert.explained(error, boxes, "boxes", columns), other, "other", other_columns)


def _sparse(boxes: Any, other: Any, *arguments: Any) -> Any:
    csr_array = import_module("scipy.sparse").csr_array
    left = _kept(boxes, "boxes")
    right = None if other is None else _kept(other, "other")
    algorithm, *rest = arguments
    found = _find(_ARRAY, left, right, algorithm, True, *rest)
    columns = len(left) if right is None else len(right)
    starts = np.zeros(len(left) + 1, np.int64)
    np.cumsum(np.bincount(found[:, 0], minlength=len(left)), out=starts[1:])
    trues = np.ones(len(found), np.bool_)
    return csr_array((trues, found[:, 1].astype(np.int64), starts), shape=(len(left), columns))


def _sets(
    boxes: Any, other: Any, columns: Columns | None, other_columns: Columns | None, or_points: bool
) -> tuple[Any, Any]:
    """Both sets as the extension module takes them. Raises ValueError if their reference systems differ."""
    if other is not None:
        _convert.common_crs(_convert.crs_of(boxes), "boxes", other, "other")
        other = _convert.given(other, "other", other_columns, or_points)
    elif other_columns is not None:
        raise ValueError("other_columns are given without other boxes; expected both or neither")
    return _convert.given(boxes, "boxes", columns, or_points), other


def ends(to: Any, is_between: bool, columns: Columns | None, other_columns: Columns | None) -> Any:
    """Where the boxes of each set end, as the extension module takes it."""
    if to is None:
        return None
    if not is_between:
        return (_convert.given(to, "to", columns),)
    if not isinstance(to, tuple) or len(to) != 2:
        raise TypeError(f"to is {_arguments.kind_of(to)}; expected a tuple of the ends of both sets")
    return _convert.given(to[0], "to", columns), _convert.given(to[1], "to", other_columns)


@_arguments.suggests
def overlap_times(boxes: Any, to: Any, pairs: ArrayLike, other: Any = None) -> NDArray[np.float64]:
    """The times between which the boxes of each pair overlap in a step from 0 to 1.

    Args:
        boxes: The boxes at the beginning of the step, as `pairs` takes them.
        to: The boxes at its end; for two sets, a tuple of both.
        pairs: Rows of two ids, shape (k, 2), such as ``pairs(boxes, to=to)``.
        other: The second set, if the pairs are of two sets.

    Returns:
        float64 of shape (k, 2): the first and the last time at which the boxes overlap; ``inf, -inf`` for boxes that
        never do. Boxes that only touch for a moment are decided exactly where differences of coordinates and their
        products are exact, as for whole numbers.

    Raises ValueError for an id that is out of range, or ends of another shape.
    """
    return _core.overlap_times(boxes, ends(to, other is not None, None, None), other, pairs)


def _kept(boxes: Any, name: str) -> Any:
    return boxes if _convert.is_empty_sequence(boxes) else _convert.boxes(boxes, name)


@_arguments.suggests
def count(
    boxes: Any,
    other: Any = None,
    *,
    algorithm: str = "auto",
    threads: int | None = None,
    columns: Columns | None = None,
    other_columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    other_filters: NDArray[np.void] | None = None,
    ignored: ArrayLike | None = None,
    quarantine: bool = False,
    touching: bool = True,
    same: Any = None,
    different: Any = None,
    within: Any = None,
    period: Any = None,
    to: Any = None,
) -> int:
    """The number of pairs that `pairs` returns for the same arguments. It stores no pairs."""
    filters, other_filters, keys = with_keys(filters, other_filters, same, different, boxes, other)
    left, right = _sets(boxes, other, columns, other_columns, within is not None or period is not None)
    reach = _within.checked(within, period, left, right)
    moving = ends(to, other is not None, columns, other_columns)
    which = (threads, filters, other_filters, ignored, quarantine, touching, reach, moving, keys)
    try:
        found: int = _find(_core.COUNT, left, right, algorithm, False, *which)
    except InvalidBoxError as error:
        raise _explained(error, boxes, other, columns, other_columns) from None
    return found


class BatchPairs(NamedTuple):
    """The pairs of many worlds, world by world: those of world i are ``pairs[offsets[i] : offsets[i + 1]]``."""

    pairs: NDArray[np.uint32]
    """Shape (k, 2), counted from the first box of each pair's world."""
    offsets: NDArray[np.int64]
    """Where each world's pairs begin, and the number of all pairs."""


@_arguments.suggests
def find_pairs_batch(
    boxes: Any,
    offsets: ArrayLike | None = None,
    *,
    algorithm: str = "auto",
    threads: int | None = None,
    columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    ignored: ArrayLike | None = None,
    quarantine: bool = False,
    touching: bool = True,
) -> BatchPairs:
    """The pairs of many small worlds in one call: those that `pairs` finds for each world alone, in the same order.

    Args:
        boxes: The boxes of all worlds, one world after another, in any form that `pairs` takes; or, without offsets, an
            array of shape (worlds, n, 4) or (worlds, n, 6). Fill up smaller worlds with absent boxes.
        offsets: World i has the rows from ``offsets[i]`` up to, not including, ``offsets[i + 1]``. So there is one
            offset more than there are worlds. Offsets never decrease, and go from 0 to the number of boxes.
        algorithm: As in `pairs`.
        threads: The maximum number of threads, which share the worlds; None: all cores.
        columns: As in `pairs`.
        filters: A filter for each box of all worlds.
        ignored: Pairs to leave out in every world, shape (m, 2); rows count from the world's first box.
        quarantine: Leave invalid boxes out instead of raising.
        touching: As in `pairs`.

    Raises as `pairs` does; ``row`` of an InvalidBoxError counts from the start of `boxes`; the message also names
    the world.
    """
    if offsets is None:
        boxes, offsets = _convert.worlds(boxes, "boxes")
    boxes = _convert.given(boxes, "boxes", columns)
    which = (algorithm, threads, filters, ignored, quarantine, touching)
    try:
        return BatchPairs(*_core.find_batch(boxes, offsets, *which))
    except InvalidBoxError as error:
        raise _convert.explained(error, boxes, "boxes", columns) from None


@_arguments.suggests
def components(
    boxes: Any,
    *,
    algorithm: str = "auto",
    threads: int | None = None,
    columns: Columns | None = None,
    filters: NDArray[np.void] | None = None,
    ignored: ArrayLike | None = None,
    quarantine: bool = False,
    touching: bool = True,
    same: Any = None,
    different: Any = None,
    within: Any = None,
    period: Any = None,
    to: Any = None,
) -> NDArray[np.uint32]:
    """The connected components of the pairs that `pairs` returns for the same arguments.

    It stores no pairs, however many there are.

    Returns:
        uint32 of shape (n,): for each box, the lowest row in its component. A box without pairs, such as an absent box,
        has its own row.
    """
    filters, _, keys = with_keys(filters, None, same, different, boxes, None)
    rows, _ = _sets(boxes, None, columns, None, within is not None or period is not None)
    reach = _within.checked(within, period, rows, None)
    moving = ends(to, False, columns, None)
    which = (threads, filters, None, ignored, quarantine, touching, reach, moving, keys)
    try:
        found: NDArray[np.uint32] = _find(_core.COMPONENTS, rows, None, algorithm, False, *which)
    except InvalidBoxError as error:
        raise _convert.explained(error, boxes, "boxes", columns) from None
    return found


@_arguments.suggests
def filters(
    n: int,
    *,
    category: ArrayLike = 1,
    mask: ArrayLike = 0xFFFFFFFFFFFFFFFF,
    group: ArrayLike = 0,
    is_static: ArrayLike = False,
) -> NDArray[np.void]:
    """A filter for each of `n` boxes: each argument is one value for all, or n of them.

    Two boxes count as a pair if they overlap and their filters accept each other: the `mask` of each has a bit of the
    other's `category`, and at most one of them is static. Two boxes of the same `group` other than 0 pair whatever
    their bits if the group is positive, and never if it is negative. With ``filters(n, category=0, mask=0, group=1 +
    image)``, boxes pair only if they are of the same image. Use this where a function has no `same`, as with `World`,
    `Tracker` and `Index`.

    Returns:
        A structured array of shape (n,), which you may change.

    Raises:
        ValueError: An argument has another shape, or is beyond uint64 (`category`, `mask`) or int32 (`group`).
    """
    made = np.empty(_arguments.integer(n, "n", 0, 2**32 - 1), _convert.FILTER)
    fields = {"category": category, "mask": mask, "group": group, "is_static": is_static}
    for name, values in fields.items():
        given = np.asarray(values) if name == "is_static" else _convert.as_integers(values)
        if name != "is_static" and given.dtype.kind not in "iu" and not _convert.are_integers(given):
            raise TypeError(f"{name} has dtype {given.dtype}; expected integers")
        if name == "is_static" and given.dtype.kind != "b":
            raise TypeError(f"is_static has dtype {given.dtype}; expected booleans")
        if given.ndim > 0 and given.shape != (n,):
            raise ValueError(f"{name} has shape {given.shape}; expected one value, or ({n},)")
        if name != "is_static" and given.size:
            limits = np.iinfo(_convert.FILTER[name])
            for limit in (given.min(), given.max()):
                if not limits.min <= int(limit) <= limits.max:
                    raise ValueError(f"{name} has {limit}; expected integers from {limits.min} to {limits.max}")
        made[name] = given
    return made


@_arguments.suggests
def intervals(starts: ArrayLike, ends: ArrayLike) -> NDArray[np.float64]:
    """Intervals as boxes, which all functions and classes take.

    An interval becomes the row start, 0, end, 0: it lies on the x axis, where a point is ``x, 0``. Intervals are
    closed; for half-open ones, such as those of BED files, say ``touching=False``. A start of ``inf`` with an end of
    ``-inf`` is an absent interval. A table with columns ``start`` and ``end`` instead of bounds can be passed as it is.

    Returns:
        A float64 array of shape (n, 4).

    Raises:
        TypeError: An argument has no numbers.
        ValueError: The arguments have another shape than (n,), or numbers that float64 does not hold.
    """
    bounds = [_columns.exact(np.asarray(given), name) for given, name in ((starts, "starts"), (ends, "ends"))]
    for array, name in zip(bounds, ("starts", "ends"), strict=True):
        if array.ndim != 1 or array.shape != bounds[0].shape:
            raise ValueError(f"{name} has shape {array.shape}; expected (n,), an end for each start")
    rows = np.zeros((len(bounds[0]), 4))
    rows[:, 0], rows[:, 2] = bounds
    absent = (rows[:, 0] == np.inf) & (rows[:, 2] == -np.inf)
    rows[absent, 1], rows[absent, 3] = np.inf, -np.inf
    return rows


@_arguments.suggests
def invalid_rows(boxes: Any, *, columns: Columns | None = None) -> NDArray[np.int64]:
    """The rows of invalid boxes, ascending: those with a NaN or a minimum greater than its maximum.

    `pairs` raises InvalidBoxError for these rows, and leaves them out with ``quarantine=True``. Absent boxes are valid.
    """
    return _core.invalid_rows(_convert.given(boxes, "boxes", columns))

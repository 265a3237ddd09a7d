"""Whatever is an array of boxes, points or numbers, as the arrays that the extension module takes.

The extension calls these functions for what it does not take as it is: arrays of float32 or float64 whose rows are in
one piece it never hands here.
"""

from __future__ import annotations

import sys
from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from broadside import _core

Rows = NDArray[Any]

FILTER = np.dtype([("category", np.uint64), ("mask", np.uint64), ("group", np.int32), ("is_static", np.bool_)])

# Which columns of a table are the bounds of boxes, minima first; the first names that are all there.
_COLUMN_NAMES = (
    ("xmin", "ymin", "zmin", "xmax", "ymax", "zmax"),
    ("xmin", "ymin", "xmax", "ymax"),
    ("minx", "miny", "minz", "maxx", "maxy", "maxz"),
    ("minx", "miny", "maxx", "maxy"),
    ("min_x", "min_y", "min_z", "max_x", "max_y", "max_z"),
    ("min_x", "min_y", "max_x", "max_y"),
    # What pandas and polars call the columns of an array, which are taken by their places.
    *(tuple(f"{prefix}{i}" for i in range(count)) for prefix in ("", "column_") for count in (6, 4)),
)


def boxes(found: Any, name: str) -> Rows:
    """Rows of boxes, of float32 or float64."""
    array = _with_float_rows(found, name, boxes_expected=True)
    if array.ndim != 2 or array.shape[1] not in (4, 6):
        raise ValueError(
            f"{name} has shape {array.shape}; expected (n, 4) or (n, 6): the minima of each box, then its maxima"
        )
    return array


def rows_of(found: Any, name: str, columns: int, are_doubles: bool) -> Rows:
    """Rows of so many float64, or float32 if they hold the numbers exactly. An empty list or tuple is no rows."""
    if is_empty_sequence(found):
        return np.empty((0, columns), np.float64 if are_doubles else np.float32)
    array = _with_float_rows(found, name, boxes_expected=columns in (4, 6))
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name} has shape {array.shape}; expected (n, {columns})")
    if are_doubles or array.dtype == np.float32:
        return array.astype(np.float64 if are_doubles else np.float32, copy=False)
    with np.errstate(over="ignore"):
        rounded = array.astype(np.float32)
    differs = (rounded != array) & ~np.isnan(array)
    if differs.any():
        row = int(np.flatnonzero(differs.any(axis=1))[0])
        raise ValueError(
            f"{name} is float64, and its row {row}, {array[row].tolist()}, is not exact in float32; expected float32 "
            "here, as the boxes are, or boxes of float64"
        )
    return rounded


def is_empty_sequence(found: Any) -> bool:
    """Whether this is an empty list or tuple, which tells no dimension."""
    return isinstance(found, (list, tuple)) and not found


def _with_float_rows(found: Any, name: str, boxes_expected: bool) -> Rows:
    """An array of float32 or float64 in native byte order, whose rows are in one piece."""
    array = _as_array(found, name, boxes_expected)
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind in "iu":
        array = _exact_floats(array, name)
    elif kind != "f":
        raise TypeError(
            f"{name} has dtype {array.dtype}{_hint(array)}; expected float32 or float64, or integers that float64 holds"
        )
    elif size == 2:
        array = array.astype(np.float32)
    elif size > 8:
        raise TypeError(f"{name} has dtype {array.dtype}; expected float32 or float64, which hold less than it")
    # C-contiguous: the extension takes longer strides from row to row as well, but then these came by another way.
    return np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("="))


def _exact_floats(array: Rows, name: str) -> Rows:
    """Integers as float64; refused where one is not exact in it."""
    floats: Rows = array.astype(np.float64)
    if array.dtype.itemsize == 8:
        # Python compares an integer with a float by value.
        beyond = np.argwhere(np.abs(floats) >= 2.0**53)
        for place in map(tuple, beyond):
            if int(array[place]) != float(floats[place]):
                raise ValueError(
                    f"{name} is {array[place]} in row {place[0]}, which float64 does not hold; expected integers up to "
                    "2**53, or floats"
                )
    return floats


def _hint(array: Rows) -> str:
    if array.dtype.kind == "O" and array.size:
        return f" (its first element is of {type(array.flat[0]).__name__})"
    return ""


def _as_array(found: Any, name: str, boxes_expected: bool) -> Rows:
    bounds = _bounds(found, name) if boxes_expected else None
    if bounds is not None:
        return bounds
    if isinstance(found, np.ndarray):
        array = found
    elif hasattr(found, "__arrow_c_stream__"):
        array = _of_chunks(_core.arrow_chunks(found.__arrow_c_stream__()), name)
    elif hasattr(found, "__arrow_c_array__"):
        array = _of_chunks([_core.arrow_columns(*found.__arrow_c_array__())], name)
    elif hasattr(found, "__array__"):
        array = np.asarray(found)
    elif hasattr(found, "__dlpack__"):
        try:
            array = np.from_dlpack(found)
        except (BufferError, RuntimeError, TypeError) as error:
            raise TypeError(f"{name} cannot be read by DLPack: {error}; expected an array in the CPU's memory") from error
    else:
        array = _of_sequence(found, name)
    if np.ma.isMaskedArray(array) and np.ma.getmaskarray(array).any():
        raise ValueError(f"{name} is a masked array with masked elements; expected a number in each place")
    if array.dtype.names is not None:
        array = _of_columns({column: array[column] for column in array.dtype.names}, name)
    if array.dtype.kind == "O":
        bounds = _bounds_of_geometries(array) if boxes_expected else None
        if bounds is not None:
            return bounds
    return array


def _of_sequence(found: Any, name: str) -> Rows:
    """Nested lists and tuples, and whatever else NumPy makes an array of."""
    if isinstance(found, (str, bytes, dict, set, frozenset)) or found is None:
        raise TypeError(f"{name} is of {type(found).__name__}; expected an array of shape (n, 4) or (n, 6)")
    try:
        array = np.asarray(found)
    except ValueError as error:
        raise ValueError(f"{name} is no array: {error}; expected rows of the same length") from error
    if array.ndim == 0:
        raise TypeError(f"{name} is of {type(found).__name__}; expected an array of shape (n, 4) or (n, 6)")
    return array


def _of_chunks(chunks: list[list[tuple[str, Rows]]], name: str) -> Rows:
    arrays = []
    for columns in chunks:
        if len(columns) == 1 and columns[0][1].ndim == 2:
            arrays.append(columns[0][1])
        else:
            arrays.append(_of_columns(dict(columns), name))
    if not arrays:
        return np.empty((0, 4))
    return arrays[0] if len(arrays) == 1 else np.concatenate(arrays)


def _of_columns(columns: dict[str, Rows], name: str) -> Rows:
    return np.column_stack([columns[column] for column in columns_of_bounds(columns, name)])


def columns_of_bounds(columns: Collection[str], name: str) -> tuple[str, ...]:
    """Which of these columns are the bounds of boxes, minima first."""
    for names in _COLUMN_NAMES:
        # Names that tell nothing must be all there are.
        if all(column in columns for column in names) and (names[0][-1:] != "0" or len(columns) == len(names)):
            return names
    expected = ", ".join(_COLUMN_NAMES[1])
    raise ValueError(
        f"{name} has the columns {', '.join(columns) or 'none'}; expected {expected}, in 3D zmin and zmax as well"
    )


def _bounds(found: Any, name: str) -> Rows | None:
    """The bounds of a GeoDataFrame, a GeoSeries, a geometry array or a pandas DataFrame of bounds."""
    pandas = sys.modules.get("pandas")
    if pandas is None:
        return None
    geometry = getattr(found, "geometry", None) if isinstance(found, (pandas.DataFrame, pandas.Series)) else found
    # A DataFrame may have a column of that name that holds something else.
    if isinstance(geometry, (pandas.Series, pandas.api.extensions.ExtensionArray)):
        bounds = _bounds_of_geometries(np.asarray(geometry, dtype=object), str(geometry.dtype) == "geometry")
        if bounds is not None:
            return bounds
    if isinstance(found, pandas.DataFrame):
        columns = {str(column): found[column].to_numpy() for column in found.columns}
        return _of_columns(columns, name)
    return None


def _bounds_of_geometries(array: Rows, are_known: bool = False) -> Rows | None:
    """The bounds of shapely's geometries; an empty one, or none, is an absent box, which overlaps nothing.

    Unless they `are_known` to be geometries, one at least must be one.
    """
    shapely = sys.modules.get("shapely")
    if shapely is None or array.ndim != 1 or array.dtype.kind != "O":
        return None
    if not are_known:
        are_geometries = shapely.is_geometry(array)
        if not are_geometries.any() or not (are_geometries | (array == None)).all():  # noqa: E711 (element by element)
            return None
    bounds: Rows = shapely.bounds(array)
    missing = shapely.is_missing(array) | shapely.is_empty(array)
    bounds[missing] = (np.inf, np.inf, -np.inf, -np.inf)
    return bounds


def integers(found: Any, name: str, most: int) -> NDArray[np.uint64]:
    """A one-dimensional array of integers from 0 to `most`."""
    array = _as_integers(found)
    if array.ndim == 0:
        array = array.reshape(1)
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}; expected (n,)")
    return _integers(array, name, most)


def pairs_of_integers(found: Any, name: str, most: int) -> NDArray[np.uint64]:
    """An array of two integers a row, from 0 to `most`."""
    array = _as_integers(found)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 2)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} has shape {array.shape}; expected (n, 2)")
    return _integers(array, name, most)


def _as_integers(found: Any) -> Rows:
    """An array; of Python's own integers where NumPy would take a list for floats, as some are above 2**63."""
    array = np.asarray(found)
    if isinstance(found, (list, tuple)) and array.dtype.kind == "f":
        objects = np.asarray(found, dtype=object)
        if _are_integers(objects):
            return objects
    return array


def _are_integers(objects: Rows) -> bool:
    return all(isinstance(element, (int, np.integer)) and not isinstance(element, bool) for element in objects.flat)


def _integers(array: Rows, name: str, most: int) -> NDArray[np.uint64]:
    if array.size == 0:
        return np.ascontiguousarray(array, dtype=np.uint64)
    if array.dtype.kind not in "iu" and not (array.dtype.kind == "O" and _are_integers(array)):
        raise TypeError(f"{name} has dtype {array.dtype}; expected integers")
    if int(array.min()) < 0 or int(array.max()) > most:
        wrong = array.min() if array.min() < 0 else array.max()
        raise ValueError(f"{name} has {wrong}; expected integers from 0 to {most}")
    return np.ascontiguousarray(array, dtype=np.uint64)


def filters(found: Any, count: int, name: str) -> NDArray[np.uint64]:
    """The fields of broadside.filters() as four uint64 a row."""
    array = np.asarray(found)
    if array.dtype != FILTER:
        raise TypeError(f"{name} has dtype {array.dtype}; expected what broadside.filters() gives")
    if array.shape != (count,):
        raise ValueError(f"{name} has shape {array.shape}; expected ({count},), a filter for each box")
    packed = np.empty((count, 4), np.uint64)
    packed[:, 0] = array["category"]
    packed[:, 1] = array["mask"]
    packed[:, 2] = array["group"].astype(np.int64).view(np.uint64)
    packed[:, 3] = array["is_static"] != 0
    return packed

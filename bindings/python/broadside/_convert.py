"""Whatever is an array of boxes, points or numbers, as the arrays that the extension module takes.

The extension calls these functions for what it does not take as it is: arrays of float32 or float64 whose rows are in
one piece it never hands here.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from broadside import _arguments, _columns, _core
from broadside._columns import Choice, Column, Columns
from broadside._errors import InvalidBoxError
from broadside._keys import Keyed

Rows = NDArray[Any]

FILTER = np.dtype([("category", np.uint64), ("mask", np.uint64), ("group", np.int32), ("is_static", np.bool_)])


def boxes(found: Any, name: str, columns: Columns | None = None, or_points: bool = False) -> Rows:
    """Rows of boxes, of float32 or float64. An empty list or tuple is no boxes, in 2D.

    With `or_points`, points are taken as well, as boxes with equal minima and maxima.
    """
    chosen = _columns.checked(columns, name)
    if is_empty_sequence(found):
        return np.empty((0, 4))
    array = _with_float_rows(found, name, _Boxes(name, chosen, or_points))
    if array.ndim != 2 or array.shape[1] not in (4, 6):
        hint = f"; {_columns.NO_BOXES}" if array.shape[1:] in ((), (2,), (3,)) else ""
        raise ValueError(
            f"{name} has shape {array.shape}; expected (n, 4) or (n, 6): the minima of each box, then its maxima{hint}"
        )
    return array


def boxes_or_points(found: Any, name: str, columns: Columns | None) -> Rows:
    """Boxes, or points as they are if they are a plain array of them."""
    if columns is None and type(found) is np.ndarray and found.dtype.kind in "fiu" and found.shape[1:] in ((2,), (3,)):
        return np.ascontiguousarray(_columns.exact(found, name))
    return boxes(found, name, columns, or_points=True)


def valid_boxes(found: Any, name: str, columns: Columns | None, or_points: bool = False) -> Rows:
    """Likewise, or InvalidBoxError."""
    array = boxes(found, name, columns, or_points)
    invalid = _core.invalid_rows(array)
    if invalid.size:
        row = int(invalid[0])
        error = InvalidBoxError(
            f"box {row} is {array[row].tolist()}; expected min <= max on every axis, and no NaN", row, name
        )
        raise explained(error, found, name, columns)
    return array


def explained(error: InvalidBoxError, found: Any, name: str, columns: Columns | None) -> InvalidBoxError:
    """The error about an invalid box, with how many there are and what may be meant."""
    if error.argument != name or error.row is None:
        return error
    shape = _Boxes(name, _columns.checked(columns, name), or_points=True)
    rows = _with_float_rows(found, name, shape)
    invalid = len(_core.invalid_rows(rows))
    counted = f"{invalid} of {len(rows)} rows {'is' if invalid == 1 else 'are'} invalid: " if len(rows) > 1 else ""
    hint = _meant(rows, error.row, 3 * invalid > len(rows), found, shape) if columns is None and invalid else ""
    # With two sets, the text begins with the name of one.
    of, text = f"{name}: ", str(error)
    text = of + counted + text.removeprefix(of) if text.startswith(of) else counted + text
    return InvalidBoxError(text + hint, error.row, name)


def _meant(rows: Rows, row: int, are_many: bool, found: Any, shape: _Boxes) -> str:
    """If many rows are invalid, the meanings of columns by which all would be valid; otherwise what is wrong in one."""
    if are_many:
        plain = rows if shape.are_bounds else found
        ways = [f"columns={way!r}" for way in _columns.OTHER_MEANINGS if _are_valid(plain, rows.shape, shape.name, way)]
        as_array = "as an array without names and with" if shape.are_bounds else "with"
        if ways:
            return f"; all rows would be valid {as_array} {' or '.join(ways)} (check that it is meant)"
    minima, maxima = np.split(rows[row], 2)
    if not np.isfinite(rows[row]).all():
        return ""
    axes = " and ".join("xyz"[axis] for axis in np.flatnonzero(minima > maxima))
    return f" (are its minimum and maximum on {axes} swapped?)"


def _are_valid(found: Any, shape: tuple[int, ...], name: str, columns: Columns) -> bool:
    try:
        rows = boxes(found, name, columns)
        # Names may be fewer than columns; those of boxes in 2D are no meaning of rows in 3D.
        return rows.shape == shape and not _core.invalid_rows(rows).size
    except (TypeError, ValueError):  # another number of columns, or names with another meaning
        return False


def are_points(found: Any, name: str, dimension: int) -> bool:
    """Whether these are rows of points, not of boxes. Geometries count as boxes, which have the bounds of points too."""
    if is_empty_sequence(found):
        return True
    if hasattr(found, "geometry") or hasattr(found, "geom_type"):
        return False
    try:
        if isinstance(found, (list, tuple, np.ndarray)) and (array := np.asarray(found)).dtype.names is None:
            return bool(array.ndim == 2 and array.shape[1] == dimension)
        return bool(_with_float_rows(found, name, _Points(name, dimension)).shape[1] == dimension)
    except (TypeError, ValueError):
        return False


def given(found: Any, name: str, columns: Columns | None, or_points: bool = False) -> Any:
    """The boxes as the extension module takes them; converted if the caller gives `columns`, or if they may be points."""
    if columns is None:
        are_rows = isinstance(found, np.ndarray) and found.shape[1:] in ((4,), (6,))
        if not or_points or are_rows or is_empty_sequence(found):
            return found
    return boxes(found, name, columns, or_points)


def worlds(found: Any, name: str) -> tuple[Rows, NDArray[np.int64]]:
    """The rows of an array of shape (worlds, n, columns), and the offsets of the worlds."""
    array = _as_array(found, name, _Boxes(name, None))
    if array.ndim != 3:
        raise ValueError(
            f"{name} has shape {array.shape} and no offsets are given; expected offsets, or the shape (worlds, n, 4) or "
            "(worlds, n, 6)"
        )
    count, size, columns = array.shape
    return array.reshape(count * size, columns), np.arange(count + 1, dtype=np.int64) * size


def rows_of(found: Any, name: str, columns: int, are_doubles: bool) -> Rows:
    """Rows of so many float64, or float32 if they hold the numbers exactly. An empty list or tuple is no rows."""
    if is_empty_sequence(found):
        return np.empty((0, columns), np.float64 if are_doubles else np.float32)
    array = _with_float_rows(found, name, _Boxes(name, None) if columns in (4, 6) else _Points(name, columns))
    if array.ndim != 2 or array.shape[1] != columns:
        hint = "; for points np.hstack([points, points])" if array.shape[1:] == (columns // 2,) else ""
        raise ValueError(f"{name} has shape {array.shape}; expected (n, {columns}){hint}")
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


class _Boxes:
    """Rows of boxes, made of the columns of a table or of an array."""

    def __init__(self, name: str, columns: str | list[str] | None, or_points: bool = False) -> None:
        self.name = name
        self.columns = columns
        self.or_points = or_points
        self.are_bounds = False
        """Whether these are columns that are called minima and maxima."""

    def choose(self, labels: list[str]) -> Choice:
        choice = _columns.choose(labels, self.name, self.columns, self.or_points)
        self.are_bounds = bool(choice.axes) and all(form == "min_max" for form, _, _ in choice.axes)
        return choice

    def of_columns(self, choice: Choice, columns: list[Column]) -> Rows:
        if choice.axes:
            return _columns.rows_of(choice, columns, self.name)
        return self._of_packed(columns[0])

    def of_grid(self, grid: Column, columns: str | list[str] | None) -> Rows:
        """Rows from columns that have only the names that a caller gives them."""
        count = grid.values.shape[1]
        if columns is None and grid.missing is None:
            are_points = self.or_points and count in (2, 3)
            return grid.values.take([*range(count)] * 2, axis=1) if are_points else grid.values
        choice = _columns.of_places(count, self.name, columns, self.or_points)
        return _columns.rows_of(choice, [grid.part(place) for place in choice.places], self.name)

    def _of_packed(self, column: Column) -> Rows:
        """Rows from one column that has all numbers of a box, such as lists; a missing box is absent."""
        if column.values.ndim == 1:
            missing = np.zeros(len(column.values), np.bool_) if column.missing is None else column.missing
            there = _of_sequence(list(column.values[~missing]), f"column {column.label} of {self.name}", column.values)
            if there.ndim != 2:
                raise TypeError(
                    f"column {column.label} of {self.name} has elements of {there.dtype}; expected four or six numbers each"
                )
            values = np.zeros((len(missing), there.shape[1]), there.dtype)
            values[~missing] = there
            column = Column(column.label, values, np.repeat(missing[:, None], there.shape[1], axis=1))
        return self.of_grid(column, self.columns if isinstance(self.columns, str) else None)


class _Points:
    """Rows of points."""

    columns: str | list[str] | None = None

    def __init__(self, name: str, dimension: int) -> None:
        self.name = name
        self.dimension = dimension

    def choose(self, labels: list[str]) -> Choice:
        return _columns.choose_points(labels, self.name, self.dimension)

    def of_columns(self, choice: Choice, columns: list[Column]) -> Rows:
        return np.column_stack([column.exact(self.name) for column in columns])

    def of_grid(self, grid: Column, columns: str | list[str] | None) -> Rows:
        return _columns.exact(grid.values, self.name, grid.missing)


_Shape = _Boxes | _Points


def _with_float_rows(found: Any, name: str, shape: _Shape) -> Rows:
    """An array of float32 or float64 in native byte order, whose rows are in one piece."""
    array = _columns.exact(_as_array(found, name, shape), name)
    # The extension also takes rows with longer strides, but such arrays do not come this way.
    return np.ascontiguousarray(array)


def _as_array(found: Any, name: str, shape: _Shape) -> Rows:
    rows = _of_frame(found, name, shape)
    if rows is not None:
        return rows
    dask = sys.modules.get("dask")
    if dask is not None and dask.is_dask_collection(found):
        return _as_array(found.compute(), name, shape)
    if isinstance(found, np.ndarray):
        array = found
    elif hasattr(found, "__arrow_c_stream__"):
        return _of_arrow(name, shape, lambda choose: _core.arrow_stream(found.__arrow_c_stream__(), choose))
    elif hasattr(found, "__arrow_c_array__"):
        schema, values = found.__arrow_c_array__()
        return _of_arrow(name, shape, lambda choose: _core.arrow_array(schema, values, choose))
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
        labels = list(array.dtype.names)
        choice = shape.choose(labels)
        columns = [Column(labels[place], array[labels[place]]) for place in choice.places]
        return shape.of_columns(choice, columns)
    if array.dtype.kind == "O" and isinstance(shape, _Boxes):
        bounds = _bounds_of_geometries(array)
        if bounds is not None:
            return bounds
    return shape.of_grid(Column("", array), shape.columns) if array.ndim == 2 else array


def _of_sequence(found: Any, name: str, rows: Any = None) -> Rows:
    """Nested lists and tuples, and whatever else NumPy makes an array of. An error names a row of `rows`."""
    if isinstance(found, (str, bytes, dict, set, frozenset)) or found is None:
        raise TypeError(f"{name} is {_arguments.kind_of(found)}; expected an array of shape (n, 4) or (n, 6)")
    try:
        array = np.asarray(found)
    except ValueError as error:
        what = _ragged(found if rows is None else rows) or f"is no array: {error}"
        raise ValueError(f"{name} {what}; expected rows of the same length") from error
    if array.ndim == 0:
        raise TypeError(f"{name} is {_arguments.kind_of(found)}; expected an array of shape (n, 4) or (n, 6)")
    if array.dtype.kind == "f" and (np.isfinite(array) & (np.abs(array) >= 2.0**53)).any():
        # NumPy has rounded integers that are mixed with floats.
        return np.asarray(found, dtype=object)
    return array


def _ragged(rows: Any) -> str:
    """Which row has another length than the first one; empty if none has."""
    sizes = [(row, len(numbers)) for row, numbers in enumerate(rows) if isinstance(numbers, (list, tuple, np.ndarray))]
    first, size = sizes[0] if sizes else (0, 0)
    wrong = [(row, other) for row, other in sizes if other != size]
    return f"has {size} elements in row {first} and {wrong[0][1]} in row {wrong[0][0]}" if wrong else ""


def _of_arrow(name: str, shape: _Shape, chunks_by: Any) -> Rows:
    """A table, or an array of structs or of lists of a fixed size, in chunks."""
    choice: Choice | None = None
    labels: list[str] = [name]

    def choose(paths: list[list[str]]) -> list[int]:
        nonlocal choice, labels
        labels = [".".join(path) for path in paths]
        choice = shape.choose(labels)
        return choice.places

    chunks: list[list[tuple[Rows, NDArray[np.uint8] | None]]] = chunks_by(choose)
    columns = []
    for place, parts in enumerate(zip(*chunks, strict=True)):
        values = parts[0][0] if len(parts) == 1 else np.concatenate([part for part, _ in parts])
        missing = None
        if any(mask is not None for _, mask in parts):
            masks = [np.zeros(part.size, np.uint8) if mask is None else mask for part, mask in parts]
            missing = np.concatenate(masks).astype(np.bool_).reshape(values.shape)
        columns.append(Column(labels[place if choice is None else choice.places[place]], values, missing))
    if choice is None:
        return shape.of_grid(columns[0], shape.columns)
    return shape.of_columns(choice, columns)


def _of_frame(found: Any, name: str, shape: _Shape) -> Rows | None:
    """The bounds of a GeoDataFrame, a GeoSeries, a geometry array or the columns of a pandas DataFrame."""
    pandas = sys.modules.get("pandas")
    if pandas is None:
        return None
    is_frame = isinstance(found, pandas.DataFrame)
    is_series = isinstance(found, pandas.Series)
    if isinstance(shape, _Boxes) and not (is_frame and shape.columns is not None):
        geometry = getattr(found, "geometry", None) if is_frame or is_series else found
        # A DataFrame may have a column of that name that holds something else.
        if isinstance(geometry, (pandas.Series, pandas.api.extensions.ExtensionArray)):
            bounds = _bounds_of_geometries(np.asarray(geometry, dtype=object), str(geometry.dtype) == "geometry")
            if bounds is not None:
                return bounds
    if isinstance(shape, _Points) and str(getattr(getattr(found, "geometry", None), "dtype", "")) == "geometry":
        return _of_points(np.asarray(found.geometry, dtype=object), shape)
    if is_series and found.dtype == object:  # of lists or dicts
        found, is_frame = found.to_frame("bbox"), True
    elif is_series and not isinstance(found.dtype, pandas.ArrowDtype):
        return np.asarray(found)
    if not is_frame:
        return None
    fields = [(place, key) for place in range(found.shape[1]) for key in _keys_of(found.iloc[:, place])]
    labels = [f"{found.columns[place]}" + ("" if key is None else f".{key}") for place, key in fields]
    choice = shape.choose(labels)
    return shape.of_columns(choice, [_of_series(found, labels[place], *fields[place]) for place in choice.places])


def _keys_of(series: Any) -> list[Any]:
    """The fields of a column of dicts, in which pandas holds structs of Parquet; [None] for any other column."""
    if series.dtype != object:
        return [None]
    first = next((value for value in series.array if value is not None and not isinstance(value, float)), None)
    return list(first) if isinstance(first, dict) else [None]


def _of_series(frame: Any, label: str, place: int, key: Any) -> Column:
    series = frame.iloc[:, place]
    if key is not None:
        series = series.map(lambda row: row.get(key) if isinstance(row, dict) else None)
    missing = series.isna().to_numpy(dtype=np.bool_)
    if not missing.any():
        return Column(label, series.to_numpy())
    there = np.asarray(series.array[~missing])
    values = np.zeros(len(series), there.dtype)
    values[~missing] = there
    return Column(label, values, missing)


def _of_points(array: Rows, shape: _Points) -> Rows:
    """The coordinates of shapely's points."""
    shapely = sys.modules["shapely"]
    others = np.flatnonzero(shapely.is_missing(array) | shapely.is_empty(array) | (shapely.get_type_id(array) != 0))
    if others.size:
        kind = getattr(array[others[0]], "geom_type", "nothing")
        raise TypeError(f"{shape.name} has a {kind} in row {others[0]}; expected a point that is not empty")
    coordinates: Rows = shapely.get_coordinates(array, include_z=shape.dimension == 3)
    return coordinates


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


def crs_of(found: Any) -> Any:
    """The coordinate reference system of a GeoPandas or dask-geopandas object; None if there is none."""
    geopandas = sys.modules.get("geopandas")
    if geopandas is None or isinstance(found, np.ndarray):
        return None
    kinds = (geopandas.GeoDataFrame, geopandas.GeoSeries, geopandas.array.GeometryArray)
    if not isinstance(getattr(found, "_meta", found), kinds):
        return None
    try:
        return found.crs
    except AttributeError:  # of a frame without geometries
        return None


def common_crs(known: Any, known_name: str, found: Any, name: str) -> Any:
    """The coordinate reference system of two sets, which may be None. Raises ValueError if they differ."""
    crs = crs_of(found)
    if crs is None or known is None:
        return known if crs is None else crs
    if crs != known:
        raise ValueError(
            f"{known_name} has the CRS {_name_of_crs(known)} and {name} {_name_of_crs(crs)}; expected one, as to_crs() makes it"
        )
    return known


def _name_of_crs(crs: Any) -> str:
    authority = crs.to_authority()
    return ":".join(authority) if authority else str(crs.name)


def integers(found: Any, name: str, most: int) -> NDArray[np.uint64]:
    """A one-dimensional array of integers from 0 to `most`."""
    array = as_integers(found)
    if array.ndim == 0:
        array = array.reshape(1)
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}; expected (n,)")
    return _integers(array, name, most)


def pairs_of_integers(found: Any, name: str, most: int) -> NDArray[np.uint64]:
    """An array of two integers a row, from 0 to `most`."""
    array = as_integers(found)
    if array.size == 0 and array.ndim < 2:
        array = array.reshape(0, 2)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} has shape {array.shape}; expected (n, 2)")
    return _integers(array, name, most)


def as_integers(found: Any) -> Rows:
    """An array; of Python's own integers where NumPy would take a list for floats, as some are above 2**63."""
    array = np.asarray(found)
    if isinstance(found, (list, tuple, int)) and array.dtype.kind in "fO":
        objects = np.asarray(found, dtype=object)
        if are_integers(objects):
            return objects
    return array


def are_integers(objects: Rows) -> bool:
    """Whether an array of objects holds nothing but integers."""
    return objects.dtype.kind == "O" and all(isinstance(element, (int, np.integer)) and not isinstance(element, bool) for element in objects.flat)


def _integers(array: Rows, name: str, most: int) -> NDArray[np.uint64]:
    if array.size == 0:
        return np.ascontiguousarray(array, dtype=np.uint64)
    if array.dtype.kind not in "iu" and not are_integers(array):
        raise TypeError(f"{name} has dtype {array.dtype}; expected integers")
    if int(array.min()) < 0 or int(array.max()) > most:
        wrong = array.min() if array.min() < 0 else array.max()
        raise ValueError(f"{name} has {wrong}; expected integers from 0 to {most}")
    return np.ascontiguousarray(array, dtype=np.uint64)


def filters(found: Any, count: int, name: str) -> NDArray[np.uint64 | np.int64]:
    """The fields of broadside.filters() as four uint64 a row; those of keys as these have them."""
    if isinstance(found, Keyed):
        if len(found.packed) != count:
            raise ValueError(f"{found.name} has {len(found.packed)} keys for {count} boxes; expected one for each box")
        return found.packed
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


def query_filters(found: Any, count: int, name: str) -> NDArray[np.uint64 | np.int64]:
    """Likewise, or one for all queries."""
    return filters(one_or_each(found, count), count, name)


def one_or_each(found: Any, count: int) -> Any:
    """Filters of queries; one for all is repeated."""
    is_one = found is not None and not isinstance(found, Keyed) and np.shape(found) in ((), (1,))
    return np.broadcast_to(np.asarray(found), (count,)) if is_one else found

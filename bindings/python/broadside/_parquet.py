"""Boxes in Parquet and GeoParquet, which pyarrow reads.

GeoParquet says in its metadata which columns hold the geometries and, perhaps, their bounds (its specification, 1.1,
"covering"). Of any other table the columns' names tell.
"""

from __future__ import annotations

import json
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from broadside import _convert, _core
from broadside._errors import FileError

Rows = NDArray[Any]

_MAGIC = b"PAR1"
_EXTENSIONS = (b".parquet", b".geoparquet", b".pq")

# As in the columns of CSV (docs/formats.md), whose first way this is: words for a bound, before an axis or behind it, and
# words that name the axis as well.
_MINIMUM = ("min", "minimum", "lower", "low", "lo")
_MAXIMUM = ("max", "maximum", "upper", "high", "hi")
_AXES = (("x", "lon", "long", "lng", "longitude"), ("y", "lat", "latitude"), ("z",))
_WHOLE = {"left": (0, 0), "west": (0, 0), "bottom": (0, 1), "south": (0, 1)}
_WHOLE |= {"right": (1, 0), "east": (1, 0), "top": (1, 1), "north": (1, 1)}
_MEANINGS = _WHOLE | {
    name: (bound, axis)
    for bound, words in enumerate((_MINIMUM, _MAXIMUM))
    for word in words
    for axis, letters in enumerate(_AXES)
    for letter in letters
    for name in (word + letter, letter + word)
}


def recognises(path: bytes, format: str) -> bool:
    """Whether a file is to be read as Parquet: by the format that the caller names, else by its content and name."""
    if format:
        return format == "parquet"
    with open(path, "rb") as file:
        beginning = file.read(len(_MAGIC))
    return beginning == _MAGIC or path.lower().endswith(_EXTENSIONS)


def read(path: bytes, shown: str, dimension: int, quarantine: bool) -> tuple[Rows, str]:
    """The boxes of a file, and what was wrong with it and left out; `dimension` is 0 where the file decides."""
    try:
        pyarrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError as error:
        raise ImportError(f"{shown}: is Parquet, which pyarrow reads; expected it installed: pip install pyarrow") from error
    try:
        with open(path, "rb") as stream, parquet.ParquetFile(stream) as file:
            return _read(file, shown, dimension, quarantine)
    except (pyarrow.ArrowException, OSError) as error:
        raise FileError(f"{shown}: cannot be read as Parquet: {error}") from error


def _read(file: Any, shown: str, dimension: int, quarantine: bool) -> tuple[Rows, str]:
    geometry = _geometry(file.schema_arrow.metadata or {}, shown)
    if geometry is None:
        bounds = _bounds_by_name(file, shown, dimension)
        array, invalid = _of_columns(file, bounds, shown, empty_is_absent=False)
        source = f"the columns {', '.join('.'.join(path) for path in bounds)}"
    elif (covering := geometry.get("covering", {}).get("bbox")) is not None:
        bounds = _bounds_of_covering(covering, shown, dimension)
        # What has no extent, a geometry that is empty or null, has bounds that are null or NaN.
        array, invalid = _of_columns(file, bounds, shown, empty_is_absent=True)
        source = f"the covering {covering['xmin'][0]}"
    else:
        array, invalid = _of_geometries(file, geometry, shown, dimension), np.empty(0, np.int64)
        source = f"the geometries {geometry['name']}"
    invalid = np.union1d(invalid, _core.invalid_rows(array)).astype(np.int64)
    if not invalid.size:
        return array, ""
    row = int(invalid[0])
    fault = f"{shown}: row {row} of {source} is {array[row].tolist()}; expected min <= max on every axis, no NaN and no null"
    if not quarantine:
        raise FileError(fault)
    half = array.shape[1] // 2
    array[invalid, :half], array[invalid, half:] = np.inf, -np.inf
    return array, f"{shown}: left out {invalid.size} invalid boxes\n{fault}"


def _geometry(metadata: dict[bytes, bytes], shown: str) -> dict[str, Any] | None:
    """What GeoParquet's metadata say of its primary column, with its `name`; None where there are none."""
    text = metadata.get(b"geo")
    if text is None:
        return None
    try:
        geo = json.loads(text)
        name = geo["primary_column"]
        column = dict(geo["columns"][name])
        covering = column.get("covering", {}).get("bbox", {})
        if not all(isinstance(path, list) and all(isinstance(part, str) for part in path) for path in covering.values()):
            raise ValueError("a covering that is no path of columns")
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise FileError(
            f"{shown}: has metadata of GeoParquet that name no column ({type(error).__name__}: {error}); expected "
            "primary_column, and columns with it"
        ) from error
    return column | {"name": name}


def _bounds_of_covering(covering: dict[str, list[str]], shown: str, dimension: int) -> list[list[str]]:
    axes = "xyz" if "zmin" in covering and dimension != 2 else "xy"
    if dimension == 3 and axes == "xy":
        raise FileError(f"{shown}: has a covering in 2D; expected boxes in 3D")
    names = [axis + bound for bound in ("min", "max") for axis in axes]
    missing = [name for name in names if name not in covering]
    if missing:
        raise FileError(f"{shown}: has a covering without {', '.join(missing)}; expected {', '.join(names)}")
    return [covering[name] for name in names]


def _bounds_by_name(file: Any, shown: str, dimension: int) -> list[list[str]]:
    """The columns that are the bounds, minima first."""
    found: dict[tuple[int, int], list[str]] = {}
    columns = [path for field in file.schema_arrow for path in _paths(field)]
    for path in columns:
        plain = "".join(path).translate(str.maketrans("", "", "_-. ")).lower()
        for prefix in ("bbox", "bb", ""):
            meaning = _MEANINGS.get(plain.removeprefix(prefix))
            if meaning is None:
                continue
            if meaning in found:
                raise FileError(
                    f"{shown}: has the columns {'.'.join(found[meaning])} and {'.'.join(path)} for one bound; expected one"
                )
            found[meaning] = path
            break
    has_z = (0, 2) in found and (1, 2) in found and dimension != 2
    wanted = [(bound, axis) for bound in (0, 1) for axis in range(3 if has_z or dimension == 3 else 2)]
    if any(meaning not in found for meaning in wanted):
        raise FileError(
            f"{shown}: has the columns {', '.join('.'.join(path) for path in columns) or 'none'}; expected GeoParquet, or "
            "bounds: min_x, min_y, max_x, max_y, in 3D min_z and max_z as well"
        )
    return [found[meaning] for meaning in wanted]


def _paths(field: Any) -> list[list[str]]:
    """A column's path, or those of a struct's fields."""
    if field.type.num_fields and str(field.type).startswith("struct"):
        return [[field.name, *rest] for inner in field.type for rest in _paths(inner)]
    return [[field.name]]


def _of_columns(file: Any, bounds: list[list[str]], shown: str, empty_is_absent: bool) -> tuple[Rows, Rows]:
    """The boxes of columns of numbers, and the rows whose boxes are there in part. One without any number is absent."""
    table = file.read(columns=sorted({path[0] for path in bounds}), use_threads=True)
    numbers, gaps = [], []
    for path in bounds:
        column = _column(table, path, shown)
        values = column.to_numpy()
        if values.dtype.kind not in "iuf":
            raise FileError(f"{shown}: has {'.'.join(path)} of type {column.type}; expected numbers")
        nulls = column.is_null().to_numpy().astype(bool)
        if values.dtype.kind in "iu":
            try:
                values = _convert._exact_floats(values, f"{shown}: {'.'.join(path)}")
            except ValueError as error:
                raise FileError(str(error)) from None
        numbers.append(values)
        gaps.append(nulls | np.isnan(values) if empty_is_absent else nulls)
    # Of half precision there is no search.
    dtype = np.result_type(np.float32, *numbers)
    array = np.column_stack(numbers).astype(dtype, copy=False)
    missing = np.column_stack(gaps)
    half = array.shape[1] // 2
    absent = missing.all(axis=1)
    array[absent, :half], array[absent, half:] = np.inf, -np.inf
    return np.ascontiguousarray(array), np.flatnonzero(missing.any(axis=1) & ~absent)


def _column(table: Any, path: list[str], shown: str) -> Any:
    """A column, or a struct's field, as one array; of integers with nulls the nulls come as NaN."""
    pyarrow, compute = import_module("pyarrow"), import_module("pyarrow.compute")
    name = ".".join(path)
    if path[0] not in table.column_names:
        raise FileError(f"{shown}: has no column {name}; expected it, as the file's metadata name it")
    column = table.column(path[0])
    for part in path[1:]:
        if not pyarrow.types.is_struct(column.type) or column.type.get_field_index(part) < 0:
            raise FileError(f"{shown}: has no column {name}; expected it, as the file's metadata name it")
        column = compute.struct_field(column, part)
    if pyarrow.types.is_integer(column.type) and column.null_count:
        column = column.cast(pyarrow.float64())
    return column


def _of_geometries(file: Any, geometry: dict[str, Any], shown: str, dimension: int) -> Rows:
    """The bounds of geometries in well-known binary, in 2D; of an empty one, or none, an absent box."""
    name, encoding = geometry["name"], geometry.get("encoding")
    if encoding != "WKB":
        raise FileError(f"{shown}: has the geometries {name} in the encoding {encoding!r}; expected WKB, or a covering")
    if dimension == 3:
        raise FileError(f"{shown}: has geometries in WKB, whose bounds are taken in 2D; expected a covering with zmin and zmax")
    try:
        shapely = import_module("shapely")
    except ImportError as error:
        raise ImportError(
            f"{shown}: has geometries and no covering of them, whose bounds shapely computes; expected it installed: "
            "pip install shapely"
        ) from error
    if name not in file.schema_arrow.names:
        raise FileError(f"{shown}: has no column {name}; expected it, as the file's metadata name it")
    texts = file.read(columns=[name], use_threads=True).column(name).to_numpy()
    try:
        geometries = shapely.from_wkb(texts)
    except (shapely.errors.GEOSException, TypeError) as error:
        raise FileError(f"{shown}: has {name} that is no well-known binary: {error}") from error
    bounds: Rows = shapely.bounds(geometries)
    missing = shapely.is_missing(geometries) | shapely.is_empty(geometries)
    bounds[missing] = (np.inf, np.inf, -np.inf, -np.inf)
    return bounds

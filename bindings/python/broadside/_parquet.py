"""Boxes in Parquet and GeoParquet, which pyarrow reads.

GeoParquet says in its metadata which columns hold the geometries and, perhaps, their bounds (its specification, 1.1,
"covering"). Of any other table the columns' names tell.
"""

from __future__ import annotations

import json
import os
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from broadside import _columns, _convert, _core
from broadside._errors import FileError

Rows = NDArray[Any]

Content = bytes | bytearray | memoryview

_MAGIC = b"PAR1"
_EXTENSIONS = (b".parquet", b".geoparquet", b".pq")

def recognises(path: bytes, content: Content | None, format: str) -> bool:
    """Whether a file is to be read as Parquet: by the format that the caller names, else by its content and name."""
    if format:
        return format == "parquet"
    if content is not None:
        beginning = bytes(content[: len(_MAGIC)])
    else:
        with open(path, "rb") as file:
            beginning = file.read(len(_MAGIC))
    return beginning == _MAGIC or path.lower().endswith(_EXTENSIONS)


def read(
    path: bytes, content: Content | None, columns: str | list[str] | None, dimension: int, quarantine: bool
) -> tuple[Rows, str]:
    """The boxes of a file, and what was wrong with it and left out; `dimension` is 0 where the file decides."""
    shown = os.fsdecode(path)
    try:
        pyarrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError as error:
        raise ImportError(f"{shown}: is Parquet, which pyarrow reads; expected it installed: pip install pyarrow") from error
    try:
        with open(path, "rb") if content is None else pyarrow.BufferReader(content) as stream:
            with parquet.ParquetFile(stream) as file:
                return _read(file, shown, columns, dimension, quarantine)
    except (pyarrow.ArrowException, OSError) as error:
        raise FileError(f"{shown}: cannot be read as Parquet: {error}") from error


def _read(
    file: Any, shown: str, columns: str | list[str] | None, dimension: int, quarantine: bool
) -> tuple[Rows, str]:
    geometry = _geometry(file.schema_arrow.metadata or {}, shown) if columns is None else None
    if geometry is None:
        array, source = _by_name(file, shown, columns, dimension)
    elif (covering := geometry.get("covering", {}).get("bbox")) is not None:
        array, source = _of_covering(file, covering, shown, dimension), f"the covering {covering['xmin'][0]}"
    else:
        array, source = _of_geometries(file, geometry, shown, dimension), f"the geometries {geometry['name']}"
    invalid = _core.invalid_rows(array)
    if not invalid.size:
        return array, ""
    row = int(invalid[0])
    fault = f"{shown}: row {row} of {source} is {array[row].tolist()}; expected min <= max on every axis, no NaN and no null"
    if not quarantine:
        raise FileError(fault)
    _make_absent(array, invalid)
    return array, f"{shown}: left out {invalid.size} invalid boxes\n{fault}"


def _make_absent(array: Rows, rows: Rows) -> None:
    half = array.shape[1] // 2
    array[rows, :half], array[rows, half:] = np.inf, -np.inf


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


def _of_covering(file: Any, covering: dict[str, list[str]], shown: str, dimension: int) -> Rows:
    """The bounds that the metadata name. An empty or missing geometry has bounds of null or NaN."""
    axes = "xyz" if "zmin" in covering and dimension != 2 else "xy"
    if dimension == 3 and axes == "xy":
        raise FileError(f"{shown}: has a covering in 2D; expected boxes in 3D")
    names = [axis + bound for bound in ("min", "max") for axis in axes]
    missing = [name for name in names if name not in covering]
    if missing:
        raise FileError(f"{shown}: has a covering without {', '.join(missing)}; expected {', '.join(names)}")
    there = _paths_of(file)
    for name in names:
        if covering[name] not in there:
            raise FileError(
                f"{shown}: has no column {'.'.join(covering[name])}; expected it, as the file's metadata name it"
            )
    array = _rows_of(file, shown, [covering[name] for name in names], [".".join(covering[name]) for name in names])
    _make_absent(array, np.flatnonzero(np.isnan(array).all(axis=1)))
    return array


def _by_name(file: Any, shown: str, columns: str | list[str] | None, dimension: int) -> tuple[Rows, str]:
    """The bounds found by the columns' names, and the text that names these columns."""
    paths = _paths_of(file)
    try:
        choice = _columns.choose([".".join(path) for path in paths], shown, columns)
    except ValueError as error:
        raise FileError(str(error)) from None
    chosen = [paths[place] for place in choice.places]
    array = _rows_of(file, shown, chosen, columns)
    source = f"the columns {', '.join('.'.join(path) for path in chosen)}"
    if dimension == 2 and array.shape[1] == 6:
        array = np.ascontiguousarray(array[:, [0, 1, 3, 4]])
    if dimension == 3 and array.shape[1] == 4:
        raise FileError(f"{shown}: has {source}; expected boxes in 3D, with min_z and max_z as well")
    return array, source


def _paths_of(file: Any) -> list[list[str]]:
    """The path of each column, or of each field of a struct."""
    return [path for field in file.schema_arrow for path in _paths(field)]


def _paths(field: Any) -> list[list[str]]:
    if field.type.num_fields and str(field.type).startswith("struct"):
        return [[field.name, *rest] for inner in field.type for rest in _paths(inner)]
    return [[field.name]]


def _rows_of(file: Any, shown: str, paths: list[list[str]], columns: str | list[str] | None) -> Rows:
    """The boxes of these columns, the only ones that are read."""
    table = file.read(columns=sorted({path[0] for path in paths}), use_threads=True)
    try:
        return _convert.boxes(table, shown, columns)
    except (TypeError, ValueError) as error:
        raise FileError(f"{shown}: {error}") from None


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

"""Tables of boxes: finds the columns of bounds and makes rows of them.

The extension module has the table of known names, which is the same for CSV, Parquet, data frames and Arrow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from numbers import Integral, Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from broadside import _arguments, _core

Rows = NDArray[Any]

Columns = str | Sequence[str]

# The meaning of the numbers in a row, for an array without names or if the caller says so.
_CONVENTIONS = {
    "xyxy": ("xmin", "ymin", "xmax", "ymax"),
    "xywh": ("xmin", "ymin", "width", "height"),
    "cxcywh": ("cx", "cy", "width", "height"),
    "xyzxyz": ("xmin", "ymin", "zmin", "xmax", "ymax", "zmax"),
    "xyzwhd": ("xmin", "ymin", "zmin", "width", "height", "depth"),
    "cxcyczwhd": ("cx", "cy", "cz", "width", "height", "depth"),
}
# What rows without names may be other than minima and maxima, the more telling first: almost any positive numbers are
# valid as corners or centres and sizes.
OTHER_MEANINGS: list[str | list[str]] = [
    ["xmin", "xmax", "ymin", "ymax"],
    ["xmin", "ymax", "xmax", "ymin"],
    ["xmin", "xmax", "ymin", "ymax", "zmin", "zmax"],
    *(name for name, names in _CONVENTIONS.items() if "width" in names),
]

# The default names of an array's columns in pandas and polars. They have no meaning, so a table must have only these.
_NAMES_OF_PLACES = [[f"{prefix}{i}" for i in range(count)] for prefix in ("", "column_") for count in (2, 3, 4, 6)]

NO_BOXES = (
    "for points say within=, or use nearest_pairs(); for intervals use intervals(); as boxes, points are "
    "np.hstack([points, points])"
)

_EXPECTED = "xmin, ymin, xmax, ymax, in 3D zmin and zmax as well, or columns= to say which they are, such as columns='xywh'"


@dataclass(frozen=True)
class Choice:
    """Chosen columns by their places in a table, and for each axis its form and the two columns that give its bounds.

    Without axes, one column has all numbers of a box.
    """

    places: list[int]
    axes: list[tuple[str, int, int]]


class Column(NamedTuple):
    """The values of a column, or of several as rows, as they are in the table."""

    label: str
    values: Rows
    missing: NDArray[np.bool_] | None = None
    """True where a value is missing; None if no value is missing."""

    def part(self, place: int) -> Column:
        """One of several columns."""
        missing = None if self.missing is None else self.missing[:, place]
        return Column(f"{self.label}[{place}]", self.values[:, place], missing)

    def exact(self, name: str) -> Rows:
        """The values as `exact` makes them."""
        return exact(self.values, f"column {self.label} of {name}", self.missing)


def checked(columns: Columns | None, name: str) -> str | list[str] | None:
    """The caller's argument `columns`, checked: None, a convention, or a list of names."""
    if columns is None:
        return None
    if isinstance(columns, str):
        if columns in _CONVENTIONS:
            return columns
        if "," in columns or "=" in columns:
            return [part.strip() for part in columns.split(",")]
        raise ValueError(
            f"the columns of {name} are {columns!r}; expected one of {', '.join(_CONVENTIONS)}, or a list of names"
        )
    if not isinstance(columns, Sequence) or not all(isinstance(column, str) for column in columns):
        raise TypeError(f"the columns of {name} are {columns!r}; expected a str or a list of names")
    return list(columns)


def choose(labels: Sequence[str], name: str, columns: str | list[str] | None, or_points: bool = False) -> Choice:
    """The columns of bounds among those of a table; with `or_points` also those of points, as boxes."""
    if list(labels) in _NAMES_OF_PLACES and not (isinstance(columns, list) and set(columns) <= set(labels)):
        return of_places(len(labels), name, columns, or_points)
    places = _points_among(labels, name, columns) if or_points else []
    if places:
        return _as_boxes(places)
    if isinstance(columns, list):
        return _named(labels, name, columns)
    # In a convention with centres, x and y are the centre.
    renamed = {"x": "cx", "y": "cy", "z": "cz"} if columns is not None and columns.startswith("c") else {}
    choice, problem = _resolved([renamed.get(label.lower(), label) for label in labels], columns is not None)
    if choice is not None and (columns is None or not choice.axes or _forms(choice) == _forms_of(columns)):
        return choice
    expected = _EXPECTED + _hint(len(labels)) if columns is None else f"columns of {columns!r}, as columns says"
    raise ValueError(f"{name} {_has(labels)}{f' ({problem})' if problem and labels else ''}; expected {expected}")


def choose_points(labels: Sequence[str], name: str, dimension: int) -> Choice:
    """The columns of points among those of a table: by known names, or all if there are `dimension`."""
    _, _, axes, _ = _core.resolve_columns(list(labels), False)
    places = [place for form, place, _ in axes if form == "point"] if axes else _order_of_point(labels)
    if len(places) != dimension:
        raise ValueError(f"{name} {_has(labels)}; expected {', '.join('xyz'[:dimension])}")
    return Choice(places, [])


def of_places(count: int, name: str, columns: str | list[str] | None, or_points: bool = False) -> Choice:
    """The columns of an array, which have only the names that a caller gives them."""
    if columns is None:
        if count in (2, 3) and or_points:
            return _as_boxes(list(range(count)))
        if count not in (4, 6):
            raise ValueError(f"{name} has {count} columns without a meaning; expected {_EXPECTED}{_hint(count)}")
        columns = "xyzxyz" if count == 6 else "xyxy"
    names = list(_CONVENTIONS[columns]) if isinstance(columns, str) else columns
    if len(names) > count or isinstance(columns, str) and len(names) != count:
        raise ValueError(f"{name} has {count} columns, and columns is {columns!r}; expected {len(names)} columns")
    order = _order_of_point(names) if or_points else []
    return _as_boxes(order) if order else _meant(names, name)


def _points_among(labels: Sequence[str], name: str, columns: str | list[str] | None) -> list[int]:
    """The places of the columns of points, x first; none if the columns are of boxes or intervals."""
    if isinstance(columns, list):
        order = _order_of_point(columns)
        places = _places_of(columns, labels, name) if order else []
        return [places[place] for place in order]
    if columns is not None:
        return []
    _, _, axes, geometry = _core.resolve_columns(list(labels), False)
    if axes or geometry >= 0:
        return [place for _, place, _ in axes] if all(form == "point" for form, _, _ in axes) else []
    order = _order_of_point(labels)
    # Of three names without a meaning, one may be that of an id.
    return order if len(labels) == 2 or order and _core.axis_of(labels[0]) >= 0 else []


def _order_of_point(names: Sequence[str]) -> list[int]:
    """The places of a point's coordinates among two or three names, x first; none if they cannot be a point's.

    The names of a point have no meaning, or each is that of another axis.
    """
    axes = [_core.axis_of(name) for name in names] if len(names) in (2, 3) else []
    if sorted(axes) == list(range(len(axes))):
        return [axes.index(axis) for axis in range(len(axes))]
    return list(range(len(axes))) if all(axis < 0 for axis in axes) else []


def _as_boxes(places: list[int]) -> Choice:
    """The choice of columns of points as those of boxes."""
    return Choice(places, [("point", place, -1) for place in range(len(places))])


def _has(labels: Sequence[str]) -> str:
    return f"has the columns {', '.join(labels)}" if labels else "has no columns"


def _hint(count: int) -> str:
    return f"; {NO_BOXES}" if count in (2, 3) else ""


def _named(labels: Sequence[str], name: str, columns: list[str]) -> Choice:
    places = _places_of(columns, labels, name)
    # Four or six names without a meaning stand for the bounds in order.
    has_meaning = len(columns) not in (4, 6) or _resolved(columns, True)[0] is not None
    choice = _meant(columns, name) if has_meaning else of_places(len(columns), name, None)
    return Choice([places[place] for place in choice.places], choice.axes)


def _places_of(columns: list[str], labels: Sequence[str], name: str) -> list[int]:
    places = []
    for column in columns:
        there = [place for place, label in enumerate(labels) if label == column]
        if len(there) != 1:
            found = f"has {len(there)} columns {column}" if there else _has(labels)
            raise ValueError(f"{name} {found}; expected one column {column}")
        places += there
    return places


def _meant(columns: list[str], name: str) -> Choice:
    """The choice of columns by the names that a caller gives them."""
    choice, problem = _resolved(columns, True)
    if choice is None:
        expected = _EXPECTED + _hint(len(columns))
        raise ValueError(f"the columns of {name} are {', '.join(columns)}: {problem}; expected {expected}")
    return choice


def _forms(choice: Choice) -> list[str]:
    return ["min_max" if form == "bottom_top" else form for form, _, _ in choice.axes]


def _forms_of(convention: str) -> list[str]:
    choice, _ = _resolved(list(_CONVENTIONS[convention]), True)
    return [] if choice is None else _forms(choice)


def _resolved(labels: list[str], are_chosen: bool) -> tuple[Choice | None, str]:
    """The choice of columns by their names, or the problem with these names."""
    # A table in memory has no frames, so a column of this name is ignored.
    names = ["-" if label.lower() == "frame" else label for label in labels]
    problem, _, axes, geometry = _core.resolve_columns(names, are_chosen)
    if problem:
        return None, problem
    if geometry >= 0:
        return Choice([geometry], []), ""
    if not are_chosen and all(form == "point" for form, _, _ in axes):
        return None, "points, without bounds"
    places = sorted({place for _, *both in axes for place in both if place >= 0})
    at = {place: i for i, place in enumerate(places)}
    return Choice(places, [(form, at.get(first, -1), at.get(second, -1)) for form, first, second in axes]), ""


def rows_of(choice: Choice, columns: list[Column], name: str) -> Rows:
    """The bounds as rows. A row without any value is an absent box; in a row with some values, the others are NaN."""
    numbers = [column.exact(name) for column in columns]
    bounds = [_bounds_on(axis, numbers) for axis in choice.axes]
    rows = np.column_stack([minimum for minimum, _ in bounds] + [maximum for _, maximum in bounds])
    if any(column.missing is not None for column in columns):
        masks = [np.zeros(len(rows), np.bool_) if column.missing is None else column.missing for column in columns]
        absent = np.logical_and.reduce(masks)
        rows[absent, : len(bounds)], rows[absent, len(bounds) :] = np.inf, -np.inf
    return rows


def _bounds_on(axis: tuple[str, int, int], numbers: list[Rows]) -> tuple[Rows, Rows]:
    form, first, second = axis
    if form == "flat":
        return np.zeros(len(numbers[0])), np.zeros(len(numbers[0]))
    a, b = numbers[first], numbers[second]
    if form == "min_max":
        return a, b
    if form == "point":
        return a, a
    if form == "bottom_top":
        # On a screen y grows downwards: the first row in which the two differ tells, as in files.
        told = np.flatnonzero((a != b) & np.isfinite(a) & np.isfinite(b))[:1]
        return (b, a) if (b[told] < a[told]).any() else (a, b)
    # In double, as for files. Infinities and NaN make an invalid box.
    a, b = a.astype(np.float64, copy=False), b.astype(np.float64, copy=False)
    with np.errstate(invalid="ignore", over="ignore"):
        if form == "min_size":
            return a, a + b
        half = b / 2 if form == "centre_size" else b
        return a - half, a + half


def exact(array: Rows, what: str, missing: NDArray[np.bool_] | None = None) -> Rows:
    """Numbers as float32 or float64, which must hold them exactly; NaN where missing. Decimal fractions are rounded."""
    if missing is not None:
        array = array.copy()
        array[missing] = 0
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind == "O":
        floats = _of_objects(array, what)
    elif kind in "iu":
        floats = _of_integers(array, what)
    elif kind != "f":
        raise TypeError(f"{what} has dtype {array.dtype}; expected float32 or float64, or integers that float64 holds")
    elif size > 8:
        raise TypeError(f"{what} has dtype {array.dtype}; expected float32 or float64, which hold less than it")
    else:
        floats = array.astype(np.float32 if size == 2 else array.dtype.newbyteorder("="), copy=False)
    if missing is not None:
        floats[missing] = np.nan
    return floats


def _of_integers(array: Rows, what: str) -> Rows:
    floats: Rows = array.astype(np.float64)
    if array.dtype.itemsize == 8:
        # Python compares an integer with a float by value.
        for place in map(tuple, np.argwhere(np.abs(floats) >= 2.0**53)):
            if int(array[place]) != float(floats[place]):
                raise ValueError(_not_held(what, array[place], place))
    return floats


def _of_objects(array: Rows, what: str) -> Rows:
    floats = np.empty(array.shape)
    for place, element in np.ndenumerate(array):
        if not isinstance(element, (Real, Decimal)) or isinstance(element, (bool, np.bool_, np.longdouble)):
            raise TypeError(
                f"{what} has dtype object (its element in row {place[0]} is {_arguments.kind_of(element)}); expected "
                "float32 or float64, or integers that float64 holds"
            )
        try:
            floats[place] = element
        except OverflowError:
            raise ValueError(_not_held(what, element, place)) from None
        whole = isinstance(element, Integral) or abs(floats[place]) >= 2.0**53
        if whole and element != float(floats[place]):
            raise ValueError(_not_held(what, element, place))
    return floats


def _not_held(what: str, number: object, place: tuple[int, ...]) -> str:
    return (
        f"{what} is {number} in row {place[0]}, which float64 does not hold; expected integers up to 2**53, or floats"
    )

"""Keys of boxes, such as an image or a class, as filters by which only equal or only unequal ones pair."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from broadside import _arguments, _core

_EXPECTED = "expected integers, strings or categories"
_MOST = 2**31 - 2


@dataclass(frozen=True)
class Keyed:
    """Filters made of keys, as the extension module takes them: four uint64 a row, or an int64, a group alone."""

    name: str
    packed: NDArray[np.uint64 | np.int64]

    def __getitem__(self, rows: NDArray[np.uint32]) -> Keyed:
        return Keyed(self.name, self.packed[rows])


@dataclass(frozen=True)
class _Keys:
    """Keys of one set: integers or strings, or the places of each box's in these."""

    values: NDArray[Any]
    codes: NDArray[Any] | None = None


def with_keys(
    filters: Any, other_filters: Any, same: Any, different: Any, boxes: Any, other: Any
) -> tuple[Any, Any, Any]:
    """The filters of both sets, with those of the keys; with both kinds of keys, also those that must differ."""
    if same is None and different is None:
        return filters, other_filters, None
    name = "different" if same is None else "same"
    sets = [boxes] if other is None else [boxes, other]
    groups = groups_of(different if same is None else same, name, sets)
    given = ((filters, "filters"), (other_filters, "other_filters"))
    made = [_keyed(group, *old, name) for group, old in zip(groups, given, strict=False)]
    also_different = None if same is None or different is None else tuple(groups_of(different, "different", sets))
    return made[0], other_filters if other is None else made[1], also_different


def groups_of(given: Any, name: str, sets: list[Any]) -> list[NDArray[np.int64]]:
    """The numbers of the keys of each set; of several keys, those of each combination."""
    is_of_each = isinstance(given, (tuple, list)) and len(given) == 2 and not (isinstance(given, list) and _is_name(given[0]))
    if len(sets) == 2 and not is_of_each and not _are_names(given):
        raise TypeError(
            f"{name} has keys for one set of boxes ({_arguments.kind_of(given)}), and two sets are given; expected those of "
            f"both, {name}=(keys_of_boxes, keys_of_other)"
        )
    of_sets = given if len(sets) == 2 and is_of_each else [given] * len(sets)
    parts = [_parts(keys, table, name) for keys, table in zip(of_sets, sets, strict=True)]
    if len({len(part) for part in parts}) > 1:
        raise ValueError(f"{name} has {len(parts[0])} keys for a box and {len(parts[1])} for one of other; expected as many")
    numbers = [_groups([_plain(keys, name) for keys in both], name) for both in zip(*parts, strict=True)]
    groups = numbers[0]
    for more in numbers[1:]:
        for group, part in zip(groups, more, strict=True):
            if len(group) != len(part):
                raise ValueError(f"{name} has {len(group)} and {len(part)} keys; expected one of each for each box")
        # Both are below 2**31.
        groups = _numbers([group << 31 | part for group, part in zip(groups, more, strict=True)], name)
    return groups


def rows_by_group(groups: NDArray[np.int64]) -> dict[int, NDArray[np.uint32]]:
    """The rows of each group, ascending."""
    order = np.argsort(groups, kind="stable").astype(np.uint32)
    starts = np.flatnonzero(np.diff(groups[order], prepend=0))  # a group is positive
    return {int(groups[rows[0]]): rows for rows in np.split(order, starts[1:]) if rows.size}


def _is_name(keys: Any) -> bool:
    return isinstance(keys, str)


def _are_names(keys: Any) -> bool:
    """Whether this may be the name of a column, or several."""
    return _is_name(keys) or isinstance(keys, (list, tuple)) and len(keys) > 0 and all(map(_is_name, keys))


def _parts(keys: Any, table: Any, name: str) -> list[Any]:
    """The arrays of keys: one, or several that are one key together, such as the columns of a table."""
    labels = _labels(table)
    if isinstance(keys, str):
        if keys not in labels:
            raise TypeError(f"{name} is {keys!r}, which no column of the boxes is called; {_EXPECTED}, one for each box")
        return [table[keys]]
    if labels and _are_names(keys) and set(keys) <= set(labels):
        return [table[label] for label in keys]
    if isinstance(keys, tuple) and keys and not any(isinstance(one, (str, bytes)) or np.ndim(one) == 0 for one in keys):
        return list(keys)
    columns = _labels(keys)
    return [keys[label] for label in columns] if columns else [keys]


def _labels(table: Any) -> list[Any]:
    """The names of a table's columns; none of anything else."""
    if isinstance(table, np.ndarray):
        return list(table.dtype.names or [])
    if not hasattr(table, "columns") or not hasattr(table, "__getitem__"):
        return []
    return list(table.column_names if hasattr(table, "column_names") else table.columns)


def _plain(keys: Any, name: str) -> _Keys:
    """Keys as integers or strings."""
    is_arrow = hasattr(keys, "to_numpy") and hasattr(keys, "null_count") and hasattr(keys, "type")
    coded = _coded_by_arrow(keys) if is_arrow else _coded_by_pandas(keys)
    if coded is not None:
        codes, categories = coded
        if (codes < 0).any():
            raise ValueError(f"{name} has no key in row {int((codes < 0).argmax())}; {_EXPECTED}")
        return _Keys(_values(categories, name), codes)
    return _Keys(_values(keys.to_numpy(zero_copy_only=False) if is_arrow else keys, name))


def _coded_by_arrow(keys: Any) -> tuple[NDArray[Any], Any] | None:
    """Strings and dictionaries of pyarrow as codes, -1 for null, and the categories; None for other keys."""
    if not str(keys.type).startswith(("string", "large_string", "dictionary")) or len(keys) == 0:
        return None
    encoded = keys.dictionary_encode()
    if hasattr(encoded, "chunks"):
        encoded = encoded.combine_chunks()
    codes = encoded.indices.fill_null(-1).to_numpy(zero_copy_only=False)
    return codes, encoded.dictionary.to_numpy(zero_copy_only=False)


def _coded_by_pandas(keys: Any) -> tuple[NDArray[Any], Any] | None:
    """Categories and strings of pandas as codes, -1 if missing, and the categories; None for other keys."""
    categorical = getattr(keys, "cat", keys)  # of a Series, or a Categorical
    codes, categories = getattr(categorical, "codes", None), getattr(categorical, "categories", None)
    if codes is not None and categories is not None:
        return np.asarray(codes), categories
    pandas = sys.modules.get("pandas")
    if pandas is None or not isinstance(keys, (pandas.Series, pandas.Index)) or not pandas.api.types.is_string_dtype(keys):
        return None
    codes, categories = keys.factorize()
    return codes, categories


def _values(keys: Any, name: str) -> NDArray[Any]:
    array = np.asarray(keys)
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}; expected (n,), a key for each box")
    if array.size == 0:
        return np.empty(0, np.int64)
    if array.dtype.kind in "OT":
        return _of_objects(array.astype(object), name)
    if array.dtype.kind == "f":
        return _of_floats(array, name)
    if array.dtype.kind not in "iubUS":
        raise TypeError(f"{name} has dtype {array.dtype}; {_EXPECTED}")
    return array.astype(np.uint8) if array.dtype.kind == "b" else array


def _of_floats(floats: NDArray[Any], name: str) -> NDArray[Any]:
    """Whole numbers as integers: a join of tables makes floats of a column of integers."""
    if np.isnan(floats).any():
        raise ValueError(f"{name} has no key in row {int(np.isnan(floats).argmax())}; {_EXPECTED}")
    # Beyond 2**53, floats stand for several integers.
    wrong = (floats != np.trunc(floats)) | (np.abs(floats) > 2.0**53)
    if wrong.any():
        row = int(wrong.argmax())
        raise TypeError(
            f"{name} has dtype {floats.dtype} and is {floats[row]} in row {row}; {_EXPECTED}, such as those of "
            '.astype("Int64") before tables are joined'
        )
    return floats.astype(np.int64)


def _of_objects(objects: NDArray[Any], name: str) -> NDArray[Any]:
    if set(map(type, objects)) == {str}:
        return objects
    for row, key in enumerate(objects):
        if key is None or type(key).__name__ in ("NAType", "NaTType") or isinstance(key, float) and key != key:
            raise ValueError(f"{name} has no key in row {row}; {_EXPECTED}")
        if not isinstance(key, (str, int, np.integer)):
            raise TypeError(f"{name} has {_arguments.kind_of(key)} in row {row}; {_EXPECTED}")
    if all(isinstance(key, str) for key in objects):
        return objects
    if any(isinstance(key, str) for key in objects):
        raise TypeError(f"{name} has strings and integers; expected either")
    return objects


def _groups(keys: list[_Keys], name: str) -> list[NDArray[np.int64]]:
    """A positive number for each key, the same for equal ones of either set."""
    numbers = _numbers([of_set.values for of_set in keys], name)
    return [
        array if of_set.codes is None else array[of_set.codes]
        for of_set, array in zip(keys, numbers, strict=True)
    ]


def _numbers(arrays: list[NDArray[Any]], name: str) -> list[NDArray[np.int64]]:
    filled = [array for array in arrays if array.size]
    are_texts = [array.dtype.kind in "US" or array.dtype.kind == "O" and isinstance(array[0], str) for array in filled]
    if len(set(are_texts)) > 1:
        raise TypeError(f"{name} has strings for one set and integers for the other; expected either for both")
    if filled and not are_texts[0]:
        least = min(int(array.min()) for array in filled)
        if max(int(array.max()) for array in filled) - least <= _MOST and all(array.dtype.kind != "O" for array in filled):
            return [_counted_from(array, least) for array in arrays]
    # NumPy would join signed and unsigned integers as floats.
    kinds = {array.dtype.kind for array in filled}
    alike = [array if len(kinds) == 1 else array.astype(object) for array in filled] or arrays
    all_keys = alike[0] if len(alike) == 1 else np.concatenate(alike)
    if all_keys.dtype.kind == "O" or all_keys.dtype.itemsize == 0:
        keys = all_keys.tolist()
        table = {key: number for number, key in enumerate(dict.fromkeys(keys), 1)}
        numbers = np.fromiter(map(table.__getitem__, keys), np.int64, len(keys))
    else:
        numbers = _core.numbers_of_keys(np.ascontiguousarray(all_keys))
    ends = np.cumsum([array.size for array in arrays])
    return [numbers[end - array.size : end] for array, end in zip(arrays, ends, strict=True)]


def _counted_from(array: NDArray[Any], least: int) -> NDArray[np.int64]:
    """Integers as numbers from 1 on. The difference of two integers of 64 bits may not fit, but wraps to the right one."""
    wide = array.astype(np.uint64 if array.dtype.kind == "u" else np.int64, copy=False).view(np.uint64)
    return (wide - np.uint64((least - 1) % 2**64)).view(np.int64)


def _keyed(groups: NDArray[np.int64], filters: Any, filters_name: str, name: str) -> Keyed:
    groups = groups if name == "same" else -groups
    if filters is None:
        return Keyed(name, groups)
    from broadside import _convert

    shape = np.shape(filters)
    if len(shape) == 1 and shape != groups.shape:
        raise ValueError(f"{filters_name} has {shape[0]} filters and {name} {len(groups)} keys; expected one for each box")
    packed = _convert.filters(filters, len(groups), filters_name)
    if packed[:, 2].any():
        raise ValueError(f"{filters_name} with groups are given with {name}; expected those of group 0, as keys are groups")
    if name == "same":
        if ((packed[:, 0] != 1) | (packed[:, 1] != 2**64 - 1)).any():
            raise ValueError(f"{filters_name} with categories or masks are given with same; expected one of the two")
        packed[:, :2] = 0
    packed[:, 2] = groups.view(np.uint64)
    return Keyed(name, packed)

"""Plain arguments, checked before they go to the extension module."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np


def kind_of(found: Any) -> str:
    """The type of an object with its article, such as "an int", or "None"."""
    if found is None:
        return "None"
    kind = type(found).__name__
    return f"{'an' if kind[0] in 'aeiouAEIOU' else 'a'} {kind}"


def text(found: Any, name: str) -> str:
    """A str."""
    if not isinstance(found, str):
        raise TypeError(f"{name} is {kind_of(found)}; expected a str")
    return found


def truth(found: Any, name: str) -> bool:
    """True or False, NumPy's as well, or 1 or 0."""
    if not isinstance(found, (bool, np.bool_)) and not (isinstance(found, (int, np.integer)) and found in (0, 1)):
        raise TypeError(f"{name} is {kind_of(found)}; expected True or False")
    return bool(found)


def number(found: Any, name: str) -> float:
    """A number as a float."""
    if not hasattr(type(found), "__float__") and not hasattr(type(found), "__index__"):
        raise TypeError(f"{name} is {kind_of(found)}; expected a number")
    try:
        return float(found)
    except OverflowError:
        raise ValueError(f"{name} is {found}; expected a number that a float holds") from None


def integer(found: Any, name: str, least: int, most: int) -> int:
    """An integer from `least` to `most`."""
    if isinstance(found, bool) or not hasattr(type(found), "__index__"):
        raise TypeError(f"{name} is {kind_of(found)}; expected an integer")
    value = operator.index(found)
    if not least <= value <= most:
        raise ValueError(f"{name} is {value}; expected {least} to {most}")
    return value

"""Plain arguments, checked before they go to the extension module."""

from __future__ import annotations

import operator
from typing import Any


def text(found: Any, name: str) -> str:
    """A str."""
    if not isinstance(found, str):
        raise TypeError(f"{name} is of {type(found).__name__}; expected a str")
    return found


def number(found: Any, name: str) -> float:
    """A number as a float."""
    if not hasattr(type(found), "__float__") and not hasattr(type(found), "__index__"):
        raise TypeError(f"{name} is of {type(found).__name__}; expected a number")
    try:
        return float(found)
    except OverflowError:
        raise ValueError(f"{name} is {found}; expected a number that a float holds") from None


def integer(found: Any, name: str, least: int, most: int) -> int:
    """An integer from `least` to `most`."""
    if isinstance(found, bool) or not hasattr(type(found), "__index__"):
        raise TypeError(f"{name} is of {type(found).__name__}; expected an integer")
    value = operator.index(found)
    if not least <= value <= most:
        raise ValueError(f"{name} is {value}; expected {least} to {most}")
    return value

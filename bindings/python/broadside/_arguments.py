"""Plain arguments, checked before they go to the extension module."""

from __future__ import annotations

import difflib
import functools
import inspect
import operator
from collections.abc import Callable, Collection
from typing import Any, TypeVar

import numpy as np

_Called = TypeVar("_Called", bound=Callable[..., Any])

# Names that other libraries have for an argument.
_OTHER_NAMES = {
    "same": ["by", "on", "group", "groups", "groupby", "key", "keys"],
    "within": ["distance", "radius", "radii", "r", "eps", "cutoff", "max_distance"],
    "max_distance": ["distance", "distance_upper_bound", "radius", "r", "within"],
    "period": ["boxsize"],
    "threads": ["workers", "n_jobs"],
}
_NO_PERIOD = (
    "has no argument 'period'. Only pairs(), count(), components() and distances() know periodic space: for neighbours "
    "call pairs(..., within=, period=), and for motion call it in each frame and compare the pairs with those of the "
    "frame before, as docs/python.md shows"
)


def suggests(function: _Called) -> _Called:
    """Makes the error about an argument that does not exist name the one that is meant."""

    @functools.wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        try:
            return function(*given, **named)
        except TypeError as error:
            # If the call failed, and not something in the function, there is no further frame.
            if error.__traceback__ is None or error.__traceback__.tb_next is not None:
                raise
            known = inspect.signature(function).parameters
            unknown = [name for name in named if name not in known]
            takes_any = any(one.kind is inspect.Parameter.VAR_KEYWORD for one in known.values())
            if takes_any or not unknown:
                raise
            raise TypeError(unknown_name(function.__qualname__.removesuffix(".__init__"), unknown[0], known)) from None

    return call  # type: ignore[return-value]


def unknown_name(function: str, name: str, known: Collection[str]) -> str:
    """What is wrong with an argument of a function that knows others."""
    if name == "period":
        return f"{function}() {_NO_PERIOD}"
    known = [one for one in known if one != "self"]
    others = [own for own, names in _OTHER_NAMES.items() if own in known and name in names]
    near = others or difflib.get_close_matches(name, known, 1)
    meant = f"did you mean {near[0]!r}?" if near else f"expected one of: {', '.join(known)}"
    return f"{function}() has no argument {name!r}; {meant}"


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

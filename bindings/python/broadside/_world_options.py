"""The options of a world, by the library's table: names, defaults, ranges and help."""

from __future__ import annotations

import inspect
import re
from collections.abc import Collection
from typing import Any, NamedTuple

import numpy as np

from broadside import _arguments, _core


class WorldOption(NamedTuple):
    """An option as the library describes it."""

    name: str
    summary: str
    default: Any
    choices: list[str]
    min: float
    max: float

    @property
    def is_switch(self) -> bool:
        return self.choices == ["no", "yes"]

    def text(self, value: Any) -> str:
        """The value as the library reads it."""
        if self.is_switch:
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError(f"{self.name} is {value!r}; expected True or False")
            return "yes" if value else "no"
        if self.choices:
            if value not in self.choices:
                raise ValueError(f"{self.name} is {value!r}; expected {' or '.join(map(repr, self.choices))}")
            return str(value)
        if isinstance(self.default, int):
            return str(_arguments.integer(value, self.name, int(self.min), int(self.max)))
        return repr(_arguments.number(value, self.name))


def _option(name: str, summary: str, default: str, kind: str, choices: list[str], low: float, high: float) -> WorldOption:
    value: Any = {"number": float, "integer": int, "choice": str}[kind](default)
    return WorldOption(name, summary, value == "yes" if choices == ["no", "yes"] else value, choices, low, high)


OPTIONS = {row[0]: _option(*row) for row in _core.world_options()}


def settings_of(options: dict[str, Any]) -> str:
    """The options as one text, such as ``"world:margin=0.1"``."""
    for name in options:
        if name not in OPTIONS:
            known = ("dimension", "dtype", "algorithm", "threads", *OPTIONS)
            raise TypeError(_arguments.unknown_name("World", name, known))
    return ":".join(["world", *(f"{name}={OPTIONS[name].text(value)}" for name, value in options.items())])


def filled(docstring: str | None, own: Collection[str]) -> str:
    """A docstring whose ``**options: {options}`` is replaced by a line for each option that is not among `own`."""
    lines = []
    for option in OPTIONS.values():
        if option.name not in own:
            values = f" ({', '.join(map(repr, option.choices))})" if option.choices and not option.is_switch else ""
            lines.append(f"{option.name}: {option.summary}{values}; by default {option.default!r}.")
    return re.sub(
        r"( *)\*\*options: \{options\}", lambda found: "\n".join(found[1] + line for line in lines), docstring or ""
    )


def signature(function: Any) -> inspect.Signature:
    """The signature of a function that takes all options as its last keywords."""
    plain = inspect.signature(function)
    own = [one for one in plain.parameters.values() if one.kind is not one.VAR_KEYWORD]
    table = [
        inspect.Parameter(option.name, inspect.Parameter.KEYWORD_ONLY, default=option.default)
        for option in OPTIONS.values()
        if option.name not in plain.parameters
    ]
    return plain.replace(parameters=[*own, *table])

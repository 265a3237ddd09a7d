"""An experiment's declaration: its statements, the rules that decide them, and what to run, judge and draw."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy

if TYPE_CHECKING:
    from .figures import Figure
    from .judge import Finding
    from .results import Results
    from .rules import Rules


NAME_FROM_THE_CODE = re.compile("[a-z]_[a-z]|[a-z]:[a-z]")  # names that readers should not see


class Unusable(Exception):
    """Something unusable. Its text, one line, says what was found and what was expected."""


@dataclass(frozen=True)
class Claim:
    """A statement of the draft, by its number in docs/draft.md, and the rules that decide it.

    Both rules are sentences, written before anything is measured; `{clearly}` and the like stand for the values in
    rules.toml.
    """

    number: str
    confirmed_if: str
    refuted_if: str


@dataclass(frozen=True)
class Boxes:
    """Boxes made by an experiment: `make(random)` gives an array with a row `[minima, maxima]` per box."""

    name: str
    make: Callable[[numpy.random.Generator], numpy.ndarray]
    inputs: int = 4


@dataclass(frozen=True)
class Case:
    """Boxes, and the algorithms measured on them in the same rounds.

    The fields are those of docs/schemas/cases-1.schema.json; None leaves a field out.
    """

    name: str
    scene: str | Boxes
    specs: Sequence[str]
    boxes: int | None = None
    dimension: int = 2
    seeds: int | None = None
    frames: int | None = None
    moving: float | None = None
    drift: float | None = None
    teleport: float | None = None
    left: float | None = None
    filtered: bool | None = None
    take: Sequence[str] = ("time",)
    made_anew: bool = False
    effort: Mapping[str, float] = field(default_factory=dict)

    def listed(self, seed: int, files: Sequence[str] = ()) -> dict:
        """The case as input of `broadside measure`; `files` are the inputs of a scene of Boxes."""
        own = isinstance(self.scene, Boxes)
        fields = {
            "name": self.name,
            "scene": list(files) if own else self.scene,
            "specs": list(self.specs),
            "boxes": None if own else self.boxes,
            "dimension": self.dimension,
            "seed": None if own else seed,
            "seeds": None if own else self.seeds,
            "frames": self.frames,
            "moving": self.moving,
            "drift": self.drift,
            "teleport": self.teleport,
            "left": self.left,
            "filtered": self.filtered,
            "take": list(self.take),
            "made_anew": self.made_anew,
            "effort": dict(self.effort),
        }
        return {name: value for name, value in fields.items() if value is not None}


@dataclass(frozen=True)
class Experiment:
    """An experiment. Each module of tools/paper/experiments/ has one, called EXPERIMENT, and gives it its name."""

    title: str
    measured: str
    claims: Sequence[Claim]
    cases: Callable[[], Sequence[Case]]
    judge: Callable[[Results, Rules], Sequence[Finding]]
    figures: Callable[[Results, Rules], Iterable[Figure]]
    name: str = ""

    def listed(self) -> list[dict]:
        """Its cases, checked, without what depends on the run: these identify results."""
        cases = list(self.cases())
        names = [case.name for case in cases]
        for name in names:
            if names.count(name) > 1:
                raise Unusable(f"experiment {self.name}: case '{name}' twice; expected each name once")
        return [case.listed(0, [case.scene.name] if isinstance(case.scene, Boxes) else ()) for case in cases]


def all_experiments() -> dict[str, Experiment]:
    """The experiments by name, in the order of the draft's statements."""
    package = importlib.import_module(".experiments", __package__)
    found = []
    for module in pkgutil.iter_modules(package.__path__):
        experiment = importlib.import_module(f"{package.__name__}.{module.name}").EXPERIMENT
        object.__setattr__(experiment, "name", module.name)
        found.append(experiment)
    found.sort(key=lambda experiment: order_of(experiment.claims[0].number))
    return {experiment.name: experiment for experiment in found}


def order_of(number: str) -> tuple[int, str]:
    """Sorts claims as 2a, 2b, 10a, B1."""
    digits = number.rstrip("abcdefghijklmnopqrstuvwxyz")
    return (int(digits), number) if digits.isdigit() else (1000, number)


def experiments_named(names: Sequence[str]) -> list[Experiment]:
    """The experiments of these names, or all if there are none."""
    known = all_experiments()
    for name in names:
        if name not in known:
            raise Unusable(f"no experiment '{name}'; expected some of: {', '.join(known)}")
    return [experiment for name, experiment in known.items() if not names or name in names]

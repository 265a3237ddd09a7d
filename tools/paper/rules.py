"""The rules of judgement, from rules.toml."""

from __future__ import annotations

import hashlib
import subprocess
import tomllib
from collections.abc import Mapping
from pathlib import Path

from .experiment import Unusable

PATH = Path(__file__).parent / "rules.toml"


class Rules:
    """The values by which one experiment is judged, as attributes: its own and those of [all]."""

    def __init__(self, values: Mapping[str, float]):
        self.values = dict(values)

    def __getattr__(self, name: str):
        try:
            return self.values[name]
        except KeyError:
            if name.startswith("__"):  # Python's own look-ups
                raise AttributeError(name) from None
            raise self._lacks(name) from None

    def fill(self, sentence: str) -> str:
        """The sentence with each `{rule}` replaced by its value."""
        try:
            return sentence.format_map({name: f"{value:g}" for name, value in self.values.items()})
        except KeyError as error:
            raise self._lacks(error.args[0]) from None

    def _lacks(self, name: str) -> Unusable:
        return Unusable(f"rules.toml has no rule '{name}' for this experiment; expected one of: "
                        f"{', '.join(self.values)}")


class RuleBook:
    """All rules, and their version."""

    def __init__(self, path: Path = PATH):
        try:
            self._tables = tomllib.loads(path.read_text(encoding="utf-8"))
            self.version: int = self._tables.pop("version")
            self._tables["all"]
        except (tomllib.TOMLDecodeError, KeyError) as error:
            raise Unusable(f"{path} cannot be read ({error}); expected TOML with a version and a table "
                           f"[all]") from None
        self._path = path

    def digest(self, experiment: str) -> str:
        """Covers only the rules that judge this experiment, so that those of another may change."""
        return hashlib.sha256(repr(sorted(self.of(experiment).values.items())).encode()).hexdigest()[:16]

    def of(self, experiment: str) -> Rules:
        return Rules({**self._tables["all"], **self._tables.get(experiment, {})})

    def experiments(self) -> list[str]:
        """The experiments with rules of their own."""
        return [name for name in self._tables if name != "all"]

    def commit(self) -> str:
        """The commit of the rules: thresholds and the sentences of experiments/. Empty if they are not committed, or
        if there is no repository."""
        def git(*arguments: str) -> subprocess.CompletedProcess:
            return subprocess.run(("git", *arguments, "--", self._path.name, "experiments"), cwd=self._path.parent,
                                  capture_output=True, text=True, check=False)
        try:
            if git("diff", "--quiet", "HEAD").returncode != 0:
                return ""
            return git("log", "-1", "--format=%H").stdout.strip()
        except FileNotFoundError:  # no git
            return ""

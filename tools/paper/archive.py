"""Runs as files: one for each run and experiment, with the versions it was measured by."""

from __future__ import annotations

import hashlib
import json
import lzma
import os
import re
from dataclasses import dataclass
from pathlib import Path

from .experiment import Experiment, Unusable
from .results import Results, Run
from .rules import RuleBook

SCHEMA = "broadside.experiment-run/1"


def digest_of(value: object) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()[:16]


@dataclass(frozen=True)
class Archive:
    """A folder of runs: run-1/quadtree_capacity.json.xz and so on."""

    folder: Path

    def path(self, run: int, experiment: str) -> Path:
        return self.folder / f"run-{run}" / f"{experiment}.json.xz"

    def run_numbers(self, experiment: str) -> list[int]:
        folders = [path.parent.name for path in self.folder.glob(f"run-*/{experiment}.json.xz")]
        return sorted(int(name.removeprefix("run-")) for name in folders if re.fullmatch(r"run-[1-9]\d*", name))

    def write(self, run: int, experiment: Experiment, book: RuleBook, program: str, is_quick: bool,
              seconds: float, results: dict) -> None:
        """Writes a complete file or none: an interrupted run leaves no file."""
        content = {
            "schema": SCHEMA,
            "experiment": experiment.name,
            "run": run,
            "quick": is_quick,
            "rules": {"version": book.version, "digest": book.digest(experiment.name), "commit": book.commit()},
            "cases": digest_of(experiment.listed()),
            "program": program,
            "seconds": round(seconds, 1),
            "results": results,
        }
        path = self.path(run, experiment.name)
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(".part")
        with lzma.open(part, "wb", preset=9) as packed:
            packed.write(json.dumps(content, separators=(",", ":")).encode())
        os.replace(part, path)

    def read(self, run: int, experiment: Experiment, book: RuleBook) -> dict:
        """Raises Unusable, in one line, if anything in the file has another version."""
        path = self.path(run, experiment.name)
        try:
            content = json.loads(lzma.decompress(path.read_bytes()))
            check(path, "schema", content["schema"], SCHEMA)
            check(path, "the results' schema", content["results"]["schema"], "broadside.results/2")
            rules = content["rules"]
        except (OSError, EOFError, ValueError, TypeError, KeyError, lzma.LZMAError) as error:
            why = f"it has no {error}" if isinstance(error, KeyError) else error
            raise Unusable(f"{path} cannot be read ({why}); expected a run of {experiment.name}; "
                           f"remove it to measure it again") from None
        check(path, "the run", f"{content['run']} of {content['experiment']}", f"{run} of {experiment.name}",
              "as its path says: a copy is no run of its own")
        check(path, "the rules' version", f"{rules['version']} ({rules['digest']})",
              f"{book.version} ({book.digest(experiment.name)})",
              "as changed rules take new data: remove it to measure it again")
        check(path, "the digest of its cases", content["cases"], digest_of(experiment.listed()),
              f"as the cases of {experiment.name} have changed: remove it to measure it again")
        return content

    def results(self, experiment: Experiment, book: RuleBook) -> tuple[Results, list[dict]]:
        """All runs of an experiment, and the metadata of each. Raises Unusable if there are none, or if they do not
        match."""
        contents = [self.read(run, experiment, book) for run in self.run_numbers(experiment.name)]
        if not contents:
            verb = "run" if experiment.claims else "compare"
            raise Unusable(f"{self.folder} has no run of {experiment.name}; expected one at least, as "
                           f"`python3 -m tools.paper {verb}` measures")
        first = contents[0]
        for content in contents[1:]:
            path = self.path(content["run"], experiment.name)
            for what in ("build", "machine"):
                check(path, f"its {what}", text_of(content["results"][what]), text_of(first["results"][what]),
                      f"that of run {first['run']}")
            check(path, "the program that measured it", content["program"], first["program"],
                  f"that of run {first['run']}")
            check(path, "it", kind_of_run(content["quick"]), kind_of_run(first["quick"]), f"as run {first['run']}")
        for content in contents:
            for measured in content["results"]["measurements"]:
                if measured["verified"] is False:
                    raise Unusable(f"{self.path(content['run'], experiment.name)}: {measured['algorithm']} is "
                                   f"wrong in case '{measured['case']}' ({measured['skipped']}); expected "
                                   f"results that were verified: remove the file to measure it again")
        runs = [Run(content["results"]["measurements"]) for content in contents]
        return Results(runs, book.of(experiment.name).confidence), [about(content) for content in contents]


def check(path: Path, what: str, found: object, expected: object, why: str = "") -> None:
    if found != expected:
        raise Unusable(f"{path}: {what} is {found}; expected {expected}{', ' if why else ''}{why}")


def kind_of_run(is_quick: bool) -> str:
    return "a quick run" if is_quick else "a whole run"


def text_of(machine_or_build: dict) -> str:
    """Without the clock rate, which changes by itself on some machines."""
    return ", ".join(f"{name} {value}" for name, value in machine_or_build.items() if name != "clock_mhz")


def about(content: dict) -> dict:
    """The metadata of a run."""
    results = content["results"]
    measurements = results["measurements"]
    return {
        "run": content["run"],
        "quick": content["quick"],
        "seconds": content["seconds"],
        "date": results["date"],
        "machine": results["machine"],
        "build": results["build"],
        "rules": content["rules"],
        "instruction_set": next((one["target"] for one in measurements if one.get("target")), None),
        "processor_share": results["processor_share"],
        "busy": results["busy"],
        "load_before": results.get("load_before"),
        "load_after": results.get("load_after"),
        "measurements": len(measurements),
        "unsteady": sum(1 for measured in measurements if measured["unsteady"]),
    }

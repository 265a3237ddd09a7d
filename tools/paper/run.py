"""Measures experiments run by run, each in its own process, and stores each result as soon as it is complete."""

from __future__ import annotations

import fcntl
import hashlib
import json
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy

from .archive import Archive, check, kind_of_run
from .experiment import Boxes, Experiment, Unusable
from .rules import RuleBook

# For cases that do not say otherwise. A slow algorithm has as many rounds as the others, up to its share.
EFFORT = {"budget_seconds": 4, "history_seconds": 8, "share_seconds": 0.1, "min_rounds": 8, "max_rounds": 40,
          "slow_seconds": 2, "slow_history_seconds": 4, "slow_rounds": 3}
QUICK_EFFORT = {**EFFORT, "share_seconds": 0.01, "min_rounds": 3, "max_rounds": 20, "slow_seconds": 0.2,
                "slow_history_seconds": 0.4, "slow_rounds": 1}


def seed_of(run: int) -> int:
    """The first seed of a run's cases: each run has other boxes, and run 1 always has the same."""
    return 1000 * run + 1


@dataclass
class Measuring:
    """Measures `runs` runs of experiments by `program`, into an archive."""

    program: Path
    archive: Archive
    work: Path
    book: RuleBook
    is_quick: bool = False
    seconds: dict[str, float] = field(default_factory=dict)  # duration of each experiment's last run
    effort = EFFORT
    quick_effort = QUICK_EFFORT

    def __post_init__(self) -> None:
        if not self.program.is_file():
            raise Unusable(f"{self.program} is no file; expected the program, as `make program` builds it")
        self.program = self.program.resolve()
        self.digest = hashlib.sha256(self.program.read_bytes()).hexdigest()[:16]

    def measure(self, experiments: Sequence[Experiment], runs: Sequence[int]) -> None:
        """Keeps existing runs, so that an interrupted measurement continues. Refuses existing runs of another version
        before measuring anything."""
        left = [(run, experiment) for run in runs for experiment in experiments
                if not self.is_measured(run, experiment)]
        if left and not self.is_quick and not self.book.commit():
            self.say("tools/paper/rules.toml or experiments/ is not committed: `publish` will refuse these runs")
        with self.alone():
            for place, (run, experiment) in enumerate(left, 1):
                self.say(f"[{place}/{len(left)}] run {run}, {experiment.name}{self.time_left(left[place - 1:])}")
                started = time.monotonic()
                results = self.results_of(run, experiment)
                self.seconds[experiment.name] = time.monotonic() - started
                self.archive.write(run, experiment, self.book, self.digest, self.is_quick,
                                   self.seconds[experiment.name], results)
        self.say(f"{len(left)} measured, {len(runs) * len(experiments) - len(left)} were there; "
                 f"all are in {self.archive.folder}")

    @contextmanager
    def alone(self) -> Iterator[None]:
        """Two measurements at once would overwrite each other's files and disturb each other's times."""
        self.work.mkdir(parents=True, exist_ok=True)
        with open(self.work / "lock", "w", encoding="utf-8") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise Unusable(f"another process measures into {self.archive.folder}; expected one at a time") \
                    from None
            yield

    def is_measured(self, run: int, experiment: Experiment) -> bool:
        path = self.archive.path(run, experiment.name)
        if not path.exists():
            return False
        content = self.archive.read(run, experiment, self.book)
        check(path, "the program that measured it", content["program"], self.digest,
              f"this one; remove {self.archive.folder} to measure by {self.program}")
        check(path, "it", kind_of_run(content["quick"]), kind_of_run(self.is_quick),
              f"as asked for; use another folder (--results), or remove {self.archive.folder}")
        self.seconds[experiment.name] = content["seconds"]
        return True

    def results_of(self, run: int, experiment: Experiment) -> dict:
        """The program's results of one run. Raises Unusable if it refuses, KeyboardInterrupt if it was interrupted."""
        cases = list(experiment.cases())
        numpy.random.default_rng(run).shuffle(cases)  # no case always follows the same other one
        listed = []
        for case in cases:
            files = self.write_inputs(case.scene, run) if isinstance(case.scene, Boxes) else ()
            listed.append(case.listed(seed_of(run), files))
        cases_file = self.work / f"{experiment.name}.cases.json"
        results_file = self.work / f"{experiment.name}.results.json"
        effort = self.quick_effort if self.is_quick else self.effort
        if self.is_quick:  # optional parts of a case are for the paper
            listed = [{name: value for name, value in case.items() if name != "effort"} for case in listed]
        cases_file.write_text(json.dumps({"schema": "broadside.cases/1", "effort": effort, "cases": listed}),
                              encoding="utf-8")
        ended = subprocess.run([self.program, "measure", cases_file.name, "--json", results_file.name],
                               cwd=self.work, stdout=subprocess.PIPE, text=True, check=False)
        if ended.returncode == 130:
            raise KeyboardInterrupt
        if experiment.claims:  # in the comparison, many algorithms are too slow for their budget
            for line in ended.stdout.splitlines()[:-1]:
                self.say("    " + line)
        if ended.returncode not in (0, 1):
            raise Unusable(f"{self.program.name} measure ended with {ended.returncode} on {cases_file}; "
                           f"expected 0 (its message is above)")
        return json.loads(results_file.read_text(encoding="utf-8"))

    def write_inputs(self, boxes: Boxes, run: int) -> list[str]:
        """Writes the inputs of a run as NumPy files; returns their paths relative to the work folder."""
        (self.work / "inputs").mkdir(exist_ok=True)
        names = []
        for i in range(boxes.inputs):
            random = numpy.random.default_rng([run, i])
            names.append(f"inputs/{boxes.name}-{run}-{i}.npy")
            numpy.save(self.work / names[-1], numpy.asarray(boxes.make(random), dtype=numpy.float32))
        return names

    def time_left(self, left: Sequence[tuple[int, Experiment]]) -> str:
        """Available if each of the remaining experiments was measured before."""
        if not all(experiment.name in self.seconds for _, experiment in left):
            return ""
        seconds = sum(self.seconds[experiment.name] for _, experiment in left)
        return f", about {max(round(seconds / 60), 1)} min left"

    @staticmethod
    def say(text: str) -> None:
        print(text, file=sys.stderr, flush=True)

"""Times libraries in alternating rounds, each in a process of its own, and checks the pairs of every turn.

A library that raises, dies, hangs or finds other pairs is reported with its message, and the others go on.
"""

from __future__ import annotations

import gc
import multiprocessing
import os
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

Pairs = Any  # an array of pairs, or their number if the library cannot list them
KINDS = ("one set", "two sets", "queries")
TURN_SECONDS = 0.1  # a turn repeats calls that are shorter
START_SECONDS = 300.0  # limit for importing a library and its first call, which may compile kernels
SWEPT = 10_000  # the most boxes whose pairs `sweep` finds; beyond, the first library's pairs are the reference
LATTICE = 2.0**20


@dataclass(frozen=True)
class Driver:
    """How to call a library. Timed are `build` and `search`; in queries, `search` alone."""

    search: Callable[[Any], Any]
    take: Callable[[np.ndarray, np.ndarray | None], Any] = lambda a, b: (a, b)  # arrays to what the library takes
    build: Callable[[Any], Any] = lambda given: given
    rows: Callable[[Any], Pairs] = lambda found: found  # what `search` returns to an array of pairs


@dataclass(frozen=True)
class Library:
    name: str
    packages: tuple[str, ...]  # what pip installs; the first has the version
    make: Callable[[int], Driver]  # by the number of threads
    dimensions: tuple[int, ...] = (2, 3)
    kinds: tuple[str, ...] = KINDS[:2]
    has_threads: bool = False


@dataclass(frozen=True)
class Case:
    n: int
    dimension: int
    kind: str

    def inputs(self) -> list[tuple[np.ndarray, np.ndarray | None]]:
        """The sets of boxes that calls take in turn, so that no processor learns one by heart."""

        def one(seed: int) -> tuple[np.ndarray, np.ndarray | None]:
            if self.kind == "one set":
                return scattered(self.n, self.dimension, seed), None
            second = scattered(self.n, self.dimension, seed + 1000)
            first = scattered(self.n, self.dimension, seed)
            return (first[: max(1, self.n // 10)] if self.kind == "queries" else first), second

        return [one(seed) for seed in range(min(32, max(3, 60_000 // self.n)))]


def scattered(n: int, dimension: int, seed: int) -> np.ndarray:
    """Boxes that each overlap about two others, some of which only touch, or intervals that overlap about ten others.

    Floats and doubles have all their bounds.
    """
    rng = np.random.default_rng(seed)
    minima = rng.random((n, dimension))
    sides = rng.random((n, dimension)) * (10 if dimension == 1 else 2) / n ** (1 / dimension)
    minima, sides = np.floor(minima * LATTICE) / LATTICE, np.floor(sides * LATTICE) / LATTICE
    return np.hstack([minima, minima + sides])


def self_pairs(rows: np.ndarray) -> np.ndarray:
    """Keeps each pair of a self-join once."""
    return rows[rows[:, 0] < rows[:, 1]]


def keys(rows: Pairs, is_self: bool) -> np.ndarray:
    rows = np.asarray(rows, np.int64).reshape(-1, 2)
    if is_self:
        rows = np.sort(rows, axis=1)
    return np.sort(rows[:, 0] << 32 | rows[:, 1])


def seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    began = time.perf_counter()
    result = call()
    return time.perf_counter() - began, result


def sweep(a: np.ndarray, b: np.ndarray | None) -> np.ndarray:
    """The keys of the pairs of closed boxes, by a sweep along x that shares no code with any library."""
    half = a.shape[1] // 2
    right = a if b is None else b
    right_order = np.argsort(right[:, 0])
    starts = right[right_order, 0]
    widest = (right[:, half] - right[:, 0]).max()
    first = np.searchsorted(starts, a[:, 0] - widest, "left")
    counts = np.searchsorted(starts, a[:, half], "right") - first
    i = np.repeat(np.arange(len(a)), counts)
    j = right_order[np.arange(len(i)) - np.repeat(np.cumsum(counts) - counts - first, counts)]
    overlap = ((a[i, :half] <= right[j, half:]) & (right[j, :half] <= a[i, half:])).all(axis=1)
    rows = np.column_stack([i[overlap], j[overlap]])
    return keys(self_pairs(rows) if b is None else rows, b is None)


def difference(found: np.ndarray | int, expected: np.ndarray) -> str:
    """What is wrong with the pairs that were found; empty if nothing is."""
    if isinstance(found, int):
        return "" if found == len(expected) else f"wrong: {found:,} pairs, {len(expected):,} expected"
    if np.array_equal(found, expected):
        return ""
    distinct = np.unique(found)
    parts = {
        "missing": len(np.setdiff1d(expected, distinct, assume_unique=True)),
        "too many": len(np.setdiff1d(distinct, expected, assume_unique=True)),
        "repeated": len(found) - len(distinct),
    }
    return "wrong: " + ", ".join(f"{count:,} pairs {what}" for what, count in parts.items() if count)


class Server:
    """In the library's process: the library and the inputs of one case."""

    def __init__(self, make: Callable[[int], Driver], threads: int, case: Case) -> None:
        self.driver = make(threads)
        self.is_self = case.kind == "one set"
        self.is_built_before = case.kind == "queries"
        apart = np.repeat([[0.0], [0.25]], case.dimension, axis=1)
        two = np.hstack([apart, apart + 0.125])
        empty = self.prepared(two, None if self.is_self else two + 0.5)
        self.call(empty)  # imports, compiles and allocates
        self.empty = statistics.median(seconds(lambda: self.call(empty))[0] for _ in range(5))
        inputs = case.inputs()
        self.next = 0
        self.taking, self.given = zip(*(seconds(lambda: self.prepared(a, b)) for a, b in inputs))

    def prepared(self, a: np.ndarray, b: np.ndarray | None) -> Any:
        given = self.driver.take(a, b)
        return self.driver.build(given) if self.is_built_before else given

    def call(self, given: Any) -> Any:
        return self.driver.search(given if self.is_built_before else self.driver.build(given))

    def start(self) -> tuple[float, float]:
        """Seconds for an empty call, and for making what the library takes of the arrays (in queries, its index)."""
        return self.empty, statistics.median(self.taking)

    def comparable(self, rows: Pairs) -> np.ndarray | int:
        return rows if isinstance(rows, int) else keys(rows, self.is_self)

    def check(self, at: int) -> tuple[float, float, np.ndarray | int]:
        """Seconds for the call and for making an array of its result, and the pairs."""
        taken, found = seconds(lambda: self.call(self.given[at]))
        listing, rows = seconds(lambda: self.driver.rows(found))
        return taken, listing, self.comparable(rows)

    def turn(self) -> tuple[float, float, int, np.ndarray | int]:
        """Seconds per call and of processor time per call, and the last call's input and pairs."""
        calls = 0
        gc.disable()
        began, worked = time.perf_counter(), time.process_time()
        while calls == 0 or time.perf_counter() - began < TURN_SECONDS:
            at = self.next
            found = self.call(self.given[at])
            self.next = (at + 1) % len(self.given)
            calls += 1
        taken, work = time.perf_counter() - began, time.process_time() - worked
        gc.enable()
        return taken / calls, work / calls, at, self.comparable(self.driver.rows(found))


def serve(pipe: Connection) -> None:
    """The main function of a library's process."""
    os.dup2(2, 1)  # libraries greet on stdout, which is for the table
    server: Server | None = None
    while True:
        try:
            name, arguments = pipe.recv()
        except EOFError:
            return
        try:
            if name == "start":
                server = None
                server = Server(*arguments)
                arguments = ()
            pipe.send((True, getattr(server, name)(*arguments)))
        except Exception as error:
            text = str(error).strip().splitlines() or [""]
            pipe.send((False, f"{type(error).__name__}: {text[0][:300]}"))


class Failed(Exception):
    """A library that gave no answer; says why."""


class Runner:
    """One library's process, which is started when needed."""

    def __init__(self, library: Library, threads: int) -> None:
        self.library, self.threads = library, threads
        self.process: Any = None

    def ask(self, name: str, *arguments: Any, limit: float) -> Any:
        if self.process is None:
            context = multiprocessing.get_context("spawn")
            self.pipe, theirs = context.Pipe()
            self.process = context.Process(target=serve, args=(theirs,), daemon=True)
            self.process.start()
            theirs.close()
        try:
            self.pipe.send((name, arguments))
            if not self.pipe.poll(limit):
                self.stop()
                raise Failed(f"no answer in {limit:g} s")
            is_fine, answer = self.pipe.recv()
        except (EOFError, ConnectionError):
            self.process.join()
            code = self.process.exitcode
            self.stop()
            raise Failed(f"ended by signal {-code}" if code < 0 else f"ended with exit code {code}") from None
        if not is_fine:
            raise Failed(answer)
        return answer

    def start(self, case: Case) -> tuple[float, float]:
        return self.ask("start", self.library.make, self.threads, case, limit=START_SECONDS)

    def stop(self) -> None:
        if self.process is not None:
            self.process.kill()
            self.process.join()
            self.pipe.close()
            self.process = None


@dataclass
class Result:
    """What came of one library in one case."""

    note: str = ""  # why there are no times
    pairs: int = 0
    is_counted: bool = False  # the library cannot list its pairs: only their number was compared
    empty: float = 0.0
    taking: float = 0.0
    listing: float = 0.0
    times: list[float] = field(default_factory=list)
    work: list[float] = field(default_factory=list)
    ratios: list[float] = field(default_factory=list)  # of its time to the first library's in the same round


def compare(runners: Sequence[Runner], case: Case, rounds: int, limit: float, slow: float) -> dict[str, Result]:
    """The first library is the one that the others are compared with."""
    expected = [sweep(a, b) for a, b in case.inputs()] if case.n <= SWEPT else None
    results = {runner.library.name: Result() for runner in runners}
    running = []
    for runner in runners:
        result = results[runner.library.name]
        try:
            result.empty, result.taking = runner.start(case)
            answers = []
            for at in range(len(case.inputs())):
                answers.append(runner.ask("check", at, limit=limit))
                wrong = difference(answers[-1][2], expected[at]) if expected else ""
                if wrong:
                    raise Failed(wrong)
                if answers[-1][0] > slow:
                    raise Failed(f"one call: {answers[-1][0]:,.1f} s")
        except Failed as failed:
            result.note = str(failed)
            continue
        expected = expected or [found for _, _, found in answers]
        result.listing = statistics.median(listing for _, listing, _ in answers)
        result.is_counted = isinstance(answers[0][2], int)
        result.pairs = len(expected[0])
        running.append(runner)
    for round_number in range(rounds):
        for runner in running if round_number % 2 == 0 else running[::-1]:
            result = results[runner.library.name]
            if result.note:
                continue
            try:
                taken, work, at, found = runner.ask("turn", limit=limit + TURN_SECONDS)
                wrong = difference(found, expected[at])
                if wrong:
                    raise Failed(wrong)
            except Failed as failed:
                result.note = str(failed)
                continue
            result.times.append(taken)
            result.work.append(work)
    ours = results[runners[0].library.name].times
    for result in results.values():
        result.ratios = [theirs / own for theirs, own in zip(result.times, ours)]
    return results

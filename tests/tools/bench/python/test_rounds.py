"""A library that is wrong, raises, dies or hangs is caught, and the others are timed all the same."""

from __future__ import annotations

import os
import signal
import time

import numpy as np
import pytest

import rounds
from rounds import Case, Driver, Library, Runner, compare, difference, scattered, sweep

CASE = Case(200, 2, "one set")


def pairs(given):
    found = sweep(*given)
    return np.column_stack([found >> 32, found & 0xFFFFFFFF])


def make_right(threads):
    return Driver(pairs)


def make_either_order(threads):
    return Driver(lambda given: pairs(given)[::-1, ::-1])


def make_dropping(threads):
    return Driver(lambda given: pairs(given)[1:])


def make_doubling(threads):
    return Driver(lambda given: np.vstack([pairs(given), pairs(given)[:1, ::-1]]))


def make_inventing(threads):
    return Driver(lambda given: np.vstack([pairs(given), [[0, 0]]]))


def make_counting(threads):
    return Driver(lambda given: len(pairs(given)))


def make_counting_wrong(threads):
    return Driver(lambda given: len(pairs(given)) + 1)


def make_missing(threads):
    raise ImportError("no such library")


def make_raising(threads):
    return Driver(lambda given: pairs(given)[len(given[0]) // 2 + 1, 2])


def make_dying(threads):
    return Driver(lambda given: os.kill(os.getpid(), signal.SIGKILL))


def make_leaving(threads):
    return Driver(lambda given: os._exit(3))


def make_hanging(threads):
    return Driver(lambda given: pairs(given) if len(given[0]) == 2 else time.sleep(1000))


def make_hanging_at_start(threads):
    time.sleep(1000)


def make_slow(threads):
    return Driver(lambda given: (time.sleep(0.05 if len(given[0]) > 2 else 0), pairs(given))[1])


class RightAtFirst:
    """Drops a pair in the rounds, after each input was checked once."""

    def __init__(self):
        # The empty calls come before.
        self.left = 6 + len(CASE.inputs())

    def __call__(self, given):
        self.left -= 1
        return pairs(given)[0 if self.left >= 0 else 1 :]


def make_right_at_first(threads):
    return Driver(RightAtFirst())


def compared(*makers, case=CASE, limit=20.0, slow=20.0):
    runners = [Runner(Library(make.__name__, (), make), 1) for make in (make_right, *makers)]
    try:
        return compare(runners, case, rounds=2, limit=limit, slow=slow)
    finally:
        for runner in runners:
            runner.stop()


@pytest.mark.parametrize(
    "make, note",
    [
        (make_dropping, "wrong: 1 pairs missing"),
        (make_doubling, "wrong: 1 pairs repeated"),
        (make_inventing, "wrong: 1 pairs too many"),
        (make_counting_wrong, "expected"),
        (make_right_at_first, "wrong: 1 pairs missing"),
        (make_missing, "ImportError: no such library"),
        (make_raising, "IndexError: "),
        (make_dying, "ended by signal 9"),
        (make_leaving, "ended with exit code 3"),
    ],
)
def test_reports_a_broken_library_and_times_the_others(make, note):
    results = compared(make, make_either_order)
    assert note in results[make.__name__].note
    assert results["make_right"].note == results["make_either_order"].note == ""
    assert len(results["make_either_order"].ratios) == 2


def test_stops_a_library_that_hangs(monkeypatch):
    results = compared(make_hanging, make_counting, limit=1.0)
    assert results["make_hanging"].note == "no answer in 1 s"
    assert results["make_counting"].is_counted and len(results["make_counting"].ratios) == 2
    monkeypatch.setattr(rounds, "START_SECONDS", 3.0)
    assert compared(make_hanging_at_start)["make_hanging_at_start"].note == "no answer in 3 s"


def test_calls_a_slow_library_once():
    result = compared(make_slow, slow=0.04)["make_slow"]
    assert result.note.startswith("one call: 0.") and not result.times


def test_a_process_that_ended_is_started_again_for_the_next_case():
    runner = Runner(Library("dying", (), make_dying), 1)
    for _ in range(2):
        assert compare([runner], CASE, 1, 20.0, 20.0)["dying"].note == "ended by signal 9"
    runner.stop()


def test_of_two_sets_order_counts():
    case = Case(200, 3, "two sets")
    assert "missing" in compared(make_either_order, case=case)["make_either_order"].note


def test_an_index_is_not_built_in_the_time_of_queries():
    assert [len(boxes) for boxes in Case(200, 2, "queries").inputs()[0]] == [20, 200]
    assert compared(make_slow_to_build, case=Case(200, 2, "queries"), slow=0.04)["make_slow_to_build"].note == ""


def make_slow_to_build(threads):
    return Driver(pairs, build=lambda given: (time.sleep(0.05), given)[1])


@pytest.mark.parametrize("dimension", [2, 3])
def test_sweep_has_the_pairs_of_closed_boxes(dimension):
    for seed, is_self in ((1, True), (2, False)):
        a, b = (np.round(scattered(60, dimension, one) * 8) / 8 for one in (seed, seed + 10))
        right = a if is_self else b
        half = dimension
        overlap = (a[:, None, :half] <= right[None, :, half:]).all(axis=2) & (right[None, :, :half] <= a[:, None, half:]).all(axis=2)
        i, j = np.nonzero(np.triu(overlap, 1) if is_self else overlap)
        assert difference(sweep(a, None if is_self else b), np.sort(i << 32 | j)) == ""


def test_boxes_are_the_same_as_floats_and_some_only_touch():
    boxes = scattered(100_000, 2, 0)
    assert (boxes.astype(np.float32) == boxes).all()
    assert np.intersect1d(boxes[:, 0], boxes[:, 2]).size > 0

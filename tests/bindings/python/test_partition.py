"""Partition: parts whose pairs are disjoint and together all pairs."""

import pickle
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from conftest import as_set, box_arrays, brute_force, scattered
from hypothesis import given
from hypothesis import strategies as st

import broadside


def pairs_by_parts(partition, boxes, other=None, **options):
    """The pairs of all parts, one part after the other."""
    start, row = partition.assign(boxes)
    other_start, other_row = (start, row) if other is None else partition.assign(other)
    found = [np.empty((0, 2), np.int64)]
    for part in range(len(partition)):
        left = row[start[part] : start[part + 1]]
        right = other_row[other_start[part] : other_start[part + 1]]
        pairs = partition.pairs(part, boxes[left], None if other is None else other[right], **options)
        found.append(np.column_stack([left[pairs[:, 0]], right[pairs[:, 1]]]))
    return np.concatenate(found)


@given(data=st.data())
def test_finds_each_pair_in_one_part(data):
    boxes = data.draw(box_arrays())
    partition = broadside.Partition(boxes, data.draw(st.integers(1, 9)), boxes=data.draw(st.sampled_from([0, 1000])))
    assert as_set(pairs_by_parts(partition, boxes)) == brute_force(boxes)


@given(data=st.data())
def test_finds_each_pair_of_two_sets_in_one_part(data):
    dimension, dtype = data.draw(st.sampled_from([2, 3])), data.draw(st.sampled_from([np.float32, np.float64]))
    left, right = (data.draw(box_arrays(dimension, dtype)) for _ in range(2))
    partition = broadside.Partition(np.concatenate([left, right]), data.draw(st.integers(1, 9)))
    assert as_set(pairs_by_parts(partition, left, right)) == brute_force(left, right)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("dimension", [2, 3])
def test_cuts_space_into_parts_of_about_equal_cost(dimension, dtype):
    boxes = scattered(20_000, dimension, dtype)
    partition = broadside.Partition(boxes[::5], 8, boxes=len(boxes))
    assert (len(partition), partition.dimension, partition.dtype) == (8, dimension, dtype)
    sizes = np.diff(partition.assign(boxes).start)
    assert sizes.max() < 1.3 * len(boxes) / 8
    for algorithm, threads in (("auto", None), ("grid", 2)):
        found = pairs_by_parts(partition, boxes, algorithm=algorithm, threads=threads)
        assert as_set(found) == as_set(broadside.pairs(boxes))


def test_assigns_the_rows_of_the_boxes_that_touch_a_part():
    boxes = scattered(3000)
    partition = broadside.Partition(boxes, 5)
    start, row = partition.assign(boxes)
    assert start.dtype == np.int64 and row.dtype == np.uint32
    for part, region in enumerate(partition.regions):
        touches = (boxes[:, 2:] >= region[:2]).all(axis=1) & (boxes[:, :2] < region[2:]).all(axis=1)
        np.testing.assert_array_equal(row[start[part] : start[part + 1]], np.flatnonzero(touches))


def test_can_be_pickled():
    for dimension, dtype in ((2, np.float32), (3, np.float64)):
        boxes = scattered(1000, dimension, dtype)
        partition = broadside.Partition(boxes, 7)
        same = pickle.loads(pickle.dumps(partition))
        np.testing.assert_array_equal(same.regions, partition.regions)
        assert same.dtype == dtype and repr(same) == f"<broadside.Partition: 7 parts in {dimension}D, {np.dtype(dtype)}>"
        for found, expected in zip(same.assign(boxes), partition.assign(boxes)):
            np.testing.assert_array_equal(found, expected)


def test_refuses_cuts_that_are_none():
    constructor, (dimension, dtype, links, places, _), _ = broadside.Partition(scattered(100), 3).__reduce__()
    for wrong in (links[:-1], links[::-1], links + 1):
        with pytest.raises(ValueError, match="Partition"):
            constructor(dimension, dtype, wrong, places)


def test_is_one_part_where_no_cut_tells_boxes_apart():
    assert len(broadside.Partition(np.tile([[0.0, 0, 1, 1]], (100, 1)), 8)) == 1
    assert len(broadside.Partition(np.empty((0, 4)), 8)) == 1


def test_sorts_when_asked():
    boxes = scattered(2000)
    partition = broadside.Partition(boxes, 1)
    np.testing.assert_array_equal(partition.pairs(0, boxes, sort=True), broadside.pairs(boxes, sort=True))


def test_refuses_invalid_boxes_or_leaves_them_out():
    boxes = scattered(100, dtype=np.float64)
    partition = broadside.Partition(boxes, 4)
    boxes[7, 0] = np.nan
    boxes[9] = [1, 1, 0, 0]
    boxes[11] = [np.inf, np.inf, -np.inf, -np.inf]
    for call, argument in ((partition.assign, "boxes"), (lambda bad: broadside.Partition(bad, 4), "sample")):
        with pytest.raises(broadside.InvalidBoxError, match="box 7 has min") as caught:
            call(boxes)
        assert (caught.value.row, caught.value.argument) == (7, argument)
    with pytest.raises(broadside.InvalidBoxError):
        partition.pairs(0, boxes[7:8])
    assert not {7, 9, 11} & set(partition.assign(boxes, quarantine=True).row.tolist())


def test_refuses_what_does_not_fit():
    boxes = scattered(100)
    partition = broadside.Partition(boxes, 4)
    for refused, message in (
        (lambda: broadside.Partition(boxes, 0), "parts is 0; expected 1 to"),
        (lambda: broadside.Partition(boxes, 2, boxes=-1), "boxes is -1; expected 0 to"),
        (lambda: partition.pairs(4, boxes), "part is 4; expected 0 to 3"),
        (lambda: partition.pairs(0, boxes), "boxes: row .* does not touch part 0; expected"),
        (lambda: partition.pairs(0, boxes[:0], boxes), "other: row .* does not touch part 0"),
        (lambda: partition.assign(scattered(10, 3)), r"boxes has shape \(10, 6\); expected \(n, 4\)"),
        (lambda: partition.assign(boxes.astype(np.float64) + 1e-12), "not exact in float32"),
        (lambda: partition.pairs(0, boxes[:0], algorithm="none"), "none"),
    ):
        with pytest.raises(ValueError, match=message):
            refused()


def test_survives_boxes_that_another_thread_changes():
    # What is counted in one pass is filled in another one; boxes that grow between them must not lead beyond.
    code = """
        import threading
        import numpy as np
        import broadside

        corners = np.random.default_rng(1).random((50_000, 2))
        small = np.hstack([corners, corners])
        large = np.hstack([corners - 1, corners + 1])
        boxes, partition = small.copy(), broadside.Partition(small, 64)
        whole = {len(partition.assign(same).row) for same in (small, large)}
        ended = threading.Event()

        def write():
            while not ended.is_set():
                boxes[:] = large
                boxes[:] = small

        writer = threading.Thread(target=write)
        writer.start()
        refused = 0
        for _ in range(60):
            try:
                start, row = partition.assign(boxes)
                assert min(whole) <= len(row) <= max(whole) and row.max() < len(boxes)
            except ValueError as error:
                assert "changed by another thread" in str(error)
                refused += 1
        ended.set()
        writer.join()
        print("survived")
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "survived\n"), done.stderr

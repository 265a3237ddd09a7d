"""Boxes that move through a step: `to` of pairs, count and components, and overlap_times."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import broadside

NEVER = [np.inf, -np.inf]


def times(a, b):
    """When two boxes overlap, each a row at the beginning and one at the end, of whole numbers."""
    enter, leave = Fraction(0), Fraction(1)
    dimension = len(a[0]) // 2
    for axis in range(dimension):
        for first, second in ((a, b), (b, a)):
            begin, end = (int(first[i][axis + dimension]) - int(second[i][axis]) for i in (0, 1))
            if begin < 0 and end < 0:
                return None
            if begin < 0:
                enter = max(enter, Fraction(begin, begin - end))
            elif end < 0:
                leave = min(leave, Fraction(begin, begin - end))
    return (enter, leave) if enter <= leave else None


@given(data=st.data(), dimension=st.sampled_from([2, 3]), dtype=st.sampled_from([np.float32, np.float64]))
def test_finds_what_overlaps_at_one_time(data, dimension, dtype):
    count = data.draw(st.integers(0, 12))
    numbers = np.array(data.draw(st.lists(st.integers(0, 6), min_size=4 * dimension * count, max_size=4 * dimension * count)))
    corners = np.sort(numbers.reshape(2, count, 2, dimension), axis=2).reshape(2, count, 2 * dimension)
    boxes, to = corners.astype(dtype)
    expected = {}
    for i in range(count):
        for j in range(i + 1, count):
            if (found := times(corners[:, i], corners[:, j])) is not None:
                expected[i, j] = [float(time) for time in found]
    pairs = broadside.pairs(boxes, to=to, sort=True)
    assert [tuple(pair) for pair in pairs.tolist()] == sorted(expected)
    assert broadside.overlap_times(boxes, to, pairs).tolist() == [expected[pair] for pair in sorted(expected)]
    assert broadside.count(boxes, to=to) == len(expected)
    half = count // 2
    between = broadside.pairs(boxes[:half], boxes[half:], to=(to[:half], to[half:]), sort=True)
    assert [(a, b + half) for a, b in between.tolist()] == [(i, j) for i, j in sorted(expected) if i < half <= j]
    assert broadside.overlap_times(boxes[:half], (to[:half], to[half:]), between, boxes[half:]).shape == (len(between), 2)


def test_leaves_out_what_passes_one_after_the_other():
    boxes = np.array([[0, 0, 1, 1], [4, 3, 5, 4], [9, 0, 10, 1]], np.float32)
    to = [[9, 0, 10, 1], [4, -30, 5, -29], [0, 0, 1, 1]]
    assert broadside.pairs(boxes, to=to).tolist() == [[0, 2]]
    assert broadside.components(boxes, to=to).tolist() == [0, 1, 0]
    assert broadside.pairs(boxes, to=to, different=[1, 1, 1]).tolist() == []
    assert broadside.overlap_times(boxes, to, [[0, 2], [0, 1]]).tolist() == [[4 / 9, 5 / 9], NEVER]


def test_refuses_what_it_cannot_take():
    boxes = np.array([[0, 0, 1, 1], [2, 2, 3, 3]], np.float32)
    for arguments, error, message in [
        ({"to": boxes[:1]}, ValueError, r"to has shape \(1, 4\); expected \(2, 4\), that of boxes"),
        ({"to": boxes, "touching": False}, ValueError, "touching is False with to"),
        ({"to": boxes, "within": 1}, ValueError, "to is given with within or period"),
        ({"other": boxes, "to": boxes}, TypeError, "expected a tuple of the ends of both sets"),
    ]:
        with pytest.raises(error, match=message):
            broadside.pairs(boxes, **arguments)
    bad = boxes.copy()
    bad[1, 0] = np.nan
    with pytest.raises(broadside.InvalidBoxError, match="box 1") as raised:
        broadside.pairs(boxes, to=bad)
    assert (raised.value.argument, raised.value.row) == ("to", 1)
    assert broadside.pairs(boxes, to=bad, quarantine=True).tolist() == []
    with pytest.raises(ValueError, match="expected ids below 2 and 2"):
        broadside.overlap_times(boxes, boxes, np.array([[0, 2]], np.uint32))

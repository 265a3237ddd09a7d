"""Queries of an Index and of a World against their definitions."""

import pickle

import numpy as np
import pytest
from conftest import box_arrays, brute_force, scattered
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

import broadside


def both(boxes):
    """An index and a world of the same boxes, and the world's handles."""
    world = broadside.World(boxes.shape[1] // 2, dtype=boxes.dtype)
    return broadside.Index(boxes), world, world.add(boxes)


def present(boxes):
    half = boxes.shape[1] // 2
    return boxes[(boxes[:, :half] <= boxes[:, half:]).all(axis=1)]


def found(answer):
    assert (np.diff(answer.query.astype(int)) >= 0).all()
    return set(zip(answer.query.tolist(), answer.box.tolist()))


def enter(box, origin, direction, t_max):
    """Where a ray enters a box, by the library's formula in the boxes' precision; None if it does not."""
    half = len(box) // 2
    near, far = box.dtype.type(0), box.dtype.type(t_max)
    for axis in range(half):
        before, behind = box[axis] - origin[axis], box[half + axis] - origin[axis]
        if direction[axis] == 0:
            if not before <= 0 <= behind:
                return None
            continue
        first, last = (before, behind) if direction[axis] > 0 else (behind, before)
        near, far = max(near, first / direction[axis]), min(far, last / direction[axis])
    return near if near <= far else None


def points(dimension, dtype, most=6):
    elements = st.sampled_from([-2.0, -1.0, 0.0, 0.5, 1.0, 2.5])
    return st.integers(0, most).flatmap(lambda n: npst.arrays(dtype, (n, dimension), elements=elements))


@given(data=st.data())
def test_finds_what_overlaps_and_contains(data):
    boxes = present(data.draw(box_arrays()))
    dimension, dtype = boxes.shape[1] // 2, boxes.dtype
    queries = data.draw(box_arrays(dimension=dimension, dtype=dtype, most=6))
    places = data.draw(points(dimension, dtype))
    index, world, handles = both(boxes)
    expected = brute_force(queries, boxes)
    assert found(index.overlapping(queries)) == expected
    assert found(world.overlapping(queries)) == {(q, int(handles[b])) for q, b in expected}
    expected = brute_force(np.hstack([places, places]), boxes)
    assert found(index.containing(places)) == expected
    assert found(world.containing(places)) == {(q, int(handles[b])) for q, b in expected}


@given(data=st.data())
def test_finds_what_rays_hit(data):
    boxes = present(data.draw(box_arrays()))
    boxes = boxes[np.isfinite(boxes).all(axis=1)]
    dimension, dtype = boxes.shape[1] // 2, boxes.dtype
    origins = data.draw(points(dimension, dtype))
    directions = data.draw(npst.arrays(dtype, origins.shape, elements=st.sampled_from([-1.0, 0.0, 0.5, 2.0])))
    t_max = data.draw(st.sampled_from([np.inf, 1.0]))
    index, world, handles = both(boxes)
    expected = {}
    for i, (origin, direction) in enumerate(zip(origins, directions)):
        for j, box in enumerate(boxes):
            t = enter(box, origin, direction, t_max)
            if t is not None:
                expected[i, j] = t
    hits = index.hits(origins, directions, t_max=t_max)
    assert dict(zip(zip(hits.query.tolist(), hits.box.tolist()), hits.t)) == expected
    assert hits.t.dtype == dtype
    of_world = world.hits(origins, directions, t_max=t_max)
    assert {(q, int(h)) for q, h in zip(of_world.query, of_world.box)} == {(q, int(handles[b])) for q, b in expected}
    first = index.first_hit(origins, directions, t_max=t_max)
    first_of_world = world.first_hit(origins, directions, t_max=t_max)
    for i in range(len(origins)):
        met = sorted((t, box) for (query, box), t in expected.items() if query == i)
        assert first.box[i] == (met[0][1] if met else 2**32 - 1)
        assert first.t[i] == (met[0][0] if met else np.inf)
        assert first_of_world.box[i] == (handles[met[0][1]] if met else 2**64 - 1)


@given(data=st.data(), k=st.integers(1, 50))
def test_finds_the_nearest(data, k):
    boxes = present(data.draw(box_arrays()))
    boxes = boxes[np.isfinite(boxes).all(axis=1)]
    dimension, dtype = boxes.shape[1] // 2, boxes.dtype
    places = data.draw(points(dimension, dtype))
    index, world, handles = both(boxes)
    answer = index.nearest(places, k)
    assert answer.box.shape == answer.distance_squared.shape == (len(places), k)
    for i, place in enumerate(places):
        outside = np.maximum(np.maximum(boxes[:, :dimension] - place, place - boxes[:, dimension:]), 0)
        squares = (outside * outside).sum(axis=1, dtype=dtype)
        order = np.lexsort((np.arange(len(boxes)), squares))[:k]
        there = len(order)
        np.testing.assert_array_equal(answer.box[i, :there], order)
        np.testing.assert_array_equal(answer.distance_squared[i, :there], squares[order])
        assert (answer.box[i, there:] == 2**32 - 1).all() and np.isinf(answer.distance_squared[i, there:]).all()
        np.testing.assert_array_equal(world.nearest(places, k).box[i, :there], handles[order])


def test_is_described_and_pickled():
    boxes = scattered(100, 3)
    index = broadside.Index(boxes)
    assert (len(index), index.dimension, index.dtype) == (100, 3, np.float32) and index.nbytes > 0
    again = pickle.loads(pickle.dumps(index))
    assert found(again.overlapping(boxes)) == found(index.overlapping(boxes))
    np.testing.assert_array_equal(index.boxes, boxes)
    boxes[:] = 0
    assert index.boxes.any() and not index.boxes.flags.writeable


def test_asks_in_the_dtype_of_the_boxes():
    boxes = scattered(50)
    index = broadside.Index(boxes)
    assert len(index.containing([[0.5, 0.25]])) == 2
    with pytest.raises(ValueError, match=r"points is float64, and its row 0, \[0.1, 0.2\], is not exact in float32"):
        index.containing([[0.1, 0.2]])
    broadside.Index(boxes, dtype=np.float64).containing([[0.1, 0.2]])
    with pytest.raises(ValueError, match="expected float32 or float64"):
        broadside.Index(boxes, dtype=int)


def test_refuses_questions_that_have_no_answer():
    for index in both(scattered(20, dtype=np.float64))[:2]:
        with pytest.raises(broadside.InvalidQueryError, match="query 1"):
            index.overlapping([[0, 0, 1, 1], [np.nan, 0, 1, 1]])
        with pytest.raises(broadside.InvalidQueryError, match="query 0"):
            index.hits([[np.inf, 0]], [[1, 0]])
        with pytest.raises(broadside.InvalidQueryError):
            index.nearest([[np.nan, 0]])
        with pytest.raises(ValueError, match="1 origins and 2 directions"):
            index.first_hit([[0, 0]], [[1, 0], [1, 0]])
        with pytest.raises(ValueError, match=r"shape \(1, 3\); expected \(n, 2\)"):
            index.containing([[0, 0, 0]])
        with pytest.raises(ValueError, match="k is 0"):
            index.nearest([[0, 0]], 0)
        for k, error in ((1.5, TypeError), (True, TypeError), (2**70, ValueError), (65_537, ValueError)):
            with pytest.raises(error, match="k is"):
                index.nearest([[0, 0]], k)
        for t_max in (None, "1"):
            with pytest.raises(TypeError, match="t_max is of .*; expected a number"):
                index.hits([[0, 0]], [[1, 0]], t_max=t_max)
        with pytest.raises(TypeError, match="points is of NoneType"):
            index.containing(None)


def test_a_hit_is_at_most_at_t_max():
    step = np.float32(0.1)  # greater than 0.1
    index = broadside.Index(np.array([[step, 0, 1, 1]], np.float32))
    assert len(index.hits([[0, 0]], [[1, 0]], t_max=0.1).t) == 0
    assert index.hits([[0, 0]], [[1, 0]], t_max=float(step)).t.tolist() == [float(step)]
    for t_max in (1e300, np.float64(1e39), 10**30):
        assert len(index.hits([[0, 0]], [[1, 0]], t_max=t_max).t) == 1
    with pytest.raises(ValueError, match="t_max"):
        index.hits([[0, 0]], [[1, 0]], t_max=10**400)


def test_takes_infinite_points():
    index = broadside.Index(scattered(3))
    assert np.isinf(index.nearest([[np.inf, 0]], 3).distance_squared).all()

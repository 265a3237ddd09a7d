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


def test_leaves_out_boxes_that_a_ray_does_not_enter():
    for dtype in (np.float32, np.float64):
        index, world, handles = both(np.array([[0, 0, 2, 2], [4, 0, 6, 2]], dtype))
        origins = [[1, 1], [2, 1], [2, 1], [1, 2], [0, 1], [0, 1]]  # inside, on the border out and in, along it ...
        directions = [[1, 0], [1, 0], [-1, 0], [1, 0], [1, 0], [-1, 0]]
        rays = (origins, directions)
        expected = {(0, 1): 3, (1, 1): 2, (2, 0): 0, (3, 1): 3, (4, 0): 0, (4, 1): 4}
        hits = index.hits(*rays, entering=True)
        assert dict(zip(zip(hits.query.tolist(), hits.box.tolist()), hits.t.tolist())) == expected
        assert found(world.hits(*rays, entering=True)) == {(query, int(handles[box])) for query, box in expected}
        assert index.first_hit(*rays, entering=True).box.tolist() == [1, 1, 0, 1, 0, 2**32 - 1]
        first = world.first_hit(*rays, entering=True)
        assert first.t.tolist() == [3, 2, 0, 3, 0, np.inf] and first.box[0] == handles[1]
        assert len(index.hits(*rays).box) > len(hits.box)


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
        lower, upper = (part.astype(np.float64) for part in (boxes[:, :dimension], boxes[:, dimension:]))
        outside = np.maximum(np.maximum(lower - place, place - upper), 0)
        squares = (outside * outside).sum(axis=1)
        order = np.lexsort((np.arange(len(boxes)), squares))[:k]
        there = len(order)
        np.testing.assert_array_equal(answer.box[i, :there], order)
        np.testing.assert_array_equal(answer.distance_squared[i, :there], squares[order])
        assert (answer.box[i, there:] == 2**32 - 1).all() and np.isinf(answer.distance_squared[i, there:]).all()
        np.testing.assert_array_equal(world.nearest(places, k).box[i, :there], handles[order])


@pytest.mark.parametrize("dimension", [2, 3])
def test_takes_points_as_boxes_without_extent(dimension):
    points = np.random.default_rng(1).random((50, dimension))
    expected = broadside.Index(np.hstack([points, points]))
    for found in (points, points.tolist(), points.astype(np.float32).astype(np.float64, order="F")):
        index = broadside.Index(found)
        assert len(index) == 50 and index.dimension == dimension
    np.testing.assert_array_equal(broadside.Index(points).boxes, expected.boxes)
    np.testing.assert_array_equal(broadside.Index(points).nearest(points, k=3).box, expected.nearest(points, k=3).box)
    with pytest.raises(ValueError, match=r"np.hstack\(\[points, points\]\)"):
        broadside.Index(points).overlapping(points)
    with pytest.raises(ValueError, match=r"np.hstack\(\[points, points\]\)"):
        broadside.pairs(points)
    points[3, 1] = np.nan
    with pytest.raises(broadside.InvalidBoxError, match="^1 of 50 rows is invalid: box 3"):
        broadside.Index(points)


def test_is_described_and_pickled():
    boxes = scattered(100, 3)
    index = broadside.Index(boxes)
    assert (len(index), index.dimension, index.dtype) == (100, 3, np.float32) and index.nbytes > 0
    again = pickle.loads(pickle.dumps(index))
    assert found(again.overlapping(boxes)) == found(index.overlapping(boxes))
    np.testing.assert_array_equal(index.boxes, boxes)
    boxes[:] = 0
    assert index.boxes.any() and not index.boxes.flags.writeable


def test_its_boxes_cannot_be_changed():
    index = broadside.Index(scattered(10))
    before = index.boxes.copy()
    for array in (index.boxes, index.boxes[2:], index.boxes.reshape(-1), index.boxes.view(np.uint32)):
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True
    index.boxes.shape = (40,)
    index.boxes.dtype = np.uint32
    np.testing.assert_array_equal(index.boxes, before)
    empty = broadside.Index(np.empty((0, 6), np.float32))
    assert empty.boxes.shape == (0, 6) and empty.dtype == np.float32


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
            with pytest.raises(TypeError, match="t_max is .*; expected a number"):
                index.hits([[0, 0]], [[1, 0]], t_max=t_max)
        with pytest.raises(TypeError, match="points is None"):
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


KINDS = broadside.filters(6, category=[1, 1, 2, 2, 4, 4], mask=[1, 2, 4, 7, 1, 7])


def accepts(a, b):
    return bool(a["category"] & b["mask"]) and bool(b["category"] & a["mask"])


def outside(boxes, place):
    half = boxes.shape[1] // 2
    return np.maximum(np.maximum(boxes[:, :half] - place, place - boxes[:, half:]), 0)


@given(data=st.data(), k=st.integers(1, 20), max_distance=st.sampled_from([0.0, 0.5, 1.0, 2.0, np.inf]))
def test_queries_take_filters_and_leave_out_a_box(data, k, max_distance):
    boxes = present(data.draw(box_arrays()))
    boxes = boxes[np.isfinite(boxes).all(axis=1)]
    dimension, dtype = boxes.shape[1] // 2, boxes.dtype
    places = data.draw(points(dimension, dtype))
    m = len(places)
    kinds = KINDS[np.arange(len(boxes)) % 6]
    asked = data.draw(st.sampled_from([None, KINDS[:1], KINDS[3], KINDS[np.arange(m) % 6]]))
    left_out = data.draw(st.sampled_from([None, [0], 2, (np.arange(m) % max(len(boxes), 1)).tolist()]))
    none = 2**32 - 1
    index, world = broadside.Index(boxes, filters=kinds), broadside.World(dimension, dtype=dtype)
    handles = world.add(boxes, filters=kinds)

    def allowed(query, box):
        filter = None if asked is None else np.broadcast_to(asked, (m,))[query]
        wanted = none if left_out is None else np.broadcast_to(left_out, (m,))[query]
        return box != wanted and (filter is None or accepts(filter, kinds[box]))

    def handle_of(row):
        return 2**64 - 1 if row >= len(boxes) else int(handles[row])

    options = {"filters": asked, "exclude": left_out}
    of_world = options | {"exclude": None if left_out is None else [handle_of(row) for row in np.atleast_1d(left_out)]}
    queries = np.hstack([places, places + 1])
    directions = np.ones_like(places)
    for name, arguments, pairs in [
        ("overlapping", (queries,), brute_force(queries, boxes)),
        ("containing", (places,), brute_force(np.hstack([places, places]), boxes)),
    ]:
        expected = {(query, box) for query, box in pairs if allowed(query, box)}
        assert found(getattr(index, name)(*arguments, **options)) == expected
        assert found(getattr(world, name)(*arguments, **of_world)) == {(q, int(handles[b])) for q, b in expected}
    hits = index.hits(places, directions, **options)
    every = index.hits(places, directions)
    expected = {(q, b): t for q, b, t in zip(every.query.tolist(), every.box.tolist(), every.t.tolist()) if allowed(q, b)}
    assert dict(zip(zip(hits.query.tolist(), hits.box.tolist()), hits.t.tolist())) == expected
    assert found(world.hits(places, directions, **of_world)) == {(q, int(handles[b])) for q, b in expected}
    first, first_of_world = index.first_hit(places, directions, **options), world.first_hit(places, directions, **of_world)
    near = index.nearest(places, k, max_distance=max_distance, **options)
    near_of_world = world.nearest(places, k, max_distance=max_distance, **of_world)
    for query, place in enumerate(places):
        met = sorted((t, box) for (q, box), t in expected.items() if q == query)
        assert first.box[query] == (met[0][1] if met else none)
        assert first_of_world.box[query] == (handles[met[0][1]] if met else 2**64 - 1)
        squares = (outside(boxes.astype(np.float64), place.astype(np.float64)) ** 2).sum(axis=1)
        order = [box for box in np.lexsort((np.arange(len(boxes)), squares)) if allowed(query, box)]
        order = [box for box in order if squares[box] <= max_distance**2][:k]
        assert near.box[query].tolist() == order + [none] * (k - len(order))
        assert near_of_world.box[query].tolist() == [int(handles[box]) for box in order] + [2**64 - 1] * (k - len(order))
    again = pickle.loads(pickle.dumps(index))
    np.testing.assert_array_equal(again.nearest(places, k, **options).box, index.nearest(places, k, **options).box)


def test_finds_the_nearest_other_boxes():
    boxes = scattered(200, dtype=np.float64)
    index, centres = broadside.Index(boxes), (boxes[:, :2] + boxes[:, 2:]) / 2
    own = np.arange(200)
    assert (index.nearest(centres, 1, max_distance=0).distance_squared == 0).all()
    others = index.nearest(centres, 3, exclude=own)
    assert not (others.box == own[:, None]).any() and np.isfinite(others.distance_squared).all()
    world = broadside.World(2)
    handles = world.add(boxes)
    np.testing.assert_array_equal(world.nearest(centres, 3, exclude=handles).box, handles[others.box])


def test_refuses_options_of_queries_that_do_not_fit():
    for index in both(scattered(20, dtype=np.float64))[:2]:
        two = [[0, 0], [1, 1]]
        for options, error, message in [
            ({"max_distance": -1}, ValueError, "max_distance is -1; expected 0 or more"),
            ({"max_distance": np.nan}, ValueError, "max_distance is nan; expected 0 or more"),
            ({"max_distance": "1"}, TypeError, "max_distance is a str; expected a number"),
            ({"exclude": [1, 2, 3]}, ValueError, "2 queries and 3 boxes in exclude; expected one for each query, or one"),
            ({"exclude": []}, ValueError, "2 queries and 0 boxes in exclude"),
            ({"exclude": [-1, 2]}, ValueError, "exclude has -1"),
            ({"exclude": [0.5, 2]}, TypeError, "exclude has dtype float64"),
            ({"filters": broadside.filters(3)}, ValueError, r"filters has shape \(3,\); expected \(2,\)"),
            ({"filters": [1, 2]}, TypeError, "expected what broadside.filters"),
        ]:
            with pytest.raises(error, match=message):
                index.nearest(two, **options)
    with pytest.raises(ValueError, match=r"filters has shape \(3,\); expected \(20,\), a filter for each box"):
        broadside.Index(scattered(20), filters=broadside.filters(3))

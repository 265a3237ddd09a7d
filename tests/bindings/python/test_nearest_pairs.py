"""nearest_pairs(): for each box the nearest ones, by the definition."""

from __future__ import annotations

import numpy as np
import pytest

import broadside


def by_definition(left, right, k, max_distance=np.inf):
    half = left.shape[1] // 2
    a, b = left.astype(np.float64), (left if right is None else right).astype(np.float64)
    rows, squares = [], []
    for i, box in enumerate(a):
        gaps = np.maximum(np.maximum(b[:, :half] - box[half:], box[:half] - b[:, half:]), 0)
        found = (gaps * gaps).sum(axis=1)
        order = [j for j in np.argsort(found, kind="stable") if found[j] <= max_distance**2 and (right is not None or j != i)][:k]
        rows.append(order + [2**32 - 1] * (k - len(order)))
        squares.append(found[order].tolist() + [np.inf] * (k - len(order)))
    return np.array(rows), np.array(squares)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("dimension", [2, 3])
def test_finds_the_nearest_of_each(dimension, dtype):
    rng = np.random.default_rng(dimension)
    sets = []
    for _ in range(2):
        minima = rng.integers(0, 9, (150, dimension)).astype(dtype)  # many are equally near
        sets.append(np.hstack([minima, minima + rng.integers(0, 2, minima.shape).astype(dtype)]))
    for right in (None, sets[1]):
        for k in (1, 7, 150, 151):
            for options in ({}, {"max_distance": 1}, {"max_distance": 0, "threads": 2}):
                near = broadside.nearest_pairs(sets[0], right, k, **options)
                boxes, squares = by_definition(sets[0], right, k, options.get("max_distance", np.inf))
                np.testing.assert_array_equal(near.box, boxes)
                np.testing.assert_array_equal(near.distance_squared, squares)


def test_takes_points_and_widens_floats():
    points = np.array([[0, 0], [3, 0], [3, 4]], np.float32)
    assert broadside.nearest_pairs(points).box.tolist() == [[1], [0], [1]]
    near = broadside.nearest_pairs(points, [[0, 5.5, 3, 6]], max_distance=1.5)
    assert [one.tolist() for one in near.pairs()] == [[2], [0]]


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.float16, np.int16, ">f8"])
def test_points_are_boxes_without_extent(dtype):
    points = np.random.default_rng(4).integers(0, 40, (300, 3))
    expected = broadside.nearest_pairs(np.hstack([points, points]).astype(np.float64), k=3)
    wide = np.hstack([points, points]).astype(dtype)
    for given in (points.astype(dtype), np.asfortranarray(points, dtype), wide[:, :3]):
        near = broadside.nearest_pairs(given, k=3)
        np.testing.assert_array_equal(near.box, expected.box)
        np.testing.assert_array_equal(near.distance_squared, expected.distance_squared)
    filters = broadside.filters(300, is_static=points[:, 0] < 20)
    boxes = np.hstack([points, points]).astype(np.float64)
    near = broadside.nearest_pairs(points.astype(dtype), k=3, filters=filters, max_distance=5)
    np.testing.assert_array_equal(near.box, broadside.nearest_pairs(boxes, k=3, filters=filters, max_distance=5).box)


@pytest.mark.parametrize("k", [1, 4, 200])
@pytest.mark.parametrize("rules", [["same"], ["different"], ["same", "different"]])
def test_neighbours_have_equal_or_unequal_keys(k, rules):
    rng = np.random.default_rng(3)
    points = rng.integers(0, 30, (210, 2)).astype(float)
    keys = {"same": rng.choice(["a", "b", "c", "d"], 210), "different": rng.integers(0, 3, 210)}
    keys["same"][120:130] = "e"  # which only the second set has
    filters = broadside.filters(210, is_static=rng.random(210) < 0.5)
    squares = ((points[:, None] - points[None]) ** 2).sum(axis=2)
    for has_filters in (False, True):
        allowed = (squares <= 81) & ~np.eye(210, dtype=bool)
        for rule in rules:
            allowed &= (keys[rule][:, None] == keys[rule]) == (rule == "same")
        if has_filters:
            allowed &= ~(filters["is_static"][:, None] & filters["is_static"])
        of_one = {rule: keys[rule] for rule in rules} | ({"filters": filters} if has_filters else {})
        of_two = {rule: (keys[rule][:120], keys[rule][120:]) for rule in rules}
        of_two |= {"filters": filters[:120], "other_filters": filters[120:]} if has_filters else {}
        for near, rows, first in [
            (broadside.nearest_pairs(points, k=k, max_distance=9, **of_one), range(210), 0),
            (broadside.nearest_pairs(points[:120], points[120:], k, max_distance=9, **of_two), range(120), 120),
        ]:
            for row in rows:
                order = [j for j in np.argsort(squares[row, first:], kind="stable") if allowed[row, first + j]][:k]
                some = len(order)
                assert near.box[row, :some].tolist() == order
                assert near.distance_squared[row, :some].tolist() == squares[row, first:][order].tolist()
                assert (near.box[row, some:] == 2**32 - 1).all() and np.isinf(near.distance_squared[row, some:]).all()


def test_refuses_keys_that_do_not_fit():
    boxes = np.array([[0, 0, 1, 1]] * 3, np.float64)
    with pytest.raises(ValueError, match=r"^filters has shape \(2,\); expected \(3,\)"):
        broadside.nearest_pairs(boxes, same=[1, 2, 3], filters=broadside.filters(2))
    for keys in ({}, {"same": ([1, 1, 1], [1, 1, 1])}):
        with pytest.raises(ValueError, match=r"^other_filters has shape \(2,\); expected \(3,\)"):
            broadside.nearest_pairs(boxes, boxes, other_filters=broadside.filters(2), **keys)
    with pytest.raises(ValueError, match="^other_filters has 2 filters and different 3 keys"):
        broadside.nearest_pairs(boxes, boxes, other_filters=broadside.filters(2), different=([1] * 3, [1] * 3))
    with pytest.raises(ValueError, match="^threads is -5"):
        broadside.nearest_pairs(boxes, boxes, same=([1, 1, 1], [2, 2, 2]), threads=-5)
    with pytest.raises(ValueError, match="same has 2 keys for 3 boxes"):
        broadside.nearest_pairs(boxes, same=[1, 2])
    with pytest.raises(ValueError, match="max_distance is -1"):
        broadside.nearest_pairs(boxes, boxes, same=([1, 1, 1], [2, 2, 2]), max_distance=-1)
    boxes[2, 0] = 7
    with pytest.raises(broadside.InvalidBoxError, match="box 2"):
        broadside.nearest_pairs(boxes, same=[1, 2, 2])


def test_takes_one_filter_for_all_with_keys_as_without():
    boxes = np.array([[0, 0, 1, 1], [3, 0, 4, 1]], np.float64)
    statics = {"filters": broadside.filters(1, is_static=True), "other_filters": broadside.filters(2, is_static=[True, False])}
    for keys in ({}, {"same": ([1, 1], [1, 1])}, {"different": ([1, 1], [2, 2])}):
        assert broadside.nearest_pairs(boxes, boxes, **statics, **keys).box.tolist() == [[1], [1]]


def test_refuses_what_has_no_answer():
    boxes = np.array([[0, 0, 1, 1]] * 3, np.float64)
    bad = boxes.copy()
    bad[1, 2] = np.nan
    with pytest.raises(broadside.InvalidBoxError, match="box 1"):
        broadside.nearest_pairs(bad)
    with pytest.raises(broadside.InvalidQueryError, match="query 1"):
        broadside.nearest_pairs(bad, boxes)
    with pytest.raises(ValueError, match="k is 0"):
        broadside.nearest_pairs(boxes, k=0)
    with pytest.raises(ValueError, match="max_distance is nan"):
        broadside.nearest_pairs(boxes, max_distance=np.nan)
    with pytest.raises(ValueError, match="other_filters are given without other boxes"):
        broadside.nearest_pairs(boxes, other_filters=broadside.filters(3))
    with pytest.raises(ValueError, match="boxes have 2 dimensions and other has 3"):
        broadside.nearest_pairs(boxes, np.zeros((2, 6)))

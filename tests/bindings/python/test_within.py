"""Pairs within a distance against a comparison of all points, distances and neighbour lists."""

import itertools

import broadside
import numpy as np
import pytest

Rng = np.random.Generator


def reference(boxes: np.ndarray, reach: np.ndarray) -> list[list[int]]:
    """The pairs (a, b) of boxes of whole numbers within reach[a, b]."""
    half = boxes.shape[1] // 2
    lower, upper = boxes[:, :half].astype(np.int64), boxes[:, half:].astype(np.int64)
    gaps = np.maximum(0, np.maximum(lower[:, None] - upper[None], lower[None] - upper[:, None]))
    near = (gaps**2).sum(axis=2) <= reach**2
    return [[a, b] for a, b in itertools.combinations(range(len(boxes)), 2) if near[a, b]]


def drawn(rng: Rng, n: int, dimension: int, dtype: type) -> np.ndarray:
    lower = rng.integers(0, 30, (n, dimension))
    return np.hstack([lower, lower + rng.integers(0, 3, (n, dimension))]).astype(dtype)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_finds_each_pair_within_a_distance_or_radii(dimension: int, dtype: type) -> None:
    rng = np.random.default_rng(1)
    boxes = drawn(rng, 150, dimension, dtype)
    for distance in (0, 1, 5):
        expected = reference(boxes, np.full((150, 150), distance))
        found = broadside.pairs(boxes, within=distance, sort=True)
        assert found.tolist() == expected
        assert broadside.count(boxes, within=distance) == len(expected)
        assert broadside.distances(boxes, found).max(initial=0) <= distance
    radii = rng.integers(0, 4, 150)
    expected = reference(boxes, radii[:, None] + radii[None])
    assert broadside.pairs(boxes, within=radii, sort=True).tolist() == expected
    between = broadside.pairs(boxes[:70], boxes[70:], within=(radii[:70], radii[70:]), sort=True)
    assert between.tolist() == [[a, b - 70] for a, b in expected if a < 70 <= b]
    assert broadside.pairs(boxes, within=5, output="sparse").nnz == broadside.count(boxes, within=5)


def test_takes_points_and_lists_their_neighbours() -> None:
    points = np.random.default_rng(2).random((400, 3))
    near = np.linalg.norm(points[:, None] - points[None], axis=2) <= 0.15
    np.fill_diagonal(near, False)
    pairs = broadside.pairs(points, within=0.15)
    for full, expected in ((True, near), (False, np.triu(near))):
        lists = broadside.neighbour_lists(pairs, len(points), full=full)
        for i in range(len(points)):
            assert lists.ids[lists.offsets[i] : lists.offsets[i + 1]].tolist() == np.flatnonzero(expected[i]).tolist()
    distances = broadside.distances(points, pairs)
    assert np.allclose(distances, np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1))
    same = np.arange(400) % 2
    kept = broadside.pairs(points, within=0.15, same=same, sort=True)
    assert kept.tolist() == [[a, b] for a, b in np.argwhere(np.triu(near)).tolist() if same[a] == same[b]]
    assert broadside.components(np.array([[0, 0], [1, 0], [5, 0], [2, 0.5]]), within=1.2).tolist() == [0, 0, 2, 0]
    assert broadside.neighbour_lists([[0, 2]], 3).ids.tolist() == [2, 0]


def test_refuses_a_distance_or_radii_that_are_none() -> None:
    points = np.zeros((3, 2))
    for wrong in (-1, np.nan, np.inf, [0, 1, -2], [0, np.nan, 1]):
        with pytest.raises(broadside.InvalidQueryError, match="expected a finite number of 0 or more"):
            broadside.pairs(points, within=wrong)
    with pytest.raises(ValueError, match="2 radii for 3 boxes"):
        broadside.pairs(points, within=[1, 2])
    with pytest.raises(ValueError, match="within has shape"):
        broadside.pairs(points, within=np.ones((3, 2)))
    with pytest.raises(TypeError, match="within has dtype"):
        broadside.pairs(points, within=np.array(["a", "b", "c"]))
    with pytest.raises(TypeError, match="radii of both sets as a tuple"):
        broadside.pairs(points, points, within=np.ones(3))
    with pytest.raises(ValueError, match="3 elements"):
        broadside.pairs(points, points, within=[1, 2, 3])
    with pytest.raises(ValueError, match="touching is False"):
        broadside.pairs(points, within=1, touching=False)
    with pytest.raises(ValueError, match="0 to 2|below 3"):
        broadside.distances(points, [[0, 3]])
    with pytest.raises(ValueError, match="below 3"):
        broadside.neighbour_lists(np.array([[0, 3]], np.uint32), 3)

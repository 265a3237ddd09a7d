"""period: pairs around the edge of space that repeats."""

import numpy as np
import pytest

import broadside


def images_within(points, period, reach):
    """The definition: the nearest image on each axis."""
    gaps = np.abs(points[:, None] - points[None])
    for axis, length in enumerate(period):
        if length is not None:
            gaps[..., axis] %= length
            gaps[..., axis] = np.minimum(gaps[..., axis], length - gaps[..., axis])
    near = (gaps**2).sum(axis=2) <= reach * reach
    return {(i, j) for i, j in zip(*np.nonzero(np.triu(near, 1)))}


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("period", [(10, 7), (10, None), (8, 8, 8), (None, 9, 4)])
def test_finds_points_whose_images_are_near(period, dtype):
    rng = np.random.default_rng(1)
    points = rng.integers(-30, 30, (150, len(period))).astype(dtype)
    for reach in (1, 2, 5):
        found = broadside.pairs(points, within=reach, period=period)
        assert {tuple(pair) for pair in found.tolist()} == images_within(points.astype(float), period, reach)
        assert len(found) == broadside.count(points, within=reach, period=period)
        distances = broadside.distances(points, found, period=period)
        assert distances.max() <= reach
    left, right = points[:60], points[60:]
    found = broadside.pairs(left, right, within=2, period=period)
    expected = {(i, j - 60) for i, j in images_within(points.astype(float), period, 2) if i < 60 <= j}
    assert {tuple(pair) for pair in found.tolist()} == expected


@pytest.mark.parametrize("dimension", [2, 3])
def test_one_period_is_that_of_all_axes(dimension):
    points = np.random.default_rng(1).integers(-30, 30, (150, dimension)).astype(float)
    each = (10,) * dimension
    found = broadside.pairs(points, within=2, period=10, sort=True)
    assert found.tolist() == broadside.pairs(points, within=2, period=each, sort=True).tolist()
    assert len(found) == broadside.count(points, within=2, period=10) > broadside.count(points, within=2)
    assert (broadside.distances(points, found, period=10) == broadside.distances(points, found, period=each)).all()
    assert (broadside.components(points, within=2, period=10) == broadside.components(points, within=2, period=each)).all()
    assert broadside.count(points, points, within=2, period=10) == broadside.count(points, points, within=2, period=each)
    assert broadside.count(np.hstack([points, points]), [], period=10) == broadside.count([], points, within=1, period=10) == 0


def test_joins_boxes_across_the_date_line():
    regions = np.array([[170.0, -10, 190, 10], [-180, 0, -175, 5], [0, 0, 1, 1]])
    assert broadside.pairs(regions, period=(360, None)).tolist() == [[0, 1]]
    assert broadside.pairs(regions).tolist() == []
    assert broadside.components(regions, period=(360, None)).tolist() == [0, 0, 2]
    assert broadside.pairs(regions, period=(360, None), same=[1, 2, 1]).tolist() == []


def test_refuses_what_is_no_period():
    boxes = np.zeros((3, 4))
    with pytest.raises(broadside.InvalidQueryError, match="the period of axis 1 is 0"):
        broadside.pairs(boxes, period=(1, 0))
    with pytest.raises(broadside.InvalidQueryError, match="3 periods for boxes of 2 dimensions"):
        broadside.pairs(boxes, period=(1, 1, 1))
    with pytest.raises(ValueError, match="period is empty"):
        broadside.pairs(boxes, period=[])
    for period in ("5", object(), (1, "5")):
        with pytest.raises(TypeError, match="period is .*; expected a number"):
            broadside.pairs(boxes, period=period)
    for call in (broadside.Tracker, broadside.World, broadside.Index, broadside.nearest_pairs):
        with pytest.raises(TypeError, match=f"{call.__name__}.. has no argument 'period'. Only pairs.., .* know periodic space"):
            call(boxes if call is broadside.Index else 2, period=1)
    with pytest.raises(ValueError, match="touching is False with within or period"):
        broadside.pairs(boxes, period=(1, 1), touching=False)

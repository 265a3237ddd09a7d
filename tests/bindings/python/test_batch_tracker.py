"""BatchTracker: in each world, the differences between the pairs of two frames."""

import numpy as np
import pytest
from conftest import scattered

import broadside


def pairs_of(boxes, offsets, **options):
    found = broadside.find_pairs_batch(boxes, offsets, **options)
    return [
        {tuple(pair) for pair in found.pairs[begin:end].tolist()}
        for begin, end in zip(found.offsets[:-1], found.offsets[1:])
    ]


def sets_of(pairs):
    return [
        {tuple(pair) for pair in pairs.pairs[begin:end].tolist()}
        for begin, end in zip(pairs.offsets[:-1], pairs.offsets[1:])
    ]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("dimension", [2, 3])
def test_tells_the_differences_of_every_world(dimension, dtype):
    offsets = np.cumsum([0, 0, 1, 300, *range(100)])
    n = offsets[-1]
    tracker = broadside.BatchTracker(dimension, dtype=dtype)
    assert (tracker.dimension, tracker.dtype) == (dimension, dtype)
    before = [set()] * (len(offsets) - 1)
    for frame in range(4):
        boxes = scattered(n, dimension, dtype, seed=frame)
        filters = broadside.filters(n, group=np.arange(n) % 7 - 5) if frame > 1 else None
        events = tracker.update(boxes, offsets, filters=filters)
        now = pairs_of(boxes, offsets, filters=filters)
        assert sets_of(events.begun) == [new - old for new, old in zip(now, before)]
        assert sets_of(events.ended) == [old - new for new, old in zip(now, before)]
        before = now
    assert tracker.nbytes >= boxes.nbytes


def test_takes_an_array_of_worlds_and_touching():
    tracker = broadside.BatchTracker(2, touching=False, threads=1)
    worlds = np.array([[[0, 0, 1, 1], [1, 0, 2, 1]], [[0, 0, 1, 1], [0.5, 0, 2, 1]]])
    events = tracker.update(worlds)
    assert events.begun.pairs.tolist() == [[0, 1]]
    assert events.begun.offsets.tolist() == [0, 0, 1]
    worlds[0, 0, 2] = 1.5
    worlds[1, 0] = [np.inf, np.inf, -np.inf, -np.inf]
    events = tracker.update(worlds)
    assert events.begun.offsets.tolist() == [0, 1, 1]
    assert events.ended.offsets.tolist() == [0, 0, 1]


def test_refuses_other_worlds_and_takes_nothing_then():
    tracker = broadside.BatchTracker(2)
    worlds = np.zeros((3, 2, 4))
    tracker.update(worlds)
    with pytest.raises(ValueError, match="2 worlds, after 3 in the update before; expected as many"):
        tracker.update(worlds[:2])
    with pytest.raises(ValueError, match="world 0 has 3 boxes, after 2 in the update before"):
        tracker.update(worlds.reshape(-1, 4), [0, 3, 4, 6])
    worlds[1, 1, 2] = -1
    with pytest.raises(broadside.InvalidBoxError, match="which is box 1 of world 1") as error:
        tracker.update(worlds)
    assert error.value.row == 3
    worlds[1, 1, 2] = 0
    events = tracker.update(worlds)
    assert len(events.begun.pairs) == len(events.ended.pairs) == 0
    with pytest.raises(TypeError, match="cannot be pickled"):
        tracker.__reduce__()
    with pytest.raises(broadside.InvalidAlgorithmError):
        broadside.BatchTracker(2, algorithm="gird")

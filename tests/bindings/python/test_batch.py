"""find_pairs_batch(): the pairs of a loop over pairs(), in its order."""

import numpy as np
import pytest
from conftest import scattered

import broadside


def by_a_loop(boxes, offsets, **options):
    found = [broadside.pairs(boxes[begin:end], **options) for begin, end in zip(offsets[:-1], offsets[1:])]
    ends = np.cumsum([0] + [len(pairs) for pairs in found])
    return np.concatenate([np.empty((0, 2), np.uint32), *found]), ends


def assert_is(found, expected):
    pairs, offsets = expected
    assert found.pairs.dtype == np.uint32 and found.offsets.dtype == np.int64
    np.testing.assert_array_equal(found.pairs, pairs)
    np.testing.assert_array_equal(found.offsets, offsets)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("dimension", [2, 3])
def test_finds_the_pairs_of_a_loop_in_its_order(dimension, dtype):
    sizes = [0, 1, 100, 30, 0, 2000, *range(200), 0]
    boxes = np.concatenate([scattered(size, dimension, dtype, seed) for seed, size in enumerate(sizes)])
    offsets = np.cumsum([0, *sizes])
    expected = by_a_loop(boxes, offsets)
    assert len(expected[0]) > 1000
    for threads in (None, 1, 3):
        assert_is(broadside.find_pairs_batch(boxes, offsets, threads=threads), expected)
    for kind in (np.uint32, np.uint64, list):
        given = offsets.tolist() if kind is list else offsets.astype(kind)
        assert_is(broadside.find_pairs_batch(boxes, given), expected)
    expected = by_a_loop(boxes, offsets, algorithm="bvh")
    assert_is(broadside.find_pairs_batch(boxes, offsets, algorithm="bvh"), expected)


def test_takes_an_array_of_worlds():
    worlds = np.stack([scattered(50, 3, seed=seed) for seed in range(20)])
    worlds[3, 40:] = [np.inf] * 3 + [-np.inf] * 3
    expected = by_a_loop(worlds.reshape(-1, 6), np.arange(21) * 50)
    assert_is(broadside.find_pairs_batch(worlds), expected)
    assert_is(broadside.find_pairs_batch(worlds[:, ::-1][:, ::-1]), expected)

    class ByDlpack:
        def __dlpack__(self, **options):
            return worlds.__dlpack__(**options)

        def __dlpack_device__(self):
            return worlds.__dlpack_device__()

    assert_is(broadside.find_pairs_batch(ByDlpack()), expected)
    sized = worlds.copy()
    sized[..., 3:] -= sized[..., :3]
    absent = slice(40, 50)
    sized[3, absent] = worlds[3, absent]
    keep = [i for i in range(20) if i != 3]  # absent boxes have no size
    assert broadside.find_pairs_batch(sized[keep], columns="xyzwhd").offsets[-1] > 0


def test_applies_filters_to_all_boxes_and_ignored_pairs_in_each_world():
    world = np.array([[0, 0, 1, 1], [1, 1, 2, 2], [0, 0, 2, 2]], np.float32)
    worlds = np.stack([world, world])
    static = broadside.filters(6, is_static=[False, False, False, True, True, False])
    found = broadside.find_pairs_batch(worlds, filters=static)
    assert found.offsets.tolist() == [0, 3, 5]
    found = broadside.find_pairs_batch(worlds, ignored=[(2, 0)])
    assert sorted(map(tuple, found.pairs[3 - 1 :].tolist())) == [(0, 1), (1, 2)]
    assert found.offsets.tolist() == [0, 2, 4]


def test_names_the_world_of_an_invalid_box():
    worlds = np.zeros((3, 4, 4), np.float32)
    worlds[2, 1, 0] = np.nan
    with pytest.raises(broadside.InvalidBoxError, match="box 9, which is box 1 of world 2, has min") as raised:
        broadside.find_pairs_batch(worlds)
    assert raised.value.row == 9
    assert broadside.find_pairs_batch(worlds, quarantine=True).offsets.tolist() == [0, 6, 12, 15]


@pytest.mark.parametrize(
    ("offsets", "message"),
    [
        ([], "0 offsets of worlds; expected one more"),
        ([1, 4], "the first offset of worlds is 1; expected 0"),
        ([0, 3, 2, 4], "offset 2 of worlds is 2, after 3; expected ascending"),
        ([0, 2, 5], "the last offset of worlds is 5; expected 4"),
        ([0, -1, 4], "offsets"),
        ([[0, 4]], r"offsets has shape \(1, 2\)"),
        (None, r"boxes has shape \(4, 4\) and no offsets are given"),
    ],
)
def test_refuses_offsets(offsets, message):
    boxes = np.zeros((4, 4), np.float32)
    with pytest.raises(ValueError, match=message):
        broadside.find_pairs_batch(boxes, offsets)

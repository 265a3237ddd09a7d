"""pairs() and count(): the law, against NumPy's brute force and on scenes of the lab."""

import numpy as np
import pytest
from conftest import as_set, box_arrays, brute_force, scattered
from hypothesis import given
from hypothesis import strategies as st

import broadside
from broadside import _core

SPECS = [algorithm.name for algorithm in broadside.algorithms()]
IN_3D = {algorithm.name for algorithm in broadside.algorithms() if 3 in algorithm.dimensions}
SCENES = [(name, d) for name, in_2d, in_3d in _core.scenes() for d, there in ((2, in_2d), (3, in_3d)) if there]


@pytest.mark.parametrize("spec", SPECS)
@given(data=st.data())
def test_finds_the_pairs_of_brute_force(spec, data):
    boxes = data.draw(box_arrays(dimension=None if spec in IN_3D else 2))
    assert as_set(broadside.pairs(boxes, algorithm=spec)) == brute_force(boxes)


@given(data=st.data())
def test_finds_the_pairs_of_two_sets(data):
    dimension = data.draw(st.sampled_from([2, 3]))
    left = data.draw(box_arrays(dimension=dimension))
    right = data.draw(box_arrays(dimension=dimension))
    assert as_set(broadside.pairs(left, right)) == brute_force(left, right)
    assert broadside.count(left, right) == len(brute_force(left, right))


def small_scenes():
    """Some that make boxes as asked for; recordings and maps have their own."""
    chosen = []
    for name, dimension in SCENES:
        try:
            boxes = _core.scene(name, 300, dimension, 1)
        except Exception:
            continue  # its data is not there
        if 2 <= len(boxes) <= 3000:
            chosen.append(pytest.param(boxes, id=f"{name}-{dimension}d"))
    return chosen


@pytest.mark.parametrize("boxes", small_scenes())
def test_holds_the_law_on_scenes(boxes):
    expected = brute_force(boxes)
    assert len(expected) == broadside.count(boxes)
    wide = boxes.astype(np.float64)
    for spec in SPECS if boxes.shape[1] == 4 else IN_3D:
        assert as_set(broadside.pairs(boxes, algorithm=spec)) == expected, spec
        assert as_set(broadside.pairs(wide, algorithm=spec)) == expected, spec


def test_there_are_scenes():
    assert len(small_scenes()) >= 10


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("spec", [a.name for a in broadside.algorithms() if a.kind == "own" and a.name != "brute_force"])
def test_gives_the_same_array_for_any_number_of_threads(spec, dtype, dimension):
    boxes = scattered(60_000, dimension, dtype)
    one = broadside.pairs(boxes, algorithm=spec, threads=1)
    assert len(one) > 10_000
    for threads in (None, 2, 5):
        np.testing.assert_array_equal(one, broadside.pairs(boxes, algorithm=spec, threads=threads))


def test_is_exact_in_float64():
    step = 2.0**-52
    boxes = np.array([[0, 0, 1, 1], [1 + step, 0, 2, 1], [1, 0, 2, 1]])
    assert as_set(broadside.pairs(boxes)) == {(0, 2), (1, 2)}


def test_widens_floats_beside_doubles():
    floats = np.array([[0, 0, 0.1, 1]], np.float32)
    doubles = np.array([[np.float64(np.float32(0.1)), 0, 1, 1], [0.1 + 1e-8, 0, 1, 1]])
    assert as_set(broadside.pairs(floats, doubles)) == brute_force(floats.astype(float), doubles) == {(0, 0)}
    assert as_set(broadside.pairs(doubles, floats)) == {(0, 0)}


def test_gives_rows_of_uint32_that_own_their_memory():
    found = broadside.pairs(scattered(1000))
    assert found.dtype == np.uint32 and found.shape == (len(found), 2) and found.flags.c_contiguous
    assert not isinstance(found.base, np.ndarray) and found.flags.writeable
    assert broadside.pairs(np.empty((0, 4))).shape == (0, 2)


def test_sorts_when_asked():
    boxes = scattered(5000)
    found = broadside.pairs(boxes, sort=True)
    order = np.lexsort((found[:, 1], found[:, 0]))
    np.testing.assert_array_equal(order, np.arange(len(found)))
    assert as_set(found) == as_set(broadside.pairs(boxes))


def test_gives_a_sparse_matrix():
    a, b = scattered(300), scattered(200, seed=2)
    upper = broadside.pairs(a, output="sparse")
    assert upper.shape == (300, 300) and upper.dtype == bool
    assert set(zip(*map(list, upper.nonzero()))) == brute_force(a)
    assert set(zip(*map(list, broadside.pairs(a, b, output="sparse").nonzero()))) == brute_force(a, b)
    assert broadside.pairs(a, b, output="sparse").shape == (300, 200)


def test_filters_pairs():
    boxes = np.tile(np.array([[0.0, 0, 1, 1]]), (5, 1))
    kinds = broadside.filters(5, category=[1, 2, 1, 1, 1], mask=[1, 2, 1, 1, 1])
    assert as_set(broadside.pairs(boxes, filters=kinds)) == {(0, 2), (0, 3), (0, 4), (2, 3), (2, 4), (3, 4)}
    kinds = broadside.filters(5, group=[-1, -1, 0, 0, 0], is_static=[False, False, True, True, False])
    assert (0, 1) not in as_set(broadside.pairs(boxes, filters=kinds))
    assert (2, 3) not in as_set(broadside.pairs(boxes, filters=kinds))
    assert broadside.count(boxes, filters=kinds) == 8
    assert as_set(broadside.pairs(boxes, ignored=[[1, 0], [3, 4]])) == brute_force(boxes) - {(0, 1), (3, 4)}
    left, right = broadside.filters(5, category=1, mask=2), broadside.filters(5, category=[2, 1, 1, 1, 1])
    assert as_set(broadside.pairs(boxes, boxes, filters=left, other_filters=right)) == {(i, 0) for i in range(5)}


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_leaves_out_boxes_that_only_touch(dtype):
    tiles = np.array([[0, 0, 1, 1], [1, 0, 2, 1], [1, 0.5, 1, 0.5], [0.5, 0, 1.5, 1]], dtype)
    assert broadside.count(tiles) == 6
    expected = {(0, 3), (1, 2), (1, 3), (2, 3)}
    assert as_set(broadside.pairs(tiles, touching=False)) == expected
    assert broadside.count(tiles, tiles, touching=False) == 2 * len(expected) + len(tiles)
    tracker = broadside.Tracker(2, dtype=dtype, touching=False)
    begun, _ = tracker.update(tiles)
    assert as_set(begun) == expected
    world = broadside.World(2, dtype=dtype, touching=False)
    world.add(tiles)
    assert len(world.update().begun) == len(expected)
    queries, _ = world.overlapping(tiles[:2])
    assert queries.tolist().count(0) == 2 and queries.tolist().count(1) == 3
    batch = broadside.find_pairs_batch(tiles, [0, 4], touching=False)
    assert as_set(batch.pairs) == expected
    assert broadside.components(tiles[:2], touching=False).tolist() == [0, 1]


def test_quarantines_invalid_boxes():
    boxes = scattered(100, dtype=np.float64)
    boxes[7, 0] = np.nan
    boxes[9] = [1, 1, 0, 0]
    boxes[11] = [np.inf, np.inf, -np.inf, -np.inf]
    np.testing.assert_array_equal(broadside.invalid_rows(boxes), [7, 9])
    assert as_set(broadside.pairs(boxes, quarantine=True)) == brute_force(boxes)
    assert broadside.count(boxes, boxes, quarantine=True) == len(brute_force(boxes, boxes))


def test_takes_specs_and_names_former_algorithms():
    boxes = scattered(2000)
    expected = as_set(broadside.pairs(boxes))
    for spec in ("grid:cell=0.1", "bvh:threads=2", "hierarchical_grid", "quadtree:capacity=8"):
        assert as_set(broadside.pairs(boxes, algorithm=spec)) == expected


def test_says_first_that_touching_counts():
    assert "touch overlap" in broadside.pairs.__doc__.splitlines()[0]

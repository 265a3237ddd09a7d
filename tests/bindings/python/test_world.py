"""World and Tracker against models."""

import copy
import pickle
import threading

import numpy as np
import pytest
from conftest import as_set, box_arrays, brute_force, scattered
from hypothesis import given, settings
from hypothesis import strategies as st

import broadside


def pairs_of(boxes, handles):
    """The pairs of handles, ordered as a world orders them: by slots."""
    order = np.argsort(handles & np.uint64(0xFFFFFFFF))
    return {(int(handles[order][a]), int(handles[order][b])) for a, b in brute_force(np.asarray(boxes)[order])}


@settings(max_examples=60)
@given(data=st.data())
def test_tells_what_began_and_ended_in_any_history(data):
    dimension = data.draw(st.sampled_from([2, 3]))
    dtype = data.draw(st.sampled_from([np.float32, np.float64]))
    world = broadside.World(dimension, dtype=dtype, margin=data.draw(st.sampled_from([0.0, 0.5])))
    model = {}
    held = set()
    for _ in range(4):
        boxes = data.draw(box_arrays(dimension=dimension, dtype=dtype, most=8))
        boxes = boxes[(boxes[:, 0] <= boxes[:, dimension])]  # a world takes no absent ones
        handles = world.add(boxes)
        model.update(zip(handles.tolist(), boxes))
        if model and data.draw(st.booleans()):
            moved = data.draw(st.lists(st.sampled_from(sorted(model)), unique=True, max_size=5))
            places = [[i % 3 - 1.0] * dimension + [i % 3 - 0.5] * dimension for i in range(len(moved))]
            world.move(np.array(moved, np.uint64), np.array(places, dtype).reshape(-1, 2 * dimension))
            model.update(zip(moved, np.array(places, dtype)))
        if model and data.draw(st.booleans()):
            gone = data.draw(st.lists(st.sampled_from(sorted(model)), unique=True, max_size=3))
            world.remove(np.array(gone, np.uint64))
            for handle in gone:
                del model[handle]
        if data.draw(st.booleans()):
            world = pickle.loads(pickle.dumps(world))
        begun, ended = world.update()
        now = np.array(list(model), np.uint64)
        expected = pairs_of(np.array([*model.values()], dtype).reshape(-1, 2 * dimension), now)
        assert as_set(begun) == expected - held
        assert {tuple(p) for p in ended.tolist()} == held - expected
        assert as_set(world.pairs()) == expected
        assert len(world) == len(model) and all(handle in world for handle in model)
        assert set(world.handles().tolist()) == set(model)
        np.testing.assert_array_equal(
            world.boxes(now), np.array([*model.values()], dtype).reshape(-1, 2 * dimension)
        )
        held = expected


def test_gives_named_arrays_of_uint64():
    world = broadside.World(2)
    handles = world.add([[0, 0, 1, 1], [1, 1, 2, 2]])
    assert handles.dtype == np.uint64
    events = world.update()
    assert events.begun.tolist() == [handles.tolist()]
    assert events.begun.dtype == np.uint64 and events.ended.shape == (0, 2)


def test_refuses_stale_and_foreign_handles():
    world, other = broadside.World(2), broadside.World(2)
    a, b = world.add([[0, 0, 1, 1], [0, 0, 1, 1]])
    _, foreign = other.add([[0, 0, 1, 1], [0, 0, 1, 1]])  # in the slot of b
    world.remove(a)
    for wrong in (a, foreign, np.uint64(0), np.uint64(2**64 - 1)):
        assert wrong not in world
        for call in (
            lambda: world.move([b, wrong], [[5, 5, 6, 6], [5, 5, 6, 6]]),
            lambda: world.remove([b, wrong]),
            lambda: world.set_filters([b, wrong], broadside.filters(2, mask=0)),
            lambda: world.ignore([[b, b ^ b], [b, wrong]]),
        ):
            with pytest.raises(broadside.InvalidHandleError):
                call()
    np.testing.assert_array_equal(world.boxes([b]), [[0, 0, 1, 1]])  # all or nothing
    assert len(world) == 1
    assert -1 not in world and 2**64 not in world
    with pytest.raises(TypeError):
        "a" in world
    with pytest.raises(broadside.InvalidHandleError):
        world.remove([b, b])
    for wrong, error in ((-1, ValueError), (0.5, TypeError), ("a", TypeError), ([[b]], ValueError)):
        with pytest.raises(error):
            world.remove(wrong)
    with pytest.raises(ValueError, match="differ|lengths|1 .*2|2 .*1"):
        world.move([b], [[0, 0, 1, 1], [0, 0, 1, 1]])


def test_takes_handles_beyond_half_of_all_in_a_list():
    world = broadside.World(2, first_generation=2**31)
    a, b = world.add([[0, 0, 1, 1], [0, 0, 1, 1]]).tolist()
    assert a >= 2**63
    for wrong in ([a, 1], [[a, 1]]):
        with pytest.raises(broadside.InvalidHandleError):
            world.remove(wrong) if wrong[0] == a else world.ignore(wrong)
    for wrong, error in (([a, 2**64], ValueError), ([a, 0.5], TypeError), (None, TypeError)):
        with pytest.raises(error):
            world.remove(wrong)
    with pytest.raises(TypeError, match="filters is None"):
        world.set_filters([a], None)
    world.ignore([[a, b]])
    world.remove([a, b])


def test_keeps_float32_exact():
    world = broadside.World(2, dtype=np.float32)
    world.add(scattered(5, dtype=np.float64).astype(np.float32).astype(np.float64))
    with pytest.raises(ValueError, match=r"row 1, .* is not exact in float32"):
        world.add([[0, 0, 1, 1], [0.1, 0, 1, 1]])
    assert len(world) == 5 and world.boxes().dtype == np.float32


def test_holds_no_more_than_max_boxes():
    world = broadside.World(2, max_boxes=1)
    with pytest.raises(ValueError, match="2 boxes"):
        world.add([[0, 0, 1, 1], [2, 2, 3, 3]])
    assert len(world) == 0


def test_refuses_options_that_do_not_exist():
    for arguments, error in [
        ({"dimension": 4}, ValueError),
        ({"dimension": 2, "dtype": np.int32}, ValueError),
        ({"dimension": 2, "algorithm": "grd"}, broadside.InvalidAlgorithmError),
        ({"dimension": 2, "margin": -1}, ValueError),
        ({"dimension": 2, "margin": float("nan")}, ValueError),
        ({"dimension": 2, "events": "all"}, ValueError),
        ({"dimension": 2, "first_generation": 2**32}, ValueError),
        ({"dimension": 2, "threads": 0}, ValueError),
        ({"dimension": 2.0}, TypeError),
        ({"dimension": 2, "margin": None}, TypeError),
        ({"dimension": 2, "shadow": "no"}, TypeError),
        ({"dimension": 2, "algorithm": None}, TypeError),
        ({"dimension": 2, "first_generation": 1.5}, TypeError),
    ]:
        with pytest.raises(error):
            broadside.World(**arguments)


def test_has_filters_ignored_pairs_and_quarantine():
    world = broadside.World(2, quarantine=True)
    boxes = [[0, 0, 1, 1]] * 4
    kinds = broadside.filters(4, is_static=[True, True, False, False])
    a, b, c, d = handles = world.add(boxes, filters=kinds)
    world.ignore([[d, c]])
    assert as_set(world.update().begun) == {(a, c), (a, d), (b, c), (b, d)}
    world.unignore([[c, d]])
    world.set_filters([a], broadside.filters(1))
    assert as_set(world.update().begun) == {(a, b), (c, d)}
    world.move([a], [[np.nan, 0, 1, 1]])
    assert len(world.update().ended) == 3
    assert world.quarantined().tolist() == [a]
    with pytest.raises(ValueError, match="slot 1 twice"):
        world.ignore([[b, b]])
    assert handles.shape == (4,)


def test_moves_within_a_margin_and_with_velocities():
    world = broadside.World(2, margin=1.0, predicted_frames=2, events="enlarged")
    a, b = world.add([[0, 0, 1, 1], [3, 0, 4, 1]])
    assert as_set(world.update().begun) == {(a, b)}
    world.move([a], [[0, 0, 1, 1]], velocities=[[5, 0]])
    world.update()
    assert world.boxes([a], enlarged=True)[0, 2] >= 2
    with pytest.raises(ValueError, match="0 velocities"):
        world.move([a], [[0, 0, 1, 1]], velocities=np.empty((0, 2)))
    with pytest.raises(broadside.InvalidBoxError) as caught:
        world.move([a, b], [[0, 0, 1, 1]] * 2, velocities=[[0, 0], [np.inf, 0]])
    assert (caught.value.argument, caught.value.row) == ("velocities", 1)
    with pytest.raises(broadside.InvalidBoxError) as caught:
        world.move([a], [[np.nan, 0, 1, 1]], velocities=[[0, 0]])
    assert caught.value.argument == "boxes"
    with pytest.raises(ValueError, match="velocities are given to a world of predicted_frames=0"):
        broadside.World(2).move([], [], velocities=[])


def test_joins_two_worlds():
    a, b = broadside.World(3), broadside.World(3)
    left, right = scattered(60, 3, np.float64), scattered(70, 3, np.float64, seed=2, size=4)
    x, y = a.add(left), b.add(right)
    assert as_set(a.join(b)) == {(int(x[i]), int(y[j])) for i, j in brute_force(left, right)}
    assert len(a.join(a)) == len(brute_force(left, left))
    with pytest.raises(TypeError, match="other is a world of 2D doubles; expected 3D doubles"):
        a.join(broadside.World(2))
    with pytest.raises(TypeError, match="other is an int; expected a World"):
        a.join(3)


def test_goes_back_in_time():
    world = broadside.World(2)
    handles = world.add(scattered(50, dtype=np.float64))
    world.update()
    past, before = world.snapshot(), world.pairs()
    world.remove(handles[:10])
    world.move(handles[10:], scattered(40, dtype=np.float64, seed=3))
    world.update()
    world.restore(past)
    np.testing.assert_array_equal(world.pairs(), before)
    for made in (copy.copy(world), copy.deepcopy(world), pickle.loads(pickle.dumps(world))):
        np.testing.assert_array_equal(made.pairs(), before)
        np.testing.assert_array_equal(made.boxes(handles), world.boxes(handles))
        made.remove(handles[:1])
        assert handles[0] in world
    for bytes in (b"", past[:-1], past[:50] + b"x" + past[51:], broadside.World(3).snapshot()):
        with pytest.raises(broadside.InvalidSnapshotError):
            world.restore(bytes)
    with pytest.raises(TypeError):
        world.restore("a")
    world.restore(bytearray(past))
    world.restore(memoryview(past))
    np.testing.assert_array_equal(world.pairs(), before)


def test_threads_take_turns():
    world = broadside.World(2)
    world.add(scattered(2000, dtype=np.float64))
    failed = []

    def work(seed):
        try:
            for step in range(10):
                handles = world.add(scattered(20, dtype=np.float64, seed=seed * 100 + step))
                world.update()
                world.overlapping(scattered(20, dtype=np.float64, seed=step))
                world.remove(handles)
        except Exception as error:
            failed.append(error)

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed
    world.update()
    assert len(world) == 2000
    assert as_set(world.pairs()) == pairs_of(world.boxes(), world.handles())


@settings(max_examples=60)
@given(data=st.data())
def test_a_tracker_tells_what_began_and_ended(data):
    dimension = data.draw(st.sampled_from([2, 3]))
    dtype = data.draw(st.sampled_from([np.float32, np.float64]))
    spec = data.draw(st.sampled_from(["auto", "brute_force", "grid", "bvh", "sweep_and_prune", "quadtree"]))
    tracker = broadside.Tracker(dimension, dtype=dtype, algorithm=spec)
    held = set()
    for _ in range(4):
        boxes = data.draw(box_arrays(dimension=dimension, dtype=dtype, most=15))
        begun, ended = tracker.update(boxes)
        now = brute_force(boxes)
        assert as_set(begun) == now - held and as_set(ended) == held - now
        held = now


def test_a_tracker_looks_at_what_is_listed():
    tracker = broadside.Tracker(2)
    boxes = scattered(100, dtype=np.float64)
    tracker.update(boxes)
    moved = boxes.copy()
    moved[5] = [9, 9, 10, 10]
    moved[6] = [9, 9, 10, 10]
    assert (5, 6) not in as_set(tracker.update(moved, changed=[5]).begun)
    assert (5, 6) in as_set(tracker.update(moved, changed=np.array([6])).begun)
    with pytest.raises(ValueError):
        tracker.update(moved, changed=[100])
    moved[7, 0] = np.nan
    with pytest.raises(broadside.InvalidBoxError, match="7"):
        tracker.update(moved)
    with pytest.raises(ValueError, match=r"expected \(n, 4\)"):
        tracker.update(np.zeros((3, 6)))


def test_names_the_handle_of_another_world():
    worlds = [broadside.World(2) for _ in range(8)]
    handles = [world.add(scattered(5)) for world in worlds]
    for i, world in enumerate(worlds):
        for j in range(8):
            if i != j:
                with pytest.raises(broadside.InvalidHandleError, match="never issued by this world: it belongs to another world"):
                    world.remove(handles[j])
        world.remove(handles[i][2:])
        with pytest.raises(broadside.InvalidHandleError, match="names a box that was removed"):
            world.remove(handles[i][3:4])

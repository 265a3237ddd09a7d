"""intervals(), tables of them, and OwnerPairs: against their definitions."""

import numpy as np
import pandas
import pytest
from conftest import as_set

import broadside

RNG = np.random.default_rng(5)
STARTS = 3_000_000_000 + RNG.integers(0, 20_000, 500)
ENDS = STARTS + RNG.choice([0, 1, 40, 300], 500)
ROWS = broadside.intervals(STARTS, ENDS)


def by_definition(touching=True):
    last = np.where(touching | (STARTS == ENDS), ENDS, ENDS - 0.5)
    overlap = (STARTS[:, None] <= last) & (STARTS <= last[:, None])
    return {(a, b) for a, b in np.argwhere(overlap).tolist() if a < b}


@pytest.mark.parametrize("touching", [True, False])
@pytest.mark.parametrize("algorithm", ["auto", "grid", "bvh", "sweep_and_prune"])
def test_pairs_of_intervals_are_those_of_the_definition(touching, algorithm):
    expected = by_definition(touching)
    assert as_set(broadside.pairs(ROWS, algorithm=algorithm, touching=touching)) == expected
    found = broadside.pairs(ROWS[:200], ROWS[200:], algorithm=algorithm, touching=touching)
    assert as_set(found) == {(a, b - 200) for a, b in expected if a < 200 <= b}
    keys = np.arange(500) % 3
    found = broadside.pairs(ROWS, algorithm=algorithm, touching=touching, same=keys)
    assert as_set(found) == {(a, b) for a, b in expected if keys[a] == keys[b]}


def test_tables_may_have_the_columns_of_intervals():
    expected = by_definition()
    for names in (["start", "end"], ["Start", "End"], ["chromStart", "chromEnd"]):
        table = pandas.DataFrame({"chrom": "chr1", names[0]: STARTS, names[1]: ENDS})
        assert as_set(broadside.pairs(table)) == expected
        assert as_set(broadside.pairs(table, same=table["chrom"], touching=False)) == by_definition(touching=False)
    table = pandas.DataFrame({"to": ENDS, "from": STARTS})
    with pytest.raises(ValueError, match=r"the columns of boxes are from, to: .*for intervals use intervals\(\)"):
        broadside.pairs(table, columns=["from", "to"])
    assert as_set(broadside.pairs(broadside.intervals(table["from"], table["to"]))) == expected
    assert as_set(broadside.pairs(np.column_stack([STARTS, ENDS]), columns="start,end")) == expected
    missing = pandas.DataFrame({"start": [1.0, np.nan], "end": [2.0, np.nan]})
    assert broadside.pairs(missing).tolist() == []


def test_intervals_move_and_are_found():
    world = broadside.World(2)
    handles = world.add(ROWS)
    assert len(world.update().begun) == len(by_definition())
    world.remove(handles[1:])
    world.update()
    index = broadside.Index(ROWS)
    found = index.overlapping(broadside.intervals([STARTS[0]], [STARTS[0]]))
    assert 0 in np.column_stack(found)[:, 1]


def test_an_absent_interval_pairs_with_nothing():
    assert broadside.count(broadside.intervals([0, np.inf, 0], [1, -np.inf, 1])) == 1


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (([1, 2], [3]), ValueError, r"ends has shape \(1,\); expected \(n,\), an end for each start"),
        (([[1, 2]], [[3, 4]]), ValueError, r"starts has shape \(1, 2\)"),
        ((["a"], ["b"]), TypeError, "starts has dtype"),
        (([2**53 + 1], [2**60]), ValueError, "starts is 9007199254740993 in row 0, which float64 does not hold"),
    ],
)
def test_refuses_what_is_no_intervals(arguments, error, message):
    with pytest.raises(error, match=message):
        broadside.intervals(*arguments)


def test_names_intervals_where_rows_have_two_numbers():
    with pytest.raises(ValueError, match=r"for points say within=, or use nearest_pairs\(\); for intervals use intervals\(\)"):
        broadside.pairs(np.zeros((3, 2)))
    with pytest.raises(broadside.InvalidBoxError):
        broadside.pairs(broadside.intervals([1], [0]))


def test_owners_touch_while_boxes_of_theirs_do():
    owners = RNG.integers(0, 12, 100)
    tracker, bodies, held = broadside.Tracker(2), broadside.OwnerPairs(), set()
    for _ in range(15):
        corner = RNG.integers(0, 40, (100, 2)).astype(float)
        boxes = np.concatenate([corner, corner + 2], axis=1)
        boxes[RNG.random(100) < 0.2] = (np.inf, np.inf, -np.inf, -np.inf)
        events = tracker.update(boxes)
        of_owners = bodies.update(owners[events.begun], owners[events.ended])
        begun, ended = as_set(of_owners.begun), as_set(of_owners.ended)
        assert not begun & held and ended <= held
        held = (held | begun) - ended
        pairs = broadside.pairs(boxes, different=owners)
        assert held == {tuple(sorted(pair)) for pair in owners[pairs].tolist()}
        assert bodies.pairs().tolist() == sorted(map(list, held)) and len(bodies) == len(held)
        assert broadside.OwnerPairs().update(owners[pairs]).begun.tolist() == bodies.pairs().tolist()


def test_a_pair_that_never_began_is_refused_and_changes_nothing():
    bodies = broadside.OwnerPairs()
    bodies.update([[7, 9], [9, 7]])
    with pytest.raises(ValueError, match="ended has pairs of the owners 4 and 7, 1 more than began"):
        bodies.update([[1, 2]], [[7, 4]])
    assert bodies.pairs().tolist() == [[7, 9]]
    assert bodies.update([], [[7, 9]]).ended.tolist() == []
    assert bodies.update([], [[7, 9]]).ended.tolist() == [[7, 9]]
    with pytest.raises(ValueError, match=r"begun has shape \(3,\)"):
        bodies.update([1, 2, 3])

"""What Python does with any object: pickle it, copy it, inherit from its class, refer to it weakly."""

import copy
import gc
import pickle
import weakref

import numpy as np
import pytest
from conftest import scattered

import broadside

BOXES = scattered(20)


class Named(broadside.Index):
    """With attributes, and with arguments of its own."""

    def __init__(self, name, boxes):
        super().__init__(boxes)
        self.name = name


class Slotted(Named):
    __slots__ = ("__hidden", "shown", "unset")

    def __init__(self, name, boxes):
        super().__init__(name, boxes)
        self.shown, self.__hidden = 1, 2

    def both(self):
        return self.shown, self.__hidden


class Scene(broadside.World):
    def __init__(self, name):
        super().__init__(2, dtype=np.float32)
        self.name = name


class Part(broadside.Partition):
    name = "none"


def scene():
    made = Scene("a")
    made.add(BOXES)
    return made


def part():
    made = Part(BOXES, 3)
    made.name = "a"
    return made


@pytest.mark.parametrize("remake", [lambda found: pickle.loads(pickle.dumps(found)), copy.copy, copy.deepcopy])
def test_a_subclass_survives_pickle_and_copy(remake):
    for made in (Named("a", BOXES), Slotted("a", BOXES), scene(), part()):
        again = remake(made)
        assert type(again) is type(made) and again is not made and again.name == "a"
        assert (len(again), again.dtype) == (len(made), made.dtype)
        again.name = "b"
        assert made.name == "a"
    assert remake(Slotted("a", BOXES)).both() == (1, 2)
    made = scene()
    again = remake(made)
    again.remove(again.handles()[:1])
    assert len(made) == 20 and len(again) == 19


def test_a_tracker_is_not_copied():
    class Own(broadside.Tracker):
        pass

    for tracker in (broadside.Tracker(2), Own(2)):
        for remake in (pickle.dumps, copy.copy, copy.deepcopy):
            with pytest.raises(TypeError, match="a Tracker cannot be pickled or copied; expected a World"):
                remake(tracker)


def test_takes_weak_references():
    for make in (
        lambda: broadside.Index(BOXES),
        lambda: broadside.World(2),
        lambda: broadside.Tracker(2),
        lambda: broadside.Partition(BOXES, 2),
        lambda: broadside.draw(BOXES),
        lambda: broadside.pairs(BOXES, output="arrow"),
    ):
        made = make()
        reference = weakref.ref(made)
        assert reference() is made
        del made
        gc.collect()
        assert reference() is None

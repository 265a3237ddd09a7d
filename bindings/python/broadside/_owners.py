"""OwnerPairs: from the pairs of boxes to the pairs of their owners."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from broadside import _convert
from broadside._motion import Events

_MOST = 2**64 - 1


class OwnerPairs:
    """Tells which owners touch, such as bodies made of several boxes, from the pairs of boxes that begin and end.

    Two owners touch while at least one box of each touches a box of the other. Boxes of one owner never count as a
    pair; ``different=owners`` also keeps a search from finding them. An owner is an integer from 0 to 2**64 - 1. When a
    box is removed, its `Tracker` or `World` reports that its pairs end; the box's owner must be the same as when they
    began.

    If the array ``owners`` has the owner of each box::

        events = tracker.update(boxes)
        of_cars = cars.update(owners[events.begun], owners[events.ended])
        of_one_search = OwnerPairs().update(owners[broadside.pairs(boxes)]).begun
    """

    def __init__(self) -> None:
        self._pairs = np.empty((0, 2), np.uint64)
        self._counts = np.empty(0, np.int64)

    def update(self, begun: Any, ended: Any = ()) -> Events:
        """Takes the owners of the boxes of the pairs that began and ended since the last update, in any order.

        Args:
            begun: Integers of shape (k, 2).
            ended: Likewise.

        Returns:
            Events: the pairs of owners that began and ended, uint64, each once and sorted, the smaller owner first.

        Raises:
            TypeError, ValueError: An argument has other elements or another shape, or a pair of owners would end more
                often than it began. Nothing has changed then.
        """
        changes = [_rows(begun, "begun"), _rows(ended, "ended")]
        by = [self._counts, np.ones(len(changes[0]), np.int64), -np.ones(len(changes[1]), np.int64)]
        pairs, places = np.unique(np.concatenate([self._pairs, *changes]), axis=0, return_inverse=True)
        places = places.ravel()
        counts = np.zeros(len(pairs), np.int64)
        np.add.at(counts, places, np.concatenate(by))
        if (counts < 0).any():
            first, second = pairs[np.argmin(counts)].tolist()
            raise ValueError(
                f"ended has pairs of the owners {first} and {second}, {-counts.min()} more than began; expected pairs that began"
            )
        held = np.zeros(len(pairs), np.bool_)
        held[places[: len(self._pairs)]] = True
        self._pairs, self._counts = pairs[counts > 0], counts[counts > 0]
        return Events(pairs[~held & (counts > 0)], pairs[held & (counts == 0)])

    def pairs(self) -> NDArray[np.uint64]:
        """The pairs of owners that touch now, of shape (n, 2) and sorted."""
        return self._pairs.copy()

    def __len__(self) -> int:
        """How many pairs of owners touch now."""
        return len(self._pairs)


def _rows(found: Any, name: str) -> NDArray[np.uint64]:
    rows: NDArray[np.uint64] = np.sort(_convert.pairs_of_integers(found, name, _MOST), axis=1)
    different: NDArray[np.uint64] = rows[rows[:, 0] != rows[:, 1]]
    return different

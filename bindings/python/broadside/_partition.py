"""Space cut into parts that are joined apart from each other."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from broadside import _arguments, _convert, _core, _pickling
from broadside._columns import Columns


class Assignment(NamedTuple):
    """Which boxes touch which part: those of part `p` are ``row[start[p] : start[p + 1]]``."""

    start: NDArray[np.int64]
    """One more than there are parts."""
    row: NDArray[np.uint32]
    """The rows of the boxes, of each part ascending."""


class Partition:
    """Space, cut into parts that can be joined independently, on one machine or on many.

    Every point lies in exactly one part. `assign` gives each part the boxes that touch it, and a box on a cut goes to
    several parts. `pairs` finds the pairs that belong to a part. A pair belongs to the part that holds the greater of
    its two minima on every axis, so the parts' pairs are disjoint, and together they are all pairs. A part can be
    joined again without the others. `broadside.dask.pairs` does this on a cluster.

    Args:
        sample: Some of the boxes, whatever `pairs` takes; some ten thousand are enough. The partition has their
            dimension and dtype.
        parts: The number of parts, which have about equal cost. There are fewer if no cut separates the boxes, as when
            all are at one place.
        boxes: The number of boxes that the sample stands for, so that costs include their pairs; 0: costs are of boxes
            alone.
        columns: The names of a table's columns of bounds, or a layout such as "xywh": see `pairs`.

    Raises:
        InvalidBoxError: A box of the sample has a NaN or a minimum greater than its maximum.
        TypeError, ValueError: As `pairs` does, and if `parts` is less than 1 or beyond 2**31 - 2.

    Cost: O(s log s) for each doubling of the parts, with a sample of s boxes. A partition never changes, so several
    threads can use it at once. It can be pickled, in some 20 bytes for each cut.
    """

    __slots__ = ("__weakref__", "_partition")

    @_arguments.suggests
    def __init__(self, sample: Any, parts: int, *, boxes: int = 0, columns: Columns | None = None) -> None:
        parts = _arguments.integer(parts, "parts", 1, 2**31 - 2)
        sample = _convert.given(sample, "sample", columns)
        self._partition = _core.make_partition(sample, parts, _arguments.integer(boxes, "boxes", 0, 2**63 - 1))

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._partition.dimension()

    @property
    def dtype(self) -> np.dtype[Any]:
        """float32 or float64."""
        return np.dtype(np.float64 if self._partition.has_doubles() else np.float32)

    @property
    def regions(self) -> NDArray[Any]:
        """The bounds of each part as a box, infinite where nothing was cut. A part includes its minima but not its
        maxima."""
        found: NDArray[Any] = self._partition.regions()
        return found

    def __len__(self) -> int:
        return len(self._partition)

    def __repr__(self) -> str:
        return f"<broadside.Partition: {len(self)} parts in {self.dimension}D, {self.dtype}>"

    def assign(self, boxes: Any, *, quarantine: bool = False, columns: Columns | None = None) -> Assignment:
        """Which of these boxes touch which part; absent boxes touch none.

        Args:
            boxes: n boxes, whatever `pairs` takes, of the partition's dimension. A partition of float32 refuses float64
                boxes that are not exact in float32.
            quarantine: Leave invalid boxes out instead of raising.
            columns: The names of a table's columns of bounds, or a layout such as "xywh": see `pairs`.

        Raises:
            InvalidBoxError, TypeError, ValueError: As `pairs` does, and if another thread changes the boxes meanwhile.

        Cost: O(n log parts). The GIL is released.
        """
        leaves_out = _arguments.truth(quarantine, "quarantine")
        return Assignment(*self._partition.assign(_convert.given(boxes, "boxes", columns), leaves_out))

    def pairs(
        self,
        part: int,
        boxes: Any,
        other: Any = None,
        *,
        algorithm: str = "auto",
        sort: bool = False,
        threads: int | None = None,
    ) -> NDArray[np.uint32]:
        """The pairs of a part's boxes that belong to the part, as rows of these arrays.

        Args:
            part: Its number, from 0.
            boxes: The boxes that touch the part, as `assign` selects them, in any array.
            other: Those of a second set, if there is one.
            algorithm: A spec: see `algorithms`.
            sort: Sort the pairs.
            threads: The maximum number of threads; None: all cores.

        Returns:
            uint32 of shape (k, 2), as `pairs` returns.

        Raises:
            ValueError: A box does not touch the part; and whatever else `pairs` raises.
        """
        number = _arguments.integer(part, "part", 0, len(self) - 1)
        found: NDArray[np.uint32] = self._partition.pairs(number, boxes, other, algorithm, sort, threads)
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        links, places = self._partition.cuts()
        made_of = (self.dimension, self.dtype, links, places, type(self))
        return _of_cuts, made_of, _pickling.state_of(self, Partition)


def _of_cuts(
    dimension: int,
    dtype: DTypeLike,
    links: NDArray[np.uint32],
    places: NDArray[Any],
    kind: type[Partition] = Partition,
) -> Partition:
    made = kind.__new__(kind)
    made._partition = _core.partition_of_cuts(dimension, dtype == np.float64, links.reshape(-1), places)
    return made

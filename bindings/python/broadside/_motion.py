"""Boxes that move: World, under handles, Tracker, over an array, and BatchTracker, over the arrays of many worlds."""

from __future__ import annotations

import inspect
import itertools
import math
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from broadside import _arguments, _convert, _core, _pickling, _world_options
from broadside._columns import Columns
from broadside._errors import InvalidBoxError
from broadside._pairs import BatchPairs
from broadside._queries import (
    FirstHits,
    Found,
    Hits,
    Neighbours,
    _checked_dimension,
    _checked_k,
    _nearest,
    _has_doubles,
)

_worlds = itertools.count(1)


def _next_first_generation() -> int:
    """Far from those of the worlds before, so that worlds refuse each other's handles, and below a quarter of all."""
    return (next(_worlds) * 0x9E3779B1 & 0xFFFFFFFF) >> 2


class Events(NamedTuple):
    """The pairs that began and ended in an update, each of shape (k, 2) and sorted."""

    begun: NDArray[Any]
    """The pairs that hold now and did not before."""
    ended: NDArray[Any]
    """The pairs that held before and do not now."""


class World:
    """Boxes under handles that are added, moved and removed, and the pairs that begin and end.

    A handle is one uint64: the box's slot is its lower half, the slot's generation its upper half. It names one box for
    as long as that box is in the world, and never another one. A world refuses handles of removed boxes and, unless
    very many worlds were made, of other worlds. Changes to boxes affect pairs at the next `update`.

    Args:
        dimension: 2 or 3.
        dtype: The dtype of the boxes: float64 or float32. A world of float32 refuses float64 boxes that are not exact
            in float32.
        algorithm: A spec: see `algorithms`.
        threads: The maximum number of threads of an update; None: all cores, if there is enough to do.
        first_generation: The generation of the first handles; by default it differs from world to world.
        **options: {options}

    Calls from several threads take turns. `update`, queries and `join` release the GIL and end at Ctrl-C, but not while
    the first query after a change builds its index. You can repeat an update that Ctrl-C ended. A function that takes
    many boxes changes nothing if one of them is wrong. A world can be pickled and copied, with its handles. Its queries
    take `filters` and `exclude` as those of `Index` do; `exclude` takes handles.
    """

    __slots__ = ("__weakref__", "_crs", "_has_doubles", "_options", "_world")
    __signature__: ClassVar[inspect.Signature]

    @_arguments.suggests
    def __init__(
        self,
        dimension: int,
        *,
        dtype: DTypeLike = np.float64,
        algorithm: str = "auto",
        threads: int | None = None,
        first_generation: int | None = None,
        **options: Any,
    ) -> None:
        first = _next_first_generation() if first_generation is None else first_generation
        options["first_generation"] = _arguments.integer(first, "first_generation", 0, 2**32 - 1)
        self._has_doubles = _has_doubles(dtype)
        self._options: dict[str, Any] = {
            "dimension": _checked_dimension(dimension),
            "algorithm": _arguments.text(algorithm, "algorithm"),
            "threads": threads,
            **options,
        }
        self._crs: Any = None
        settings = _world_options.settings_of(options)
        self._world = _core.make_world(self._options["dimension"], self._has_doubles, algorithm, threads, settings)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        dimension: int = self._options["dimension"]
        return dimension

    @property
    def dtype(self) -> np.dtype[Any]:
        """float32 or float64."""
        return np.dtype(np.float64 if self._has_doubles else np.float32)

    def add(
        self, boxes: Any, *, filters: NDArray[np.void] | None = None, columns: Columns | None = None
    ) -> NDArray[np.uint64]:
        """Adds n boxes, whatever `pairs` takes with these `columns`, and returns their handles, shape (n,).

        Adds none and raises InvalidBoxError if a box is invalid or absent, or ValueError if there would be more than
        `max_boxes`.
        """
        crs = _convert.common_crs(self._crs, "the world", boxes, "boxes")
        try:
            handles = self._world.add(_convert.given(boxes, "boxes", columns), filters)
        except InvalidBoxError as error:
            raise _convert.explained(error, boxes, "boxes", columns) from None
        self._crs = crs
        return handles

    def move(
        self, handles: ArrayLike, boxes: Any, *, velocities: Any = None, columns: Columns | None = None
    ) -> None:
        """Replaces the boxes of `handles`, shape (n,), by `boxes`, whatever `pairs` takes with these `columns`.

        `velocities`, shape (n, dimension), says how far each box is expected to go in a frame, for `predicted_frames`.
        Raises InvalidHandleError, InvalidBoxError.
        """
        if velocities is not None and not self._options.get("predicted_frames"):
            raise ValueError(
                "velocities are given to a world of predicted_frames=0; expected more than 0, or no velocities"
            )
        _convert.common_crs(self._crs, "the world", boxes, "boxes")
        try:
            self._world.move(handles, _convert.given(boxes, "boxes", columns), velocities)
        except InvalidBoxError as error:
            raise _convert.explained(error, boxes, "boxes", columns) from None

    def remove(self, handles: ArrayLike) -> None:
        """Removes boxes; their pairs end at the next update. Raises InvalidHandleError."""
        self._world.remove(handles)

    def update(self) -> Events:
        """Brings the pairs up to date, and returns the pairs of handles, uint64, that began and ended since the last
        update."""
        return Events(*self._world.update())

    def pairs(self) -> NDArray[np.uint64]:
        """The current pairs of handles, as of the last update, shape (k, 2), sorted by slots."""
        return self._world.pairs()

    def boxes(self, handles: ArrayLike | None = None, *, enlarged: bool = False) -> NDArray[Any]:
        """The boxes of these handles, or of all (see `handles`), as they were last set; if `enlarged`, with their
        margins.

        A removed box can be read until the update after the one that reported that its pairs ended.
        """
        return self._world.boxes(self.handles() if handles is None else handles, _arguments.truth(enlarged, "enlarged"))

    def handles(self) -> NDArray[np.uint64]:
        """The handles of all boxes, by slot."""
        return self._world.handles()

    def quarantined(self) -> NDArray[np.uint64]:
        """The handles of the boxes that were invalid when they were last set, by slot."""
        return self._world.quarantined()

    def set_filters(self, handles: ArrayLike, filters: NDArray[np.void]) -> None:
        """Replaces boxes' filters, made by `broadside.filters`. Raises InvalidHandleError."""
        self._world.set_filters(handles, filters)

    def ignore(self, pairs: ArrayLike) -> None:
        """Ignores pairs of handles, shape (n, 2), such as bodies that a joint connects.

        A pair is ignored until one of its boxes is removed. Raises InvalidHandleError.
        """
        self._world.ignore(pairs, True)

    def unignore(self, pairs: ArrayLike) -> None:
        """Lets these pairs count again."""
        self._world.ignore(pairs, False)

    def join(self, other: World) -> NDArray[np.uint64]:
        """The pairs of a box of this world and an overlapping box of `other`, as they are now, shape (k, 2).

        Both worlds have the same dimension and dtype. A world joined with itself counts as two worlds.
        """
        if not isinstance(other, World):
            raise TypeError(f"other is {_arguments.kind_of(other)}; expected a World")
        return self._world.join(other._world)

    def overlapping(
        self, queries: Any, *, filters: NDArray[np.void] | None = None, exclude: ArrayLike | None = None
    ) -> Found:
        """The boxes that overlap each of `queries`, as they are now: see `Index.overlapping`."""
        _convert.common_crs(self._crs, "the world", queries, "queries")
        return Found(*self._world.overlapping(queries, filters, exclude))

    def containing(
        self, points: Any, *, filters: NDArray[np.void] | None = None, exclude: ArrayLike | None = None
    ) -> Found:
        """The boxes that contain each of `points`: see `Index.containing`."""
        return Found(*self._world.containing(points, filters, exclude))

    def hits(
        self,
        origins: Any,
        directions: Any,
        *,
        t_max: float = math.inf,
        entering: bool = False,
        filters: NDArray[np.void] | None = None,
        exclude: ArrayLike | None = None,
    ) -> Hits:
        """All boxes that each ray meets: see `Index.hits`."""
        limit = _arguments.number(t_max, "t_max")
        return Hits(*self._world.hits(origins, directions, limit, entering, filters, exclude))

    def first_hit(
        self,
        origins: Any,
        directions: Any,
        *,
        t_max: float = math.inf,
        entering: bool = False,
        filters: NDArray[np.void] | None = None,
        exclude: ArrayLike | None = None,
    ) -> FirstHits:
        """The box that each ray meets first: see `Index.first_hit`."""
        limit = _arguments.number(t_max, "t_max")
        return FirstHits(*self._world.first_hit(origins, directions, limit, entering, filters, exclude))

    def nearest(
        self,
        queries: Any,
        k: int = 1,
        *,
        max_distance: float = math.inf,
        threads: int | None = None,
        filters: NDArray[np.void] | None = None,
        exclude: ArrayLike | None = None,
    ) -> Neighbours:
        """The k boxes nearest to each of `queries`, points or boxes: see `Index.nearest`."""
        return _nearest(self, self._world, queries, _checked_k(k, len(self)), max_distance, threads, filters, exclude)

    def snapshot(self) -> bytes:
        """All that the world's future depends on, as bytes that are the same on every machine."""
        return self._world.snapshot()

    def restore(self, snapshot: bytes | bytearray | memoryview) -> None:
        """Puts the world into the state of a snapshot, taken of this world or of another one like it.

        Raises InvalidSnapshotError, and changes nothing, for other bytes.
        """
        self._world.restore(snapshot if isinstance(snapshot, bytes) else bytes(memoryview(snapshot)))

    @property
    def nbytes(self) -> int:
        """The bytes that the world holds."""
        return self._world.bytes()

    @property
    def explanation(self) -> str:
        """What ``"auto"`` chose for the last update, and why; empty for other algorithms."""
        return self._world.explanation()

    def __len__(self) -> int:
        """The number of boxes."""
        return len(self._world)

    def __contains__(self, handle: object) -> bool:
        """Whether a handle names a box of the world."""
        if not isinstance(handle, (int, np.integer)) or isinstance(handle, bool):
            raise TypeError(f"a handle is {_arguments.kind_of(handle)}; expected an integer")
        return 0 <= int(handle) < 2**64 and self._world.contains(int(handle))

    def __reduce__(self) -> tuple[Any, ...]:
        made_of = (self._options, self.dtype.str, self.snapshot(), type(self), self._crs)
        return _unpickled_world, made_of, _pickling.state_of(self, World)

    def __repr__(self) -> str:
        return f"broadside.World({len(self)} boxes, {self.dimension}D, {self.dtype})"


def _unpickled_world(
    options: dict[str, Any], dtype: str, snapshot: bytes, kind: type[World] = World, crs: Any = None
) -> World:
    world = kind.__new__(kind)
    World.__init__(world, dtype=dtype, **options)
    world._world.restore(snapshot)
    world._crs = crs
    return world


World.__doc__ = _world_options.filled(World.__doc__, own={"first_generation"})
World.__signature__ = _world_options.signature(World)


class _ArrayTracker:
    """What Tracker and BatchTracker have in common."""

    __slots__ = ("__weakref__", "_dimension", "_dtype", "_tracker")

    _dimension: int
    _dtype: np.dtype[Any]
    _tracker: Any

    def _set_kind(self, dimension: int, dtype: DTypeLike) -> tuple[int, bool]:
        """Keeps the kind of boxes, and returns it as the extension module takes it."""
        has_doubles = _has_doubles(dtype)
        self._dimension = _checked_dimension(dimension)
        self._dtype = np.dtype(np.float64 if has_doubles else np.float32)
        return self._dimension, has_doubles

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._dimension

    @property
    def dtype(self) -> np.dtype[Any]:
        """float32 or float64."""
        return self._dtype

    @property
    def nbytes(self) -> int:
        """The bytes that the tracker holds."""
        found: int = self._tracker.bytes()
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(f"a {self._name} cannot be pickled or copied; {self._instead}")

    def __repr__(self) -> str:
        return f"broadside.{self._name}({self._dimension}D, {self._dtype})"

    _name: ClassVar[str]
    _instead: ClassVar[str]


class Tracker(_ArrayTracker):
    """Follows an array of boxes from frame to frame, and tells which pairs of rows begin and end.

    Args:
        dimension: 2 or 3.
        dtype: float64 or float32, as in `World`.
        algorithm: A spec: see `algorithms`.
        threads: The maximum number of threads; None: all cores, if there is enough to do.
        quarantine: Treat invalid boxes as absent instead of raising.
        touching: Whether boxes that only touch overlap, as in `pairs`.

    Calls from several threads take turns. A tracker cannot be pickled or copied. It knows no periodic space: there,
    compare the `pairs` of two frames.
    """

    __slots__ = ()
    _name = "Tracker"
    _instead = "expected a World, which can, or a new Tracker"

    @_arguments.suggests
    def __init__(
        self,
        dimension: int,
        *,
        dtype: DTypeLike = np.float64,
        algorithm: str = "auto",
        threads: int | None = None,
        quarantine: bool = False,
        touching: bool = True,
    ) -> None:
        self._tracker = _core.make_tracker(
            *self._set_kind(dimension, dtype),
            _arguments.text(algorithm, "algorithm"),
            threads,
            _arguments.truth(quarantine, "quarantine"),
            _arguments.truth(touching, "touching"),
        )

    def update(
        self,
        boxes: Any,
        *,
        changed: ArrayLike | None = None,
        filters: NDArray[np.void] | None = None,
        columns: Columns | None = None,
    ) -> Events:
        """Takes the boxes of the next frame and returns the pairs of rows, uint32, that began and ended.

        Rows beyond those of the last frame are new boxes. A shorter array, or an absent box, removes boxes.

        Args:
            boxes: n boxes, whatever `pairs` takes.
            changed: The rows that may differ from the frame before; a change of another row is not seen. None: any row
                may differ.
            filters: A filter for each box, made by `broadside.filters`. A row whose filter changes must be in `changed`
                as well.
            columns: The names of a table's columns of bounds, or a layout such as "xywh": see `pairs`.

        Raises InvalidBoxError and ValueError. The tracker has not changed then, nor after Ctrl-C: the next update
        returns all events since the last complete one.
        """
        try:
            return Events(*self._tracker.update(_convert.given(boxes, "boxes", columns), changed, filters))
        except InvalidBoxError as error:
            raise _convert.explained(error, boxes, "boxes", columns) from None


class BatchEvents(NamedTuple):
    """The pairs that began and ended in each world in an update."""

    begun: BatchPairs
    """The pairs that hold now and did not before."""
    ended: BatchPairs
    """The pairs that held before and do not now."""


class BatchTracker(_ArrayTracker):
    """Follows the boxes of many small worlds, such as the simulations in which a policy is trained.

    One call takes all boxes of a frame, and returns for each world which pairs of rows begin and end.

    Args:
        dimension: 2 or 3.
        dtype: float64 or float32, as in `World`.
        algorithm: A spec: see `algorithms`.
        threads: The maximum number of threads, which share the worlds; None: all cores, if there is enough to do.
        touching: Whether boxes that only touch overlap, as in `pairs`.

    Calls from several threads take turns. A batch tracker cannot be pickled or copied.
    """

    __slots__ = ()
    _name = "BatchTracker"
    _instead = "expected a new BatchTracker"

    @_arguments.suggests
    def __init__(
        self,
        dimension: int,
        *,
        dtype: DTypeLike = np.float64,
        algorithm: str = "auto",
        threads: int | None = None,
        touching: bool = True,
    ) -> None:
        self._tracker = _core.make_batch_tracker(
            *self._set_kind(dimension, dtype),
            _arguments.text(algorithm, "algorithm"),
            threads,
            _arguments.truth(touching, "touching"),
        )

    def update(
        self,
        boxes: Any,
        offsets: ArrayLike | None = None,
        *,
        filters: NDArray[np.void] | None = None,
        columns: Columns | None = None,
    ) -> BatchEvents:
        """Takes the boxes of the next frame and returns the pairs that began and ended in each world.

        In the first update all pairs begin.

        Args:
            boxes: The boxes of all worlds, as in `find_pairs_batch`: in an array of shape (worlds, n, 4) or (worlds, n,
                6), or in any form that `pairs` takes, with offsets. Each world has as many boxes as in the update
                before; absent boxes stand for bodies that are missing.
            offsets: World i has the rows from ``offsets[i]`` up to ``offsets[i + 1]``.
            filters: A filter for each box of all worlds.
            columns: As in `pairs`.

        Raises InvalidBoxError and ValueError. The tracker has not changed then, nor after Ctrl-C.
        """
        if offsets is None:
            boxes, offsets = _convert.worlds(boxes, "boxes")
        boxes = _convert.given(boxes, "boxes", columns)
        try:
            begun, ended = self._tracker.update(boxes, offsets, filters)
        except InvalidBoxError as error:
            raise _convert.explained(error, boxes, "boxes", columns) from None
        return BatchEvents(BatchPairs(*begun), BatchPairs(*ended))

"""Broadside finds every overlapping pair of axis-aligned boxes, once or frame after frame, and answers queries.

A box is a row of its minima and then its maxima: ``xmin, ymin, xmax, ymax`` in 2D and
``xmin, ymin, zmin, xmax, ymax, zmax`` in 3D. Boxes are closed: boxes that touch overlap. Results are exact in the
dtype of the boxes, float32 or float64. A row of minima ``inf`` and maxima ``-inf`` is an absent box, which overlaps
nothing.
"""

from broadside._core import __version__
from broadside._errors import (
    FileError,
    InvalidAlgorithmError,
    InvalidBoxError,
    InvalidHandleError,
    InvalidQueryError,
    InvalidSnapshotError,
)
from broadside._lab import Advice, Algorithm, Drawing, advise, algorithms, draw, read
from broadside._motion import BatchEvents, BatchTracker, Events, Tracker, World
from broadside._owners import OwnerPairs
from broadside._pairs import (
    BatchPairs,
    PairTable,
    components,
    count,
    filters,
    find_pairs_batch,
    intervals,
    invalid_rows,
    overlap_times,
    pairs,
)
from broadside._partition import Assignment, Partition
from broadside._queries import FirstHits, Found, Hits, Index, Neighbours, nearest_pairs
from broadside._within import NeighbourLists, distances, neighbour_lists

__all__ = [
    "Advice",
    "Algorithm",
    "Assignment",
    "BatchEvents",
    "BatchPairs",
    "BatchTracker",
    "Drawing",
    "Events",
    "FileError",
    "FirstHits",
    "Found",
    "Hits",
    "Index",
    "InvalidAlgorithmError",
    "InvalidBoxError",
    "InvalidHandleError",
    "InvalidQueryError",
    "InvalidSnapshotError",
    "NeighbourLists",
    "Neighbours",
    "OwnerPairs",
    "PairTable",
    "Partition",
    "Tracker",
    "World",
    "__version__",
    "advise",
    "algorithms",
    "components",
    "count",
    "distances",
    "draw",
    "filters",
    "find_pairs_batch",
    "intervals",
    "invalid_rows",
    "nearest_pairs",
    "neighbour_lists",
    "overlap_times",
    "pairs",
    "read",
]

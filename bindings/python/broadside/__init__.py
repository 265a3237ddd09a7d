"""Broadside: every overlapping pair of axis-aligned boxes, once or frame after frame, and queries.

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
from broadside._motion import Events, Tracker, World
from broadside._pairs import (
    BatchPairs,
    PairTable,
    components,
    count,
    filters,
    find_pairs_batch,
    invalid_rows,
    pairs,
)
from broadside._partition import Assignment, Partition
from broadside._queries import FirstHits, Found, Hits, Index, Neighbours, nearest_pairs

__all__ = [
    "Advice",
    "Algorithm",
    "Assignment",
    "BatchPairs",
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
    "Neighbours",
    "PairTable",
    "Partition",
    "Tracker",
    "World",
    "__version__",
    "advise",
    "algorithms",
    "components",
    "count",
    "draw",
    "filters",
    "find_pairs_batch",
    "invalid_rows",
    "nearest_pairs",
    "pairs",
    "read",
]

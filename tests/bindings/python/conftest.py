"""What the tests share: boxes, and the definition of a pair."""

from __future__ import annotations

import signal

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

# A shell without job control has Ctrl-C ignored by what it runs in the background.
signal.signal(signal.SIGINT, signal.default_int_handler)

# The same examples at each run.
settings.register_profile("broadside", derandomize=True, deadline=None, max_examples=150)
settings.load_profile("broadside")


def brute_force(boxes, other=None):
    """The definition: the pairs of closed boxes, as a set."""
    left = np.asarray(boxes)
    right = left if other is None else np.asarray(other)
    half = left.shape[1] // 2
    present_left = (left[:, :half] <= left[:, half:]).all(axis=1)
    present_right = (right[:, :half] <= right[:, half:]).all(axis=1)
    overlap = (left[:, None, :half] <= right[None, :, half:]).all(axis=2)
    overlap &= (right[None, :, :half] <= left[:, None, half:]).all(axis=2)
    overlap &= present_left[:, None] & present_right[None, :]
    if other is None:
        overlap = np.triu(overlap, 1)
    return set(zip(*(places.tolist() for places in np.nonzero(overlap))))


def as_set(pairs):
    """The pairs as a set, each there once."""
    found = [tuple(pair) for pair in np.asarray(pairs).tolist()]
    assert len(found) == len(set(found))
    return set(found)


def scattered(n, dimension=2, dtype=np.float32, seed=1, size=1.0):
    """Boxes of which each overlaps about two others, for size=1."""
    rng = np.random.default_rng(seed)
    minima = rng.random((n, dimension))
    sides = size * rng.random((n, dimension)) * 2 / max(n, 1) ** (1 / dimension)
    return np.hstack([minima, minima + sides]).astype(dtype)


@st.composite
def box_arrays(draw, dimension=None, dtype=None, most=40):
    """Boxes on few coordinates, so that many touch, coincide or have no extent; some are infinite or absent."""
    dimension = dimension or draw(st.sampled_from([2, 3]))
    dtype = dtype or draw(st.sampled_from([np.float32, np.float64]))
    n = draw(st.integers(0, most))
    coordinates = st.sampled_from([-np.inf, -2.0, -1.0, -0.0, 0.0, 1e-45, 0.5, 1.0, 2.0, 3.0, np.inf])
    a = draw(npst.arrays(dtype, (n, dimension), elements=coordinates))
    b = draw(npst.arrays(dtype, (n, dimension), elements=coordinates))
    boxes = np.hstack([np.minimum(a, b), np.maximum(a, b)])
    for row in draw(st.lists(st.integers(0, max(n - 1, 0)), max_size=2)):
        if n:
            boxes[row] = [np.inf] * dimension + [-np.inf] * dimension
    return boxes


@pytest.fixture
def no_conversion(monkeypatch):
    """Lets a test fail where an array is not taken as it is."""
    from broadside import _convert

    def refuse(found, name, *rest):
        raise AssertionError(f"{name} was converted")

    monkeypatch.setattr(_convert, "boxes", refuse)
    monkeypatch.setattr(_convert, "rows_of", refuse)

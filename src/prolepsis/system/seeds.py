"""One seed for a run, and a child of it for each thing that is random; and points that no chance has chosen."""

from __future__ import annotations

import hashlib

import numpy as np
import numpy.typing as npt


def child_of(seed: int, name: str) -> np.random.Generator:
    """Return the generator of what is called ``name``: no draw hangs on what else there is, or on the order."""
    digest = hashlib.sha256(name.encode()).digest()
    key = tuple(int(word) for word in np.frombuffer(digest, "<u4"))
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))


def scattered(count: int, dimensions: int, reach: float) -> npt.NDArray[np.float64]:
    """Return points all over a cube from which a search may start: the same in every run, whatever its seed.

    They are from ``-reach`` to ``reach`` in each dimension, shape (count, dimensions).
    """
    return np.random.default_rng(0).uniform(-reach, reach, (count, dimensions))

"""One seed for a run, and a child of it for each thing that is random."""

from __future__ import annotations

import hashlib

import numpy as np


def child_of(seed: int, name: str) -> np.random.Generator:
    """Return the generator of what is called ``name``: no draw hangs on what else there is, or on the order."""
    digest = hashlib.sha256(name.encode()).digest()
    key = tuple(int(word) for word in np.frombuffer(digest, "<u4"))
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))

"""Arrays that are dear to compute, kept in the user's cache under a digest of what they follow from."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from prolepsis.cache import cache_root
from prolepsis.things import FloatArray


def kept_array(kind: str, sources: Sequence[Any], compute: Callable[[], FloatArray]) -> FloatArray:
    """Return an array from the cache, or compute and keep it; a cache that cannot be used changes nothing.

    Args:
        kind: What it is, a word.
        sources: Arrays that it follows from.
        compute: Computes it.
    """
    digest = hashlib.sha256()
    for source in sources:
        array = np.ascontiguousarray(source)
        digest.update(str((array.dtype, array.shape)).encode() + array.tobytes())
    file = cache_root() / f"{kind}-{digest.hexdigest()[:32]}.npy"
    try:
        return np.load(file, allow_pickle=False)
    except (OSError, ValueError, EOFError):
        found = compute()
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        scratch = file.with_name(f"{file.name}.{os.getpid()}")
        with scratch.open("wb") as stream:
            np.save(stream, found, allow_pickle=False)
        scratch.replace(file)
    except OSError:
        pass
    return found

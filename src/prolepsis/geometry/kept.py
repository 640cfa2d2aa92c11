"""Arrays that are dear to compute, kept in the user's cache under a digest of what they follow from."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.system.cache import cache_root, keep, note, read_kept
from prolepsis.system.kernels import sources_digest


def kept_array(kind: str, sources: Sequence[Any], compute: Callable[[], FloatArray]) -> FloatArray:
    """Return an array from the cache, or compute and keep it; a cache that cannot be used changes nothing.

    Args:
        kind: What it is, a word.
        sources: Arrays that it follows from; what computes it counts, too.
        compute: Computes it.
    """
    digest = hashlib.sha256(sources_digest().encode())
    for source in sources:
        array = np.ascontiguousarray(source)
        digest.update(str((array.dtype, array.shape)).encode() + array.tobytes())
    file = cache_root() / "arrays" / f"{kind}-{digest.hexdigest()[:32]}"
    content = read_kept(file)
    if content is not None:
        try:
            return np.load(io.BytesIO(content), allow_pickle=False)
        except (OSError, ValueError, EOFError):
            note(f"{file}: is no array, so it is made anew")
    found = compute()
    stream = io.BytesIO()
    np.save(stream, found, allow_pickle=False)
    keep(file, stream.getvalue())
    return found

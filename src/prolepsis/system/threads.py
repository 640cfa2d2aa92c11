"""One thread of linear algebra: how many there are changes the order of sums, and with it their last digits."""

from __future__ import annotations

import os
from collections.abc import Generator
from contextlib import contextmanager

VARIABLE = "OPENBLAS_NUM_THREADS"
"""What a library that is loaded meanwhile goes by."""


@contextmanager
def one_thread() -> Generator[None]:
    """Compute with one thread within, whatever is set and whichever library was imported first; also a decorator."""
    from threadpoolctl import threadpool_limits  # pyright: ignore[reportMissingTypeStubs]

    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = "1"
    try:
        with threadpool_limits(limits=1, user_api="blas"):
            yield
    finally:
        if before is None:
            del os.environ[VARIABLE]
        else:
            os.environ[VARIABLE] = before

"""Compiled kernels: numba's compiler, told to keep what it compiles in a folder for this version of the sources.

numba recompiles a kernel when its own file has changed, but not when a kernel that is compiled into it has.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar, cast

from prolepsis.cache import cache_root

ROOMS = ("fields", "fluents", "liquid", "report")
"""Folders of the package that have kernels, with what is below them."""

Function = TypeVar("Function", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[Function], Function]:
    """Return numba's decorator for a kernel with the given options; numba is imported when the first one is made."""
    import numba  # pyright: ignore[reportMissingTypeStubs]

    config = cast(Any, numba).config
    if not config.CACHE_DIR:
        config.CACHE_DIR = str(_folder())
    return cast("Callable[[Function], Function]", cast(Any, numba).njit(**options))


def are_kept() -> bool:
    """Return whether kernels of these sources have been compiled on this machine before."""
    return Path(os.environ.get("NUMBA_CACHE_DIR") or _folder()).is_dir()


@lru_cache(maxsize=1)
def _folder() -> Path:
    package = Path(__file__).parent
    digest = hashlib.sha256()
    for room in ROOMS:
        for file in sorted((package / room).rglob("*.py")):
            digest.update(file.read_bytes())
    return cache_root() / f"kernels-{digest.hexdigest()[:16]}"

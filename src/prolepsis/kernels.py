"""Compiled kernels: numba's compiler, told to keep what it compiles in a folder for this version of the sources.

numba recompiles a kernel when its own file has changed, but not when a kernel that is compiled into it has.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import lru_cache, update_wrapper
from pathlib import Path
from typing import Any, TypeVar, cast

from prolepsis.cache import cache_root

ROOMS = ("fields", "fluents", "liquid", "report")
"""Folders of the package that have kernels, with what is below them."""

Function = TypeVar("Function", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[Function], Function]:
    """Return numba's decorator for a kernel with the given options; numba is imported when the first one is called."""

    def wrap(function: Function) -> Function:
        return cast(Function, _Kernel(function, options))

    return wrap


class _Kernel:
    """A function that is compiled when it is first called, from Python or from another kernel: many never are."""

    def __init__(self, function: Callable[..., Any], options: dict[str, Any]) -> None:
        self._function, self._options = function, options
        self._compiled: Any = None
        update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        return (self._compiled or self._dispatcher())(*arguments)

    def __getattr__(self, name: str) -> Any:
        # What numba wants to know of a kernel that another one calls, its type among it.
        return getattr(self._dispatcher(), name)

    def _dispatcher(self) -> Any:
        if self._compiled is None:
            import numba  # pyright: ignore[reportMissingTypeStubs]

            config = cast(Any, numba).config
            if not config.CACHE_DIR:
                config.CACHE_DIR = str(_folder())
            self._compiled = cast(Any, numba).njit(**self._options)(self._function)
        return self._compiled


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

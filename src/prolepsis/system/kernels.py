"""Compiled kernels: numba compiles them, and what it has compiled is kept in the cache for this version of the sources.

numba itself unpickles whatever lies in its folder, and two processes that write at once can mix its files up. So they
are kept as all of the cache is: sealed, one file for each kernel and types of its arguments.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from functools import lru_cache, update_wrapper
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar, cast

from prolepsis.system.cache import cache_root, keep, read_kept
from prolepsis.system.sources import digest_of, sources_in

ROOMS = ("geometry", "fluents", "matter/liquids", "report", "scene/shapes")
"""Folders of the package that have kernels or kept arrays, with what is below them."""
BESIDE = ("log/log.py",)
"""Files of the package whose constants kernels use beside those of their rooms."""
SETTINGS = ("OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "BOUNDSCHECK", "DEBUGINFO_DEFAULT", "FULL_TRACEBACKS")
"""What numba is told by its environment that changes what it compiles."""
FORM = 2
"""Raised when what is kept of a kernel is written otherwise (``linking``)."""
MADE_BY = ("numba", "llvmlite", "numpy", "scipy", "coacd")

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

            compiled = cast(Any, numba).njit(**(self._options | {"cache": False}))(self._function)
            # With NUMBA_DISABLE_JIT it is the function itself.
            if self._options.get("cache") and hasattr(compiled, "_cache"):
                compiled._cache = _Kept(self._function)
            self._compiled = compiled
        return self._compiled


class _Kept:
    """What numba calls the cache of one kernel."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function
        self.cache_path = str(_folder())

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the kernel compiled for a signature, or None."""
        from prolepsis.system.linking import linked

        # Its seal has been checked; nothing else may come here.
        content = read_kept(self._file(sig, target_context.codegen()))
        return None if content is None else linked(content, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled for a signature."""
        from prolepsis.system.linking import packed

        content = packed(data)
        if content is not None:
            keep(self._file(sig, data.codegen), content)

    def enable(self) -> None:
        """It is always."""

    def disable(self) -> None:
        """It never is."""

    def flush(self) -> None:
        """What is sealed stays."""

    def _file(self, sig: Any, codegen: Any) -> Path:
        function = self._function
        key = repr((FORM, function.__module__, function.__qualname__, sig, codegen.magic_tuple(), _settings()))
        return _folder() / f"{function.__name__}-{hashlib.sha256(key.encode()).hexdigest()[:32]}"


def _settings() -> list[str]:
    from numba.core import config  # pyright: ignore[reportMissingTypeStubs]

    return [str(getattr(config, name, None)) for name in SETTINGS]


def are_kept() -> bool:
    """Return whether kernels of these sources have been compiled on this machine before."""
    return _folder().is_dir()


@lru_cache(maxsize=1)
def sources_digest() -> str:
    """Return a digest of the sources of kernels and kept arrays, and of the versions of what computes them."""
    package = Path(__file__).parent.parent
    made_by = sys.version_info, [version(name) for name in MADE_BY]
    in_rooms = (file for room in ROOMS for file in sources_in(package / room, "py"))
    return digest_of(made_by, (*in_rooms, *(package / file for file in BESIDE)))


def _folder() -> Path:
    named = os.environ.get("NUMBA_CACHE_DIR", "")
    return (Path(named) if os.path.isabs(named) else cache_root()) / f"kernels-{sources_digest()[:16]}"

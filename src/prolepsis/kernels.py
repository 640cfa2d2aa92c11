"""Where compiled kernels are kept: a folder for this very version of their sources.

numba recompiles a kernel when its own file has changed, but not when a kernel that is compiled into it has.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

ROOMS = ("fields", "fluents", "liquid", "report")
"""Folders of the package that have kernels, with what is below them."""


def keep_kernels() -> None:
    """Tell numba, which is not imported yet, where to keep its kernels; a user's own choice stands."""
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    package = Path(__file__).parent
    digest = hashlib.sha256()
    for room in ROOMS:
        for file in sorted((package / room).rglob("*.py")):
            digest.update(file.read_bytes())
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    os.environ["NUMBA_CACHE_DIR"] = str(Path(home) / "prolepsis" / f"kernels-{digest.hexdigest()[:16]}")


def are_kept() -> bool:
    """Return whether kernels of these sources have been compiled on this machine before."""
    return Path(os.environ.get("NUMBA_CACHE_DIR", "")).is_dir()

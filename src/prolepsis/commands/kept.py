"""What commands tell of the package itself, kept: it stays the same until a file of the package changes."""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar, cast

from prolepsis.system.cache import cache_root, keep, read_kept

DECLARING = ("prolepsis.fluents", "prolepsis.programs", "prolepsis.knowledge", "prolepsis.matter")
"""Rooms in which things are declared; a program that has imported one may have declared more by itself."""

Told = TypeVar("Told", str, list[list[str]])


def is_as_installed() -> bool:
    """Return whether nothing but the package itself can have declared anything in this process."""
    return not any(room in sys.modules for room in DECLARING)


def kept(what: str, make: Callable[[], Told]) -> Told:
    """Return what ``make`` returns, or what it returned when the package was as it is now."""
    # A name from the command line may hold what is no letter in the user's encoding.
    key = hashlib.sha256(ascii((what, [*_package()])).encode()).hexdigest()[:32]
    file = cache_root() / "told" / key
    content = read_kept(file)
    if content is not None:
        return cast(Told, json.loads(content))
    told = make()
    keep(file, json.dumps(told).encode())
    return told


def _package() -> Iterator[tuple[str, int, int]]:
    """Yield path, size and time of the last change of each file of the package."""
    folders = [str(Path(__file__).resolve().parents[1])]
    while folders:
        for entry in sorted(os.scandir(folders.pop()), key=lambda each: each.path):
            if entry.is_dir():
                folders += [] if entry.name == "__pycache__" else [entry.path]
            else:
                status = entry.stat()
                yield entry.path, status.st_size, status.st_mtime_ns

"""What commands tell of the package itself, kept: it stays the same until a file of the package changes."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TypeVar, cast

from prolepsis.system.cache import cache_root, kept_or_made
from prolepsis.system.sources import digest_of, sources_in

DECLARING = ("prolepsis.fluents", "prolepsis.programs", "prolepsis.knowledge", "prolepsis.matter")
"""Rooms in which things are declared; a program that has imported one may have declared more by itself."""

Told = TypeVar("Told", str, list[list[str]])


def is_as_installed() -> bool:
    """Return whether nothing but the package itself can have declared anything in this process."""
    return not any(room in sys.modules for room in DECLARING)


def kept(what: str, make: Callable[[], Told]) -> Told:
    """Return what ``make`` returns, or what it returned when the package was as it is now."""
    # Without docstrings (-OO), or with those of another Python, it tells something else.
    python = sys.version_info[:2], sys.flags.optimize
    file = cache_root() / "told" / digest_of((what, python, _package()), ())[:32]
    content = kept_or_made(file, lambda: json.dumps(make()).encode())
    assert content is not None
    return cast(Told, json.loads(content))


@cache
def _package() -> str:
    package = Path(__file__).resolve().parents[1]
    return digest_of((), (file for suffix in ("py", "ttl") for file in sources_in(package, suffix)))

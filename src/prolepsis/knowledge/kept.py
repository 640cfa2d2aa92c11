"""Kept answers: files in the user's cache folder, each under the hash of what was asked, and sealed."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import cast

from prolepsis.system.cache import cache_root, keep, keep_newest, read_kept

CACHE_VARIABLE = "PROLEPSIS_CACHE"
"""Environment variable: folder of the kept answers, or empty to keep none."""
MOST_READINGS = 100
"""What was read of so many situations is kept, some 50 kB of each."""


def _cache_folder() -> Path | None:
    chosen = os.environ.get(CACHE_VARIABLE)
    if chosen is not None:
        return Path(chosen) if chosen else None
    return cache_root() / "answers"


def read_answer(key: str) -> list[int] | str | None:
    """Return the kept answer; one that is missing or altered counts as none."""
    folder = _cache_folder()
    content = None if folder is None else read_kept(folder / f"{key}.json")
    return None if content is None else cast("list[int] | str", json.loads(content))


def keep_answer(key: str, answer: list[int] | str) -> None:
    """Keep an answer for the next time."""
    folder = _cache_folder()
    if folder is not None:
        keep(folder / f"{key}.json", json.dumps(answer).encode())


def read_reading(key: str) -> bytes | None:
    """Return what was kept of all that some Turtle files say, or None."""
    folder = _cache_folder()
    return None if folder is None else read_kept(folder / "read" / key)


def keep_reading(key: str, content: bytes) -> None:
    """Keep what some Turtle files say for the next time, and of others what is newest."""
    folder = _cache_folder()
    if folder is None:
        return
    keep(folder / "read" / key, content)
    keep_newest(folder / "read", MOST_READINGS)

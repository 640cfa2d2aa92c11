"""Kept answers of the reasoner: files in the user's cache folder, each under the hash of what was asked, and sealed."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from pathlib import Path
from typing import cast

from prolepsis.cache import cache_root

CACHE_VARIABLE = "PROLEPSIS_CACHE"
"""Environment variable: folder of the kept answers, or empty to keep none."""


def _cache_folder() -> Path | None:
    chosen = os.environ.get(CACHE_VARIABLE)
    if chosen is not None:
        return Path(chosen) if chosen else None
    return cache_root() / "types"


def read_answer(key: str) -> list[int] | str | None:
    """Return the kept answer; one that is missing or altered counts as none."""
    folder = _cache_folder()
    if folder is None:
        return None
    try:
        seal, body = (folder / f"{key}.json").read_text(encoding="utf-8").split("\n", 1)
        if hashlib.sha256(f"{key}{body}".encode()).hexdigest() != seal:
            return None
        return cast("list[int] | str", json.loads(body))
    except (OSError, ValueError):
        return None


def keep_answer(key: str, answer: list[int] | str) -> None:
    """Keep an answer for the next time."""
    folder = _cache_folder()
    if folder is None:
        return
    body = json.dumps(answer)
    seal = hashlib.sha256(f"{key}{body}".encode()).hexdigest()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", dir=folder, suffix=".part", delete=False) as file:
            file.write(f"{seal}\n{body}")
        os.replace(file.name, folder / f"{key}.json")
    except OSError:
        return  # A cache that cannot be written only costs time.

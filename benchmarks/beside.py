"""Measuring this state of the package beside an earlier one: the same program with the one and the other, in turn."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import tarfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

Found = TypeVar("Found")
Row = tuple[str, ...]
"""What, measured, wanted, and what was measured of the earlier state, if there is one."""

FOLDER = Path(__file__).parent
ROOT = FOLDER.parent
HERE = ROOT / "src"


@dataclass(frozen=True, kw_only=True, slots=True)
class Used:
    """What a process took."""

    elapsed: float
    """By the clock [s]."""
    busy: float
    """Processor time, its children's included [s]."""
    memory: int
    """Greatest [kB]."""
    printed: str
    """Its standard output."""


def archived(revision: str, folder: Path) -> Path:
    """Return the sources of an earlier state, written into a folder."""
    packed = subprocess.run(["git", "archive", revision, "src"], cwd=ROOT, check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as files:
        files.extractall(folder, filter="data")
    return folder / "src"


def used(source: Path, *words: str, hash_seed: int = 0) -> Used:
    """Return what a Python process with the package in ``source`` took.

    Raises:
        RuntimeError: If it failed.
    """
    command = [sys.executable, "-S", str(FOLDER / "used.py"), sys.executable, *words]
    known = {**os.environ, "PYTHONPATH": str(source), "PYTHONHASHSEED": str(hash_seed), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, env=known, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(words)} ended with status {done.returncode}")
    return Used(**json.loads(done.stdout))


def alternately(sources: Sequence[Path], measure: Callable[[Path], Found], rounds: int) -> list[list[Found]]:
    """Return for each source what was measured of it, a round of all after the other."""
    found: list[list[Found]] = [[] for _ in sources]
    for _ in range(rounds):
        for source, each in zip(sources, found, strict=True):
            each.append(measure(source))
    return found


def row(what: str, wanted: str, measured: Sequence[str]) -> Row:
    """Return a row of the table, with what was measured of this state and of the earlier one."""
    return (what, measured[0], wanted, *measured[1:])

"""Measuring this state of the package beside an earlier one: the same program with the one and the other, in turn."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import tarfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

Found = TypeVar("Found")
Row = tuple[str, ...]
"""What, measured, wanted, and what was measured of the earlier state, if there is one."""

FOLDER = Path(__file__).parent
ROOT = FOLDER.parent
HERE = ROOT / "src"
ROUNDS = 2


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
    """Return the sources of an earlier state, written into a folder.

    Raises:
        LookupError: If there is no such commit.
    """
    named = ["git", "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}"]
    found = subprocess.run(named, cwd=ROOT, check=False, capture_output=True, text=True)
    if found.returncode:
        raise LookupError("no commit is called so here; allowed: what git rev-parse knows, as HEAD~1 or a tag")
    revision = found.stdout.strip()
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


def phase_rows(
    sources: Sequence[Path], scenario: Path, phases: Sequence[tuple[str, float, float, str, str]], *settings: str
) -> Iterator[Row]:
    """Yield for phases of a run how fast it is, and how fast beside bare steps; see ``phases.py``.

    Args:
        sources: Where the package lies.
        scenario: Its file.
        phases: Name, start and end [s], and what is wanted of the ratio and of the speed.
        settings: ``NAME=VALUE``.
    """
    times = [f"{time:g}" for _, start, end, _, _ in phases for time in (start, end)]
    words = (str(FOLDER / "phases.py"), str(scenario), *times, *settings)
    rounds = alternately(sources, lambda source: json.loads(used(source, *words).printed), ROUNDS)
    for number, (name, start, end, ratio, speed) in enumerate(phases):
        best = [{key: min(run[number][key] for run in runs) for key in ("ran", "bare")} for runs in rounds]
        shown = [f"{each['bare'] / each['ran']:.2f}" for each in best]
        yield row(f"simulate over bare mj_step of the same substeps, {name}", ratio, shown)
        yield row(f"simulated over processor time, {name}", speed, [f"{(end - start) / e['ran']:.2f}" for e in best])

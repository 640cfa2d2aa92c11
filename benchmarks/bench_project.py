"""The whole pipeline from process start to saved folder: time, memory, and the same bytes every time."""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

SCENARIO = Path(__file__).parent.parent / "examples" / "dropped_egg.toml"


def rows() -> Iterator[tuple[str, str, str]]:
    """Yield the rows of the table."""
    with tempfile.TemporaryDirectory() as place:
        folders = [Path(place) / f"seed{seed}" for seed in (0, 1, 2)]
        runs = [project_into(folder, seed) for seed, folder in enumerate(folders)]
        seconds = sorted(time for time, _, _ in runs)
        memory = max(memory for _, _, memory in runs)
        yield "egg drop (2 s), process start to saved folder, best of 3", f"{seconds[0]:.2f} s", "under 4 s"
        yield "the same, processor time", f"{min(busy for _, busy, _ in runs):.2f} s", ""
        yield "greatest memory of that process", f"{memory / 1024:.0f} MB", "stated"
        contents = [_digest(folder) for folder in folders]
        same = "yes" if len(set(contents)) == 1 else "NO"
        yield "byte-equal log and timeline in 3 processes with different hash seeds", same, "yes"
        size = sum(file.stat().st_size for file in folders[0].iterdir())
        yield "size of the saved folder", f"{size / 1e6:.2f} MB", ""


def project_into(folder: Path, seed: int) -> tuple[float, float, int]:
    """Return the elapsed and the processor time [s] and the greatest memory [kB] of one run."""
    return _used("-m", "prolepsis", "project", str(SCENARIO), "--out", str(folder), seed=seed)


def processor_time(*words: str) -> float:
    """Return the processor time of a Python process and its children [s]."""
    return _used(*words)[1]


def _used(*words: str, seed: int = 0) -> tuple[float, float, int]:
    command = [sys.executable, *words]
    began = time.perf_counter()
    process = os.posix_spawn(
        sys.executable,
        command,
        {**os.environ, "PYTHONHASHSEED": str(seed)},
        file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)],
    )
    _, status, usage = os.wait4(process, 0)
    elapsed = time.perf_counter() - began
    if status:
        raise RuntimeError(f"{' '.join(command)} ended with status {os.waitstatus_to_exitcode(status)}")
    return elapsed, usage.ru_utime + usage.ru_stime, usage.ru_maxrss


def _digest(folder: Path) -> str:
    """Return one hash of all files of a folder, names included."""
    digest = hashlib.sha256()
    for file in sorted(folder.iterdir()):
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()

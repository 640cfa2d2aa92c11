"""The folder for the socket of a process: locked while it is in use, and removed by the next program if it is not."""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
from pathlib import Path

from prolepsis.terms.errors import MissingToolError

LONGEST_SOCKET = 91
"""Longest path of a unix domain socket that every system takes [bytes]."""
PREFIX, LOCK = "prolepsis-prolog-", "lock"
"""Of the folder for the socket: how its name begins, and the file that is locked while it is in use."""


def new_folder() -> tuple[Path, int]:
    """Return a new folder for the socket and its lock, and remove the folders of programs that were killed."""
    tried: list[str] = []
    for parent in dict.fromkeys((_temporary(), "/tmp", "/dev/shm")):
        if parent is None or len(os.fsencode(parent)) + 60 > LONGEST_SOCKET:
            continue
        try:
            folder, lock = _locked(parent)
        except OSError as error:
            tried.append(f"{parent}: {error.strerror}")
            continue
        _clean(Path(parent))
        return folder, lock
    raise MissingToolError(f"no folder for temporary files: {'; '.join(tried) or 'set TMPDIR to a short path'}")


def _locked(parent: str) -> tuple[Path, int]:
    """Return a new folder and its lock; before it has that, others may take it for one that was left behind."""
    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=parent))
        lock = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        fcntl.flock(lock, fcntl.LOCK_EX)
        if (folder / LOCK).exists():
            return folder, lock
        os.close(lock)


def _temporary() -> str | None:
    try:
        return os.path.abspath(tempfile.gettempdir())
    except OSError:
        return None


def _clean(parent: Path) -> None:
    """Remove the folders whose lock nobody holds; a number of a process would tell nothing of another container."""
    for folder in parent.glob(f"{PREFIX}*"):
        try:
            if folder.lstat().st_uid != os.getuid():
                continue
            lock = os.open(folder / LOCK, os.O_RDWR | os.O_NOFOLLOW | os.O_CLOEXEC)
        except OSError:
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder, ignore_errors=True)
        except OSError:
            continue
        finally:
            os.close(lock)

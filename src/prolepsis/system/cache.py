"""The user's cache: what is dear to compute and may be thrown away, each file sealed by its content.

Anything wrong with it only costs time. A file that does not match its seal is made anew, and a folder that others may
write in is not used at all: what is in it goes into answers, and some of it is machine code.
"""

from __future__ import annotations

import hashlib
import os
import stat
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

SEAL = b"prolepsis cache 1 "
"""Begins the first line of a file; the SHA-256 of its name and of what follows the line ends it."""

PART = ".part"
"""Ends the name of a file that is being written."""
LEFT = 3600.0
"""A part that has not been touched for so long is of a process that was killed [s]."""


def cache_root() -> Path:
    """Return the folder of everything that is kept for the next time."""
    for folder in (os.environ.get("XDG_CACHE_HOME", ""), os.path.expanduser("~/.cache")):
        if os.path.isabs(folder) and folder != "/.cache":
            return Path(folder) / "prolepsis"
    # Who has no home keeps nothing: nobody can write there.
    return Path(os.devnull) / "prolepsis"


def read_kept(file: Path) -> bytes | None:
    """Return what was kept in a file of the cache; None if there is nothing, or nothing that may be trusted."""
    if not _is_safe(file.parent):
        return None
    try:
        number = os.open(file, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        with open(number, "rb") as stream:
            status = os.fstat(number)
            if not stat.S_ISREG(status.st_mode) or status.st_uid not in (os.geteuid(), 0):
                return _anew(file)
            first, _, content = stream.read().partition(b"\n")
    except FileNotFoundError:
        return None
    except OSError:
        return _anew(file)
    return content if first == _seal(file, content) else _anew(file)


def keep(file: Path, content: bytes) -> None:
    """Keep something for the next time, if that is possible; whoever reads meanwhile meets the old or the new."""
    try:
        for each in reversed((file.parent, *file.parent.parents)):
            # Only this user may change what is kept; `parents=True` would not see to that on the way.
            each.mkdir(mode=0o700, exist_ok=True)
        if not _is_safe(file.parent):
            return
        _clear_parts(file.parent)
        number, part = tempfile.mkstemp(prefix=".", suffix=PART, dir=file.parent)
        try:
            with open(number, "wb") as stream:
                stream.write(_seal(file, content) + b"\n" + content)
            os.replace(part, file)
        finally:
            with suppress(FileNotFoundError):
                os.unlink(part)
    except OSError as error:
        note(
            f"{file.parent}: nothing can be kept there ({error.strerror}), so what takes long is computed at each run;"
            " XDG_CACHE_HOME names another folder"
        )


def keep_newest(folder: Path, most: int) -> None:
    """Remove from a folder of the cache what was kept longest ago, until at most so many files are left; no others."""
    with suppress(OSError):
        files = [each for each in folder.iterdir() if not each.is_symlink() and each.is_file() and _is_ours(each)]
        for old in sorted(files, key=lambda each: each.stat().st_mtime)[: max(len(files) - most, 0)]:
            old.unlink(missing_ok=True)


def _is_ours(file: Path) -> bool:
    with file.open("rb") as stream:
        return stream.read(len(SEAL)) == SEAL


def _clear_parts(folder: Path) -> None:
    for part in folder.glob(f".*{PART}"):
        # Others may do the same meanwhile.
        with suppress(OSError):
            if time.time() - part.lstat().st_mtime > LEFT:
                part.unlink()


def kept_or_made(file: Path, make: Callable[[], bytes | None]) -> bytes | None:
    """Return what was kept in a file, or what ``make`` returns, which is kept for the next time unless it is None."""
    content = read_kept(file)
    if content is None:
        content = make()
        if content is not None:
            keep(file, content)
    return content


def note(text: str) -> None:
    """Say something on standard error that does not change an answer, once."""
    _say(text)


@lru_cache(maxsize=256)
def _say(text: str) -> None:
    # Where it cannot be said, the answer is the same.
    with suppress(OSError, ValueError):
        if sys.stderr is not None:  # pyright: ignore[reportUnnecessaryComparison]
            print(f"prolepsis: note: {text}", file=sys.stderr, flush=True)


def _seal(file: Path, content: bytes) -> bytes:
    digest = hashlib.sha256(os.fsencode(f"{file.parent.name}/{file.name}\n"))
    digest.update(content)
    return SEAL + digest.hexdigest().encode()


def _anew(file: Path) -> None:
    note(f"{file}: is damaged, so what it held is made anew")


def _is_safe(folder: Path) -> bool:
    """Return whether only this user, and who rules the system, may change what is in a folder of the cache."""
    path = Path(os.path.realpath(folder))
    for each in (path, *path.parents):
        try:
            status = each.stat()
        except FileNotFoundError:
            continue
        except OSError:
            return False
        others = status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
        # Where the sticky bit is set, others may write but not rename what is not theirs.
        guarded = status.st_mode & stat.S_ISVTX and each != path
        if status.st_uid not in (os.geteuid(), 0) or (others and not guarded):
            note(f"{each}: others may write there, so nothing is kept in or taken from the cache in {folder}")
            return False
    return True

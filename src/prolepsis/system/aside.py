"""What is written aside takes its place in one step: a kill at any moment leaves the old one whole, or the new one.

Beside its place stands a workplace, a hidden folder that its process locks. In ``making`` it holds what is not
finished; in ``done`` what is, and after the exchange what was replaced. A lock ends with its process, so that the
next one to write there knows the workplaces of killed ones, and clears them.
"""

from __future__ import annotations

import ctypes
import errno
import fcntl
import itertools
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Collection, Generator
from contextlib import contextmanager, suppress
from pathlib import Path

from prolepsis.system.text_files import path_of
from prolepsis.terms.errors import InputError

Ours = Callable[[Path], Collection[str]]
"""Returns the names of the files in a folder that prolepsis wrote, as they are, in an order to delete them."""

SUFFIX = ".unsaved"
MAKING, DONE, REPLACED = "making", "done", "replaced"
_SHOWN = 3
"""Files that a refusal names."""
_LONGEST = 40
"""Characters of a name that its workplace's has."""
_HERE, _EXCHANGE = -100, 2
"""AT_FDCWD and RENAME_EXCHANGE of Linux."""
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""There is no more room on the disk, for the user, or in a file; what has written has no name for the place."""
_NOT_HERE = (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP)


class TakenError(InputError):
    """What lies in the place to write is not ours, or is in use."""


def check_replaceable(folder: str | Path, ours: Ours) -> Path:
    """Return where ``folder`` really is, if it may be written: absent, empty, or with nothing but what is ours.

    Raises:
        InputError: If something else is there, or it could not be written.
    """
    path = path_of(folder, "folder", verb="write")
    if not str(folder):
        raise InputError("the folder to write has no name")
    path = Path(os.path.realpath(path))
    try:
        (path.parent / f".{path.name}.unsaved-longest").lstat()
    except (FileNotFoundError, NotADirectoryError):  # what is above tells more
        pass
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror}") from None
    put_back(path)
    if path.exists():
        if not path.is_dir():
            raise TakenError(f"{folder}: is a file; give a folder that does not exist or that prolepsis wrote")
        others = sorted({file.name for file in path.iterdir()} - set(ours(path)))
        if others:
            more = f" and {len(others) - _SHOWN} more" if len(others) > _SHOWN else ""
            raise TakenError(
                f"{folder}: is left alone: prolepsis did not write {', '.join(others[:_SHOWN])}{more}, or not as it is"
                " now; move it away, or give another folder"
            )
        if os.path.ismount(path):
            raise TakenError(f"{folder}: is a mount point, which cannot be replaced; give a folder within it")
    above = next(each for each in path.parents if each.exists())
    if not (above.is_dir() and os.access(above, os.W_OK | os.X_OK)):
        raise InputError(f"{folder}: cannot be written, for {above} is no folder in which you may write")
    return path


@contextmanager
def written_aside(target: Path, ours: Ours | None = None) -> Generator[Path]:
    """Yield a path to write to; on success it becomes ``target``, on any failure ``target`` is as before.

    Args:
        target: A folder or a file, that may exist.
        ours: Tells of a folder what may be deleted when it is replaced; None if a file is written.

    Raises:
        InputError: If ``target`` may not be replaced.
        OSError: If it cannot be written; where the disk is full, with the folder as its ``filename``.
    """
    target = Path(os.path.realpath(target))
    _check(target, ours)
    try:
        with _written_aside(target, ours) as aside:
            yield aside
    except OSError as error:
        if error.errno not in _FULL:
            raise
        raise OSError(error.errno, error.strerror, str(target.parent)) from error


@contextmanager
def _written_aside(target: Path, ours: Ours | None) -> Generator[Path]:
    target.parent.mkdir(parents=True, exist_ok=True)
    for left in _workplaces(target):
        _clear_left(left, target, ours)
    workplace, lock = _open_workplace(target)
    try:
        (workplace / MAKING).mkdir()
        # A file keeps its name, by whose suffix some writers choose the format.
        yield workplace / MAKING / target.name
        _check(target, ours)
        (workplace / MAKING).rename(workplace / DONE)
        _take_place(workplace, target)
    finally:
        _clear(workplace, target, ours)
        os.close(lock)


def made_beside(folder: str | Path) -> Path:
    """Make an empty folder beside ``folder``, by the first of the names ``folder-2``, ``folder-3`` ... that is free."""
    path = Path(folder)
    path = Path(os.path.abspath(path)) if path.name in ("", "..") else path
    for number in itertools.count(2):
        beside = path.with_name(f"{path.name}-{number}")
        with suppress(FileExistsError):
            beside.mkdir()
            return beside
    raise AssertionError("numbers do not end")


def put_back(target: Path) -> None:
    """Put back what a killed process had taken away and not yet replaced."""
    if os.path.lexists(target) or not target.parent.is_dir():
        return
    for left in _workplaces(target):
        if (left / REPLACED / target.name).exists() and (lock := _locked(left)) is not None:
            _put_back(left, target)
            os.close(lock)


def _check(target: Path, ours: Ours | None) -> None:
    if ours is not None:
        check_replaceable(target, ours)
    elif target.is_dir():
        raise InputError(f"{target}: is a folder; give a name for a file")


def _take_place(workplace: Path, target: Path) -> None:
    new = workplace / DONE / target.name
    if not target.is_dir():
        new.replace(target)
        return
    shutil.copymode(target, new)
    if _exchange(new, target):
        return
    # Between these two steps nothing is in place; whoever comes next puts the old one back.
    (workplace / REPLACED).mkdir()
    try:
        target.rename(workplace / REPLACED / target.name)
        new.rename(target)
    finally:
        _put_back(workplace, target)


def _put_back(workplace: Path, target: Path) -> None:
    old = workplace / REPLACED / target.name
    if old.exists() and not os.path.lexists(target):
        old.rename(target)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange two paths in one step; return whether the system and the disk can."""
    try:
        exchange = ctypes.CDLL(None, use_errno=True).renameat2
    except AttributeError:
        return False
    if exchange(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0:
        return True
    number = ctypes.get_errno()
    if number in _NOT_HERE:
        return False
    raise OSError(number, os.strerror(number), str(other))


def _workplaces(target: Path) -> list[Path]:
    """Return the workplaces beside ``target`` that are of its name, of this user, and hold nothing else."""
    form = re.compile(re.escape(f".{target.name[:_LONGEST]}.") + r"[a-z0-9_]{8}" + re.escape(SUFFIX))
    known = {MAKING, DONE, REPLACED}
    found: list[Path] = []
    with os.scandir(target.parent) as entries:
        for entry in entries:
            if form.fullmatch(entry.name) and entry.is_dir(follow_symlinks=False):
                with suppress(OSError):
                    parts = list(Path(entry.path).iterdir())
                    inside = {each.name for part in parts if part.name in known for each in part.iterdir()}
                    if entry.stat(follow_symlinks=False).st_uid == os.geteuid() and inside <= {target.name}:
                        found += [Path(entry.path)] if {part.name for part in parts} <= known else []
    return found


def _open_workplace(target: Path) -> tuple[Path, int]:
    while True:
        prefix = f".{target.name[:_LONGEST]}."
        workplace = Path(tempfile.mkdtemp(prefix=prefix, suffix=SUFFIX, dir=target.parent))
        # Until it is locked another process may take it for one that is left.
        with suppress(FileNotFoundError, BlockingIOError):
            return workplace, _lock(workplace)


def _lock(workplace: Path) -> int:
    """Return a descriptor that holds the lock of a workplace, where the disk has locks."""
    number = os.open(workplace, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
        workplace.stat()
    except (BlockingIOError, FileNotFoundError):
        os.close(number)
        raise
    except OSError:
        pass
    return number


def _locked(workplace: Path) -> int | None:
    """Return a descriptor that locks a workplace whose process is gone, or None if that is not sure."""
    try:
        number = os.open(workplace, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError:
        return None
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(number)
        return None
    return number


def _clear_left(workplace: Path, target: Path, ours: Ours | None) -> None:
    lock = _locked(workplace)
    if lock is not None:
        with suppress(OSError):
            _put_back(workplace, target)
            _clear(workplace, target, ours)
        os.close(lock)


def _clear(workplace: Path, target: Path, ours: Ours | None) -> None:
    """Remove a workplace; of what was replaced, only what is ours."""
    shutil.rmtree(workplace / MAKING, ignore_errors=True)
    for part in (DONE, REPLACED):
        old = workplace / part / target.name
        with suppress(OSError):
            if old.is_dir() and not old.is_symlink():
                for name in ours(old) if ours else ():
                    (old / name).unlink()
                old.rmdir()
            elif part == DONE:
                old.unlink(missing_ok=True)
        with suppress(OSError):
            (workplace / part).rmdir()
    with suppress(OSError):
        workplace.rmdir()

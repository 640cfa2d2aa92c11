"""A file that a user names is a file and no device, readable and not endless; a text is UTF-8, and so is its name."""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from pathlib import Path
from typing import Any, cast

from prolepsis.terms.errors import InputError, brief

_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}
_LONGEST = 4096
"""Characters of a path that a message shows; the system opens no longer one."""


def path_of(given: Any, what: str, error: type[InputError] = InputError, *, verb: str = "read") -> Path:
    """Return the path that a caller gave for ``what``, which is to be read unless a ``verb`` says otherwise.

    Raises:
        InputError: If it is none: neither text nor a path, or with a zero byte or more letters than any system takes.
    """
    name: str | bytes | None = None
    with suppress(TypeError):
        name = os.fspath(cast("str", given))
    if not isinstance(name, str):
        raise error(f"{what}: a path is text or a pathlib.Path, not {brief(given.__class__.__name__)}")
    if "\0" in name or len(name) > _LONGEST:
        why = "there is a zero byte in its name" if "\0" in name else "File name too long"
        raise error(f"{brief(name)}: cannot {verb} the {what}: {why}")
    return Path(name)


def is_file(path: Path) -> bool:
    """Return whether a path leads to a file, not to a device, a pipe or a folder."""
    try:
        return stat.S_ISREG(path.stat().st_mode)
    except (OSError, ValueError):  # a name that is too long, a folder on the way that may not be entered, a zero byte
        return False


def read_bytes(path: Path, what: str, *, most: int, error: type[InputError], called: str = "") -> bytes:
    """Return what is in the file at ``path``.

    Args:
        path: The file.
        what: What it should be, such as ``"scenario"``.
        most: Most bytes that are read; what is longer is refused.
        error: Class of the error if it cannot be read.
        called: How messages name the file; by its path if empty.
    """
    called = brief(called or path, _LONGEST)
    try:
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):
            kind = _KINDS.get(stat.S_IFMT(mode), "something else")
            raise error(f"{called}: cannot read the {what}: it is {kind}, not a file")
        with path.open("rb") as stream:
            content = stream.read(most + 1)
    except OSError as problem:
        raise error(f"{called}: cannot read the {what}: {problem.strerror}") from problem
    except ValueError as problem:
        raise error(f"{called}: cannot read the {what}: there is a zero byte in its name") from problem
    if len(content) > most:
        raise error(f"{called}: the {what} is too long: more than {most:,} bytes")
    return content


def read_text(path: Path, what: str, *, most: int, error: type[InputError], called: str = "") -> str:
    """Return the text in the file at ``path``, without a byte order mark; the arguments are those of ``read_bytes``."""
    called = brief(called or path, _LONGEST)
    try:
        str(path).encode("utf-8")
    except UnicodeEncodeError:
        raise error(f"{called}: the name of the {what} is not UTF-8 text; rename it") from None
    content = read_bytes(path, what, most=most, error=error, called=called)
    try:
        return content.decode("utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError as problem:
        raise error(f"{called}: the {what} is not UTF-8 text at byte {problem.start}; save it as UTF-8") from problem

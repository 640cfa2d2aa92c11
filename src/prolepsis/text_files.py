"""A text file that a user names: a file and no device, readable, not endless, UTF-8, and so is its name."""

from __future__ import annotations

import stat
from pathlib import Path

from prolepsis.errors import InputError

_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def read_text(path: Path, what: str, *, most: int, error: type[InputError]) -> str:
    """Return the text of the file at ``path``.

    Args:
        path: The file.
        what: What it should be, such as ``"scenario"``.
        most: Most bytes that are read; what is longer is refused.
        error: Class of the error if it cannot be read.
    """
    try:
        str(path).encode("utf-8")
    except UnicodeEncodeError:
        raise error(f"{path}: the name of the {what} is not UTF-8 text; rename it") from None
    try:
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):
            kind = _KINDS.get(stat.S_IFMT(mode), "something else")
            raise error(f"{path}: cannot read the {what}: it is {kind}, not a file")
        with path.open("rb") as stream:
            content = stream.read(most + 1)
    except OSError as problem:
        raise error(f"{path}: cannot read the {what}: {problem.strerror}") from problem
    except ValueError as problem:  # A zero byte in the name.
        raise error(f"{path}: cannot read the {what}: {problem}") from problem
    if len(content) > most:
        raise error(f"{path}: the {what} is too long: more than {most:,} bytes")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as problem:
        raise error(f"{path}: the {what} is not UTF-8 text") from problem

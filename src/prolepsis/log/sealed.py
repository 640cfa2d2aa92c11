"""A sealed folder: files written all at once or not at all, with a manifest by which any change is noticed.

The folder is written aside and takes its place in one step, so a reader never meets half of one. ``manifest.json``
holds the size and SHA-256 of every other file, the versions that made them, and a SHA-256 of itself. A folder may
come from a stranger: nothing is opened that is not a plain file of the size that the manifest tells.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import stat
import warnings
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, cast

from prolepsis.log.json_text import to_json
from prolepsis.system import aside
from prolepsis.system.text_files import path_of
from prolepsis.terms.errors import InputError, LogError, Note, brief

FORMAT = "prolepsis"
FORMAT_VERSION = 2
"""Raised when a reader of an older version could no longer read what is written."""

MANIFEST = "manifest.json"
MOST_FILES = 1000
MOST_BYTES = 8 * 2**30
"""Of all files of a folder: some hours of a scene."""
MOST_MANIFEST_BYTES = 2**20
MOST_TEXT_BYTES = 64 * 2**20
"""Of one file of JSON, which may take some twenty times as much memory."""
_MADE_BY = ("prolepsis", "mujoco", "numpy")
_DIGEST = re.compile("[0-9a-f]{64}")


def check_replaceable(folder: str | Path) -> Path:
    """Return where ``folder`` really is, if it may be written: absent, empty, or as we wrote it.

    Raises:
        InputError: If something else is there, or it could not be written.
    """
    return aside.check_replaceable(folder, _unaltered)


def write_sealed(folder: str | Path, write: Callable[[Path], None]) -> None:
    """Write a sealed folder: ``write`` fills an empty one, which then is sealed and moved to ``folder``.

    Args:
        folder: Where it shall be; an earlier one of ours is replaced. A link is followed.
        write: Writes plain files (no folders) into the folder it is given.

    Raises:
        InputError: If ``folder`` holds something that is not ours, or no longer as we wrote it.
    """
    with aside.written_aside(path_of(folder, "folder", verb="write"), _unaltered) as new:
        new.mkdir()
        write(new)
        _write_manifest(new)


def write_sealed_beside(folder: str | Path, write: Callable[[Path], None]) -> Path:
    """Write a sealed folder and return where it is: beside ``folder``, with a note, if something has come into that.

    For what took long to make: its maker has checked at the start that ``folder`` may be replaced.
    """
    try:
        write_sealed(folder, write)
        return Path(folder)
    except aside.TakenError as problem:
        beside = aside.made_beside(folder)
        try:
            write_sealed(beside, write)
        except BaseException:
            with suppress(OSError):
                beside.rmdir()
            raise
        warnings.warn(f"saved in {beside} instead; {problem}", Note, 3)
        return beside


def read_sealed(folder: str | Path, reading: Collection[str] | None = None) -> Path:
    """Return the path of a sealed folder after checking its files.

    Args:
        folder: The folder.
        reading: What will be read of it, and is checked byte by byte; all if None. Of others it is checked that they
            are there and of their size.

    Raises:
        LogError: If the folder is not one, is not whole, or is of another version.
    """
    path = path_of(folder, "saved folder", LogError)
    aside.put_back(Path(os.path.realpath(path)))
    if path.is_file():
        raise LogError(f"{path}: is a file; needed: a folder that `prolepsis project SCENARIO --out DIR` saved")
    if not path.is_dir():
        raise LogError(f"{path}: no such folder; `prolepsis project SCENARIO --out {path}` would make it")
    manifest = _read_manifest(path, versions=(FORMAT_VERSION,))
    for name, entry in _entries(path, manifest).items():
        _check_file(path / name, entry, reading is None or name in reading)
    return path


def read_text(file: Path) -> str:
    """Return the text of a file in a checked folder.

    Raises:
        ValueError: If it is too large, or no UTF-8.
    """
    size = file.stat().st_size
    if size > MOST_TEXT_BYTES:
        raise ValueError(f"{file.name} has {size} bytes; at most {MOST_TEXT_BYTES} are read")
    return file.read_text(encoding="utf-8")


def read_json(file: Path) -> Any:
    """Return what a file of JSON in a checked folder says.

    Raises:
        ValueError: If it is too large, too deep or none, or has numbers that are not finite.
    """
    return _parsed(read_text(file))


def write_text(file: Path, text: str) -> None:
    """Write a text that ``read_text`` reads.

    Raises:
        InputError: If it is too large.
    """
    content = text.encode("utf-8")
    if len(content) > MOST_TEXT_BYTES:
        raise InputError(
            f"{file.name} cannot be saved: it has {len(content)} bytes; {MOST_TEXT_BYTES} could be read again"
        )
    file.write_bytes(content)


def write_json(file: Path, value: Any) -> None:
    """Write a value as JSON that ``read_json`` reads.

    Raises:
        InputError: If it is too large.
    """
    write_text(file, to_json(value))


def _versions() -> Mapping[str, str]:
    from importlib.metadata import PackageNotFoundError, version

    def known(package: str) -> str:
        try:
            return version(package)
        except PackageNotFoundError:
            return "not installed"

    return {package: known(package) for package in _MADE_BY}


def _write_manifest(folder: Path) -> None:
    files = {
        file.name: {"bytes": file.stat().st_size, "sha256": hashlib.sha256(file.read_bytes()).hexdigest()}
        for file in sorted(folder.iterdir())
    }
    manifest = {"format": FORMAT, "version": FORMAT_VERSION, "made_by": _versions(), "files": files}
    (folder / MANIFEST).write_text(to_json({**manifest, "sha256": _seal(manifest)}), encoding="utf-8")


def _seal(manifest: Mapping[str, Any]) -> str:
    return hashlib.sha256(to_json(manifest).encode()).hexdigest()


def _read_manifest(path: Path, versions: Collection[int] | None = None) -> dict[str, Any]:
    """Return a manifest that matches its own seal, of one of some versions or of any.

    Raises:
        LogError: If there is none.
    """
    file = path / MANIFEST
    try:
        status = file.lstat()
    except FileNotFoundError:
        raise LogError(f"{path}: is no folder that prolepsis wrote (it has no {MANIFEST})") from None
    if not stat.S_ISREG(status.st_mode) or status.st_size > MOST_MANIFEST_BYTES:
        raise LogError(f"{file}: is no plain file of at most {MOST_MANIFEST_BYTES} bytes, as a manifest is")
    try:
        text = file.read_text(encoding="utf-8")
        manifest = _parsed(text)
    except UnicodeDecodeError:
        raise LogError(f"{file}: is altered: not UTF-8 text") from None
    except ValueError:
        raise LogError(f"{file}: is truncated or altered: not JSON") from None
    if not isinstance(manifest, dict):
        raise LogError(f"{file}: is not a manifest of prolepsis")
    known = cast("dict[str, Any]", manifest)
    if known.get("format") != FORMAT:
        raise LogError(f"{file}: is not a manifest of prolepsis")
    if versions is not None and known.get("version") not in versions:
        found = brief(repr(known.get("version")))
        raise LogError(f"{file}: has format version {found}; this prolepsis reads {FORMAT_VERSION}")
    seal = known.pop("sha256", None)
    try:
        # Comparing the text as well notices a changed blank, and a key that is given twice.
        whole = seal == _seal(known) and text == to_json({**known, "sha256": seal})
    except (ValueError, RecursionError):  # texts that are no Unicode
        whole = False
    if not whole:
        raise LogError(f"{file}: does not match its own SHA-256; at least one byte was altered")
    return known


def _entries(path: Path, manifest: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return size and SHA-256 of each file that a manifest lists.

    Raises:
        LogError: If it lists what no folder of ours can hold.
    """
    files = manifest.get("files")
    if not isinstance(files, dict):
        raise LogError(f"{path / MANIFEST}: lists no files")
    entries = cast("dict[str, Any]", files)
    if len(entries) > MOST_FILES:
        raise LogError(f"{path / MANIFEST}: lists {len(entries)} files; at most {MOST_FILES} are read")
    for name, entry in entries.items():
        if not is_plain_name(name):
            raise LogError(f"{path / MANIFEST}: lists {brief(repr(name))}, which is no name of a file in the folder")
        if not _is_entry(entry):
            raise LogError(f"{path / MANIFEST}: lists {brief(name)} without its size and SHA-256")
    total = sum(entry["bytes"] for entry in entries.values())
    if total > MOST_BYTES:
        raise LogError(f"{path / MANIFEST}: lists {total} bytes; at most {MOST_BYTES} are read")
    return entries


def is_plain_name(name: str) -> bool:
    """Return whether a name is one of a file in the folder itself."""
    return name not in ("", ".", "..", MANIFEST) and len(name) <= 255 and not {"/", "\0"} & set(name)


def _is_entry(entry: Any) -> bool:
    match entry:
        case {"bytes": int(size), "sha256": str(digest), **more}:
            return not more and not isinstance(size, bool) and size >= 0 and bool(_DIGEST.fullmatch(digest))
        case _:
            return False


def _check_file(file: Path, entry: Mapping[str, Any], bytewise: bool = True) -> None:
    """Check a file by what it is and its size before it is opened, and then by its bytes if they matter.

    Raises:
        LogError: If it is not as the manifest tells.
    """
    try:
        status = file.lstat()
    except FileNotFoundError:
        raise LogError(f"{file}: is missing, so the folder is not whole") from None
    if not stat.S_ISREG(status.st_mode):
        raise LogError(f"{file}: is no plain file, so it is not opened")
    if status.st_size != entry["bytes"]:
        raise LogError(f"{file}: has {status.st_size} bytes instead of {entry['bytes']}; it was truncated or altered")
    if not bytewise:
        return
    with file.open("rb") as stream:
        if hashlib.file_digest(stream, "sha256").hexdigest() != entry["sha256"]:
            raise LogError(f"{file}: does not match its SHA-256 in {MANIFEST}; at least one byte was altered")


def _unaltered(path: Path) -> list[str]:
    """Return the names of the files that are as we wrote them, last the manifest, by which the others are known."""
    try:
        entries = _entries(path, _read_manifest(path))
    except LogError:
        return []
    names: list[str] = []
    for name, entry in entries.items():
        with suppress(LogError):
            _check_file(path / name, entry)
            names.append(name)
    return [*names, MANIFEST]


def _parsed(text: str) -> Any:
    """Return the value of a text of JSON; whatever is wrong with it is a ``ValueError``."""
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except RecursionError:
        raise ValueError("nested too deeply") from None


def _refuse_constant(text: str) -> float:
    raise ValueError(f"{text} is no number of JSON")

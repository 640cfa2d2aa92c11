"""A sealed folder: files written all at once or not at all, with a manifest by which any change is noticed.

The folder is written aside and renamed, so a reader never meets half of one. ``manifest.json`` holds the size
and SHA-256 of every other file, the versions that made them, and a SHA-256 of itself.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from prolepsis.errors import InputError, LogError

FORMAT = "prolepsis"
FORMAT_VERSION = 1
"""Raised when a reader of an older version could no longer read what is written."""

MANIFEST = "manifest.json"
_MADE_BY = ("prolepsis", "mujoco", "numpy")


def check_replaceable(folder: str | Path) -> Path:
    """Return ``folder`` as a path that may be written: absent, empty, or a folder that we wrote.

    Raises:
        InputError: If something else is there.
    """
    path = Path(folder)
    if not path.exists():
        return path
    if not path.is_dir():
        raise InputError(f"{path}: is a file; give a folder that does not exist or that prolepsis wrote")
    if not any(path.iterdir()) or _is_ours(path):
        return path
    raise InputError(f"{path}: holds other files and is left alone; give a folder that does not exist")


def write_sealed(folder: str | Path, write: Callable[[Path], None]) -> None:
    """Write a sealed folder: ``write`` fills an empty one, which then is sealed and moved to ``folder``.

    Args:
        folder: Where it shall be; an earlier one of ours is replaced.
        write: Writes plain files (no folders) into the folder it is given.

    Raises:
        InputError: If ``folder`` holds something that is not ours.
    """
    target = check_replaceable(folder).absolute()
    target.parent.mkdir(parents=True, exist_ok=True)
    with written_aside(target) as aside:
        aside.mkdir()
        write(aside)
        _write_manifest(aside)


def read_sealed(folder: str | Path) -> Path:
    """Return the path of a sealed folder after checking every byte of its files.

    Raises:
        LogError: If the folder is not one, is not whole, or is of another version.
    """
    path = Path(folder)
    manifest = _read_manifest(path)
    for name, entry in manifest["files"].items():
        file = path / name
        try:
            content = file.read_bytes()
        except FileNotFoundError:
            raise LogError(f"{file}: is missing, so the folder is not whole") from None
        if len(content) != entry["bytes"]:
            raise LogError(f"{file}: has {len(content)} bytes instead of {entry['bytes']}; it was truncated or altered")
        if hashlib.sha256(content).hexdigest() != entry["sha256"]:
            raise LogError(f"{file}: does not match its SHA-256 in {MANIFEST}; at least one byte was altered")
    return path


@contextmanager
def written_aside(target: Path) -> Generator[Path]:
    """Yield a path beside ``target`` to write to; on success it becomes ``target``, on any failure it is removed."""
    workplace = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        # A file keeps its suffix, by which some writers choose the format.
        aside = workplace / target.name
        yield aside
        if target.is_dir():
            target.rename(workplace / "replaced")
        os.replace(aside, target)
    finally:
        shutil.rmtree(workplace, ignore_errors=True)


def to_json(value: Any) -> str:
    """Return readable JSON that is byte-equal for equal values."""
    return json.dumps(value, indent=1, sort_keys=True, ensure_ascii=False, allow_nan=False, default=_plain) + "\n"


def _plain(value: Any) -> Any:
    if hasattr(value, "item"):  # a numpy scalar
        return value.item()
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


def _versions() -> Mapping[str, str]:
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


def _is_ours(path: Path) -> bool:
    # Also a damaged folder of ours may be replaced, so its files are not checked.
    try:
        manifest = json.loads((path / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(manifest, dict) and manifest.get("format") == FORMAT  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]


def _read_manifest(path: Path) -> dict[str, Any]:
    file = path / MANIFEST
    if not path.is_dir():
        raise LogError(f"{path}: no such folder; `prolepsis project SCENARIO --out {path}` would make it")
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise LogError(f"{path}: is no folder that prolepsis wrote (it has no {MANIFEST})") from None
    except UnicodeDecodeError:
        raise LogError(f"{file}: is altered: not UTF-8 text") from None
    try:
        manifest: Any = json.loads(text)
    except ValueError:
        raise LogError(f"{file}: is truncated or altered: not JSON") from None
    if not isinstance(manifest, dict) or manifest.get("format") != FORMAT:  # pyright: ignore[reportUnknownMemberType]
        raise LogError(f"{file}: is not a manifest of prolepsis")
    known: dict[str, Any] = manifest  # pyright: ignore[reportUnknownVariableType]
    if known.get("version") != FORMAT_VERSION:
        raise LogError(f"{file}: has format version {known.get('version')!r}; this prolepsis reads {FORMAT_VERSION}")
    seal = known.pop("sha256", None)
    # Comparing the text as well notices a changed blank.
    if seal != _seal(known) or text != to_json({**known, "sha256": seal}):
        raise LogError(f"{file}: does not match its own SHA-256; at least one byte was altered")
    return known

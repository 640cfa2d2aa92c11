"""Digests of source files: what was computed from some is kept until one of them is another."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path


def digest_of(known: object, files: Iterable[Path]) -> str:
    """Return a digest of what else is known, by its ``repr``, and of the names and contents of files in any order."""
    return _digest(known, ((file.name, file.read_bytes()) for file in sorted(files)))


def sources_in(folder: Path, suffix: str) -> list[Path]:
    """Return the files in a folder, or below it, that end so; not what an editor leaves beside them."""
    files = (file for file in folder.rglob(f"*.{suffix}") if not file.name.startswith("."))
    return sorted(file for file in files if file.is_file())


def digest_of_texts(known: object, texts: Iterable[tuple[object, str]]) -> str:
    """Return a digest of what else is known, and of texts in their order with what is known of each."""
    return _digest(known, ((each, text.encode("utf-8", "surrogatepass")) for each, text in texts))


def _digest(known: object, contents: Iterable[tuple[object, bytes]]) -> str:
    digest = hashlib.sha256(ascii(known).encode())
    for name, content in contents:
        digest.update(f"\n{ascii(name)} {len(content)}\n".encode() + content)
    return digest.hexdigest()

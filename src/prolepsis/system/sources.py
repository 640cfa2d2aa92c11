"""Digests of source files: what was computed from some is kept until one of them is another."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path


def digest_of(known: object, files: Iterable[Path]) -> str:
    """Return a digest of what else is known, by its ``repr``, and of the names and contents of files in any order."""
    digest = hashlib.sha256(ascii(known).encode())
    for file in sorted(files):
        content = file.read_bytes()
        digest.update(f"\n{ascii(file.name)} {len(content)}\n".encode() + content)
    return digest.hexdigest()

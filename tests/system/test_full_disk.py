"""A disk that is full is told with the folder that was to be written."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from prolepsis.system.aside import written_aside


def test_the_folder_on_a_full_disk_is_named(tmp_path: Path) -> None:
    target = tmp_path / "out.png"
    with pytest.raises(OSError, match="No space left") as caught, written_aside(target), open("/dev/full", "w") as file:
        file.write("much")
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(tmp_path))
    assert not list(tmp_path.iterdir())


def test_other_errors_are_told_as_they_are(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as caught, written_aside(tmp_path / "out.png"):
        (tmp_path / "none").read_text()
    assert caught.value.filename == str(tmp_path / "none")

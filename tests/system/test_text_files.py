"""One reader serves every file that a user names, so each kind of what is no file is told in the same words."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pyarrow as arrow  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.parquet as parquet  # pyright: ignore[reportMissingTypeStubs]
import pytest

from prolepsis.geometry.meshes import MOST_BYTES as LONGEST_MESH
from prolepsis.geometry.meshes import read_surface
from prolepsis.knowledge.sources import LONGEST_FILE as LONGEST_TURTLE
from prolepsis.knowledge.sources import read_source
from prolepsis.logic.rules import LONGEST_RULES, read_rules
from prolepsis.programs.recording import MOST_BYTES as LONGEST_RECORDING
from prolepsis.programs.recording import read_recording
from prolepsis.robots.model_text import MOST_BYTES as LONGEST_ROBOT
from prolepsis.robots.model_text import read_model_tree
from prolepsis.scenario.file import LONGEST_FILE as LONGEST_SCENARIO
from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import InputError

Reader = Callable[[Path], object]

READERS: dict[str, tuple[Reader, str, int]] = {
    "scenario": (Scenario.load, ".toml", LONGEST_SCENARIO),
    "Turtle file": (read_source, ".ttl", LONGEST_TURTLE),
    "file": (read_rules, ".pl", LONGEST_RULES),
    "recording": (lambda path: read_recording(path, ()), ".csv", LONGEST_RECORDING),
    "robot file": (read_model_tree, ".xml", LONGEST_ROBOT),
    "mesh": (read_surface, ".stl", LONGEST_MESH),
}
"""By what messages call it: the reader, the end of a name, and the most bytes."""


@pytest.mark.parametrize("what", READERS)
def test_what_is_no_file_is_told_in_the_same_words(what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    read, suffix, most = READERS[what]
    places = {
        name: Path(f"{name}{suffix}") for name in ("folder", "pipe", "socket", "device", "none", "long", "locked")
    }
    places["folder"].mkdir()
    os.mkfifo(places["pipe"])
    places["device"].symlink_to("/dev/zero")
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(places["socket"]))
    with places["long"].open("wb") as file:
        file.truncate(most + 1)
    for name, told in {
        "folder": f"cannot read the {what}: it is a folder, not a file",
        "pipe": f"cannot read the {what}: it is a pipe, not a file",
        "socket": f"cannot read the {what}: it is a socket, not a file",
        "device": f"cannot read the {what}: it is a device, not a file",
        "none": f"cannot read the {what}: No such file or directory",
        "long": f"the {what} is too long: more than {most:,} bytes",
    }.items():
        with pytest.raises(InputError) as caught:
            read(places[name])
        assert str(caught.value).endswith(f"{places[name]}: {told}"), str(caught.value)
    for path, told in {
        Path("x" * 300 + suffix): f"cannot read the {what}: File name too long",
        Path(f"zero\0{suffix}"): f"zero\\x00{suffix}: cannot read the {what}: there is a zero byte in its name",
    }.items():
        with pytest.raises(InputError) as caught:
            read(path)
        assert told in str(caught.value) and "\0" not in str(caught.value)


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_recording_may_have_any_name(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"r\xff" + suffix.encode())
    columns = {name: np.array([0.0, 0.1]) for name in ("time", "dx", "dy", "dz")}
    if suffix == ".csv":
        path.write_text("time,dx,dy,dz\n0,0,0,0\n0.1,0.1,0.1,0.1\n")
    else:
        with path.open("wb") as file:
            cast(Any, parquet).write_table(cast(Any, arrow).table(columns), file)
    assert list(read_recording(path, ()).time) == [0.0, 0.1]


def test_a_mesh_leads_to_no_other_file(tmp_path: Path) -> None:
    # A cube whose material file is a pipe: who opened it would wait for ever.
    os.mkfifo(tmp_path / "pipe.mtl")
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    sides = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
    text = "mtllib pipe.mtl\n" + "".join("v {} {} {}\n".format(*corner) for corner in corners)
    text += "".join("f {} {} {} {}\n".format(*side) for side in sides)
    (tmp_path / "m.obj").write_text(text)
    assert len(read_surface(tmp_path / "m.obj").triangles) == 12

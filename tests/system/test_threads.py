"""A run has the same bytes however many threads the linear algebra may use, and whatever was imported first."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from prolepsis.system.threads import one_thread

EXAMPLES = Path(__file__).parents[2] / "examples"
PROJECT = """
import hashlib, sys
if sys.argv[2] == "numpy first":
    import numpy, scipy.linalg
import prolepsis

log = prolepsis.project(sys.argv[1]).log
digest = hashlib.sha256()
for name in sorted(log.channels):
    digest.update(log.channels[name].tobytes())
print(digest.hexdigest(), log.channels["egg1.load"].max() > 0)
"""


@pytest.fixture(scope="module")
def grasp(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a scenario in which an egg is grasped, which loads its bonds."""
    folder = tmp_path_factory.mktemp("grasp")
    (folder / "grasp_egg.ttl").write_text((EXAMPLES / "grasp_egg.ttl").read_text())
    file = folder / "grasp.toml"
    file.write_text("duration = 2.5\n" + (EXAMPLES / "grasp_egg.toml").read_text())
    return file


def test_threads_and_imports_do_not_change_a_digit(grasp: Path) -> None:
    found: set[str] = set()
    for threads, first in (
        ("1", "prolepsis first"),
        ("4", "prolepsis first"),
        ("4", "numpy first"),
        (None, "numpy first"),
    ):
        environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
        environment |= {} if threads is None else {"OPENBLAS_NUM_THREADS": threads}
        command = [sys.executable, "-c", PROJECT, str(grasp), first]
        found.add(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)
    (output,) = found
    assert output.endswith(" True\n")


@pytest.mark.parametrize("threads", [None, "4"])
def test_what_was_set_is_set_again(monkeypatch: pytest.MonkeyPatch, threads: str | None) -> None:
    if threads is None:
        monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    else:
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", threads)
    with one_thread():
        assert os.environ["OPENBLAS_NUM_THREADS"] == "1"
    assert os.environ.get("OPENBLAS_NUM_THREADS") == threads

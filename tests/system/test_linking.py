"""Kernels that were kept do in another process what they did in the one that compiled them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import numpy as np
from prolepsis.system.kernels import njit

@njit(cache=True)
def shares(numbers, least):
    total = numbers.sum()
    if total < least:
        raise ValueError("too little")
    return numbers / total, (total, len(numbers))

@njit(cache=True)
def greatest(numbers):
    parts, (total, count) = shares(numbers, 1.0)
    return parts.max() * total + count

print(shares(np.arange(1.0, 4.0), 1.0), greatest(np.arange(1.0, 5.0)))
try:
    greatest(np.zeros(2))
except ValueError as error:
    print(error)
print([sum(each.stats.cache_hits.values()) for each in (shares, greatest)])
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a script of kernels that has run once."""
    folder = tmp_path_factory.mktemp("linking")
    (folder / "script.py").write_text(SCRIPT)
    assert run(folder) == (FOUND, [0, 0])
    return folder


FOUND = "(array([0.16666667, 0.33333333, 0.5       ]), (6.0, 3)) 8.0\ntoo little"


def run(folder: Path) -> tuple[str, list[int]]:
    """Return what the script says, and which kernels were not compiled."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "home")}
    command = [sys.executable, str(folder / "script.py")]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    found, _, kept = done.stdout.strip().rpartition("\n")
    return found, [int(each) for each in kept.strip("[]").split(",")]


def test_a_kept_kernel_answers_and_refuses_as_the_compiled_one(folder: Path) -> None:
    assert run(folder) == (FOUND, [1, 1])


def test_a_kept_kernel_is_taken_into_one_that_is_compiled_later(folder: Path) -> None:
    (caller,) = (folder / "home" / "prolepsis").glob("kernels-*/greatest-*")
    caller.unlink()
    assert run(folder) == (FOUND, [1, 0])
    assert run(folder) == (FOUND, [1, 1])


def test_a_kernel_that_is_only_called_by_kept_ones_is_not_asked_for(folder: Path) -> None:
    for called in (folder / "home" / "prolepsis").glob("kernels-*/shares-*"):
        called.unlink()
    assert run(folder) == (FOUND, [0, 1])

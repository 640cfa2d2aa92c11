"""Prolog starts from what it had loaded, and from its files where that is not to be had."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from prolepsis.logic import process
from prolepsis.logic.process import STACK_LIMIT, STATE, PrologProcess
from prolepsis.logic.saved_state import saved_state
from prolepsis.system.cache import cache_root

FLAGS = "current_prolog_flag(stack_limit, S), current_prolog_flag(autoload, A), format(string(Reply), '~w ~w', [S, A])"


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return cache_root() / "prolog"


def told(started: PrologProcess) -> str:
    try:
        assert started.call("sumlist([1, 2], X), format(string(Reply), '~w', [X])", 10.0) == "3"
        return started.call(FLAGS, 10.0)
    finally:
        started.close()


def test_it_is_made_once_and_kept(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    started = PrologProcess()
    (kept,) = cache.iterdir()
    assert kept.read_bytes().endswith((started.folder / STATE).read_bytes())
    assert told(started) == f"{STACK_LIMIT << 20} true"
    monkeypatch.setattr("prolepsis.logic.saved_state._made", None)
    assert told(PrologProcess()) == f"{STACK_LIMIT << 20} true"


def test_other_files_or_another_program_make_another(cache: Path, tmp_path: Path) -> None:
    code = tmp_path / "code"
    code.mkdir()
    (code / "main.pl").write_text("serve.\n")
    program = process._program()  # pyright: ignore[reportPrivateUsage]
    first = saved_state(program, code, STACK_LIMIT, tmp_path)
    assert first is not None
    assert saved_state(program, code, STACK_LIMIT, tmp_path) == first
    (code / "main.pl").write_text("serve :- true.\n")
    saved_state(program, code, STACK_LIMIT, tmp_path)
    saved_state(program, code, STACK_LIMIT + 1, tmp_path)
    assert len([*cache.iterdir()]) == 3


@pytest.mark.parametrize("state", [None, b"", b"no state", os.urandom(5000)])
def test_without_one_it_starts_from_its_files(state: bytes | None, monkeypatch: pytest.MonkeyPatch) -> None:
    def given(program: str, code: Path, stack_limit: int, folder: Path) -> bytes | None:
        return state

    monkeypatch.setattr(process, "saved_state", given)
    started = PrologProcess()
    assert not (started.folder / STATE).exists(), "it may fill the disk"
    assert told(started) == f"{STACK_LIMIT << 20} true"


def test_a_prolog_that_makes_none_is_no_error(tmp_path: Path) -> None:
    program = tmp_path / "swipl"
    program.write_text("#!/bin/sh\nexit 1\n")
    program.chmod(0o700)
    assert saved_state(str(program), tmp_path, STACK_LIMIT, tmp_path) is None


def test_it_leaves_nothing_when_the_program_is_killed_while_it_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    run = "from prolepsis.logic.process import PrologProcess; PrologProcess().close()"
    stuck = f"import subprocess; subprocess.run = lambda *_, **__: input(print('making', flush=True)); {run}"
    # A path that is short enough for a socket.
    with tempfile.TemporaryDirectory(dir="/tmp") as temporary:
        monkeypatch.setenv("TMPDIR", temporary)
        with subprocess.Popen([sys.executable, "-c", stuck], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as killed:
            assert killed.stdout is not None
            assert killed.stdout.readline() == b"making\n"
            killed.kill()
        assert os.listdir(temporary)
        subprocess.run([sys.executable, "-c", run], check=True)
        assert not os.listdir(temporary)

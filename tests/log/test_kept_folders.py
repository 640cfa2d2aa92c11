"""What a user has is never lost: what is not ours is left alone, and a kill leaves the old result or the new one."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import textwrap
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.synthetic import egg_drop_log

from prolepsis.cli import main
from prolepsis.engine import simulation
from prolepsis.log import sealed
from prolepsis.log.files import write_log
from prolepsis.log.sealed import MANIFEST, read_sealed, write_sealed
from prolepsis.projection import Projection, project
from prolepsis.system import aside
from prolepsis.terms.errors import InputError, Note


def write(folder: Path, word: str) -> None:
    """Write a sealed folder of three files."""

    def fill(path: Path) -> None:
        for name in ("a.txt", "b.txt", "c.txt"):
            (path / name).write_text(word)

    write_sealed(folder, fill)


def words(folder: Path) -> str:
    """Return the word of a folder, which must be whole."""
    read_sealed(folder)
    (word,) = {(folder / name).read_text() for name in ("a.txt", "b.txt", "c.txt")}
    return word


def files(folder: Path) -> list[str]:
    return sorted(str(file.relative_to(folder)) for file in folder.rglob("*"))


def test_a_file_that_the_manifest_does_not_list_is_named_and_the_folder_left_alone(tmp_path: Path) -> None:
    write(tmp_path / "run", "old")
    (tmp_path / "run" / "notes.txt").write_text("mine")
    before = files(tmp_path)
    with pytest.raises(InputError, match=r"is left alone: prolepsis did not write notes\.txt"):
        write(tmp_path / "run", "new")
    assert files(tmp_path) == before
    assert words(tmp_path / "run") == "old"


def test_a_folder_or_a_link_in_it_is_left_alone_too(tmp_path: Path) -> None:
    write(tmp_path / "run", "old")
    (tmp_path / "run" / "b.txt").rename(tmp_path / "elsewhere.txt")
    (tmp_path / "run" / "b.txt").symlink_to(tmp_path / "elsewhere.txt")
    (tmp_path / "run" / "more").mkdir()
    with pytest.raises(InputError, match=r"prolepsis did not write b\.txt, more, or"):
        write(tmp_path / "run", "new")
    assert (tmp_path / "elsewhere.txt").read_text() == "old"


def test_a_file_that_the_user_has_changed_is_not_lost(tmp_path: Path) -> None:
    write(tmp_path / "run", "old")
    (tmp_path / "run" / "b.txt").write_text("my own words")
    with pytest.raises(InputError, match=r"prolepsis did not write b\.txt, or not as it is now"):
        write(tmp_path / "run", "new")
    assert (tmp_path / "run" / "b.txt").read_text() == "my own words"


def test_a_folder_that_has_lost_a_file_is_replaced(tmp_path: Path) -> None:
    write(tmp_path / "run", "old")
    (tmp_path / "run" / "b.txt").unlink()
    write(tmp_path / "run", "new")
    assert words(tmp_path / "run") == "new"


def test_a_folder_that_only_looks_like_ours_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / MANIFEST).write_text(json.dumps({"format": "prolepsis", "files": {}}))
    (tmp_path / "run" / "thesis.tex").write_text("mine")
    with pytest.raises(InputError, match=r"did not write manifest\.json, thesis\.tex"):
        write(tmp_path / "run", "new")
    assert files(tmp_path / "run") == [MANIFEST, "thesis.tex"]


def test_a_file_that_comes_while_we_write_is_left_alone(tmp_path: Path) -> None:
    write(tmp_path / "run", "old")

    def fill(path: Path) -> None:
        (path / "a.txt").write_text("new")
        (tmp_path / "run" / "notes.txt").write_text("mine")

    with pytest.raises(InputError, match=r"notes\.txt"):
        write_sealed(tmp_path / "run", fill)
    assert words(tmp_path / "run") == "old"
    assert [file.name for file in tmp_path.iterdir()] == ["run"]


def test_a_link_to_a_folder_stays_and_what_it_leads_to_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    write(tmp_path / "disk" / "run", "old")
    (tmp_path / "latest").symlink_to(tmp_path / "disk" / "run")
    write(tmp_path / "latest", "new")
    assert (tmp_path / "latest").is_symlink()
    assert words(tmp_path / "disk" / "run") == "new"
    assert [file.name for file in (tmp_path / "disk").iterdir()] == ["run"]


def test_a_folder_keeps_who_may_read_it(tmp_path: Path) -> None:
    write(tmp_path / "run", "old")
    (tmp_path / "run").chmod(0o700)
    write(tmp_path / "run", "new")
    assert (tmp_path / "run").stat().st_mode & 0o777 == 0o700


def test_a_picture_does_not_take_the_place_of_a_folder(tmp_path: Path) -> None:
    (tmp_path / "film.mp4").mkdir()
    (tmp_path / "film.mp4" / "mine.txt").write_text("mine")
    with pytest.raises(InputError, match="is a folder"), aside.written_aside(tmp_path / "film.mp4") as new:
        new.write_text("film")
    assert files(tmp_path) == ["film.mp4", "film.mp4/mine.txt"]


def test_a_folder_where_nothing_can_be_written_is_refused_before_anything_is_simulated(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    with pytest.raises(InputError, match="is no folder in which you may write"):
        write(tmp_path / "file" / "run", "new")


KILLED = textwrap.dedent(
    """
    import ctypes, os, pathlib, shutil, signal, sys, tempfile
    from prolepsis.system import aside
    from prolepsis.log.sealed import write_sealed

    folder, left, exchanges = sys.argv[1], int(sys.argv[2]), sys.argv[3] == "True"

    def killing(function):
        def call(*given, **named):
            global left
            left -= 1
            if left < 0:
                os.kill(os.getpid(), signal.SIGKILL)
            return function(*given, **named)
        return call

    for home, name in (
        (tempfile, "mkdtemp"), (pathlib.Path, "mkdir"), (pathlib.Path, "write_text"), (pathlib.Path, "rename"),
        (pathlib.Path, "unlink"), (pathlib.Path, "rmdir"), (shutil, "rmtree"), (aside, "_exchange"), (os, "open"),
    ):
        setattr(home, name, killing(getattr(home, name)))
    if not exchanges:
        aside._exchange = lambda one, other: False

    def fill(path):
        for name in ("a.txt", "b.txt", "c.txt"):
            (path / name).write_text("new")

    write_sealed(folder, fill)
    """
)


@pytest.mark.parametrize("exchanges", [True, False])
def test_a_kill_at_any_step_leaves_the_old_or_the_new_and_the_next_one_clears_up(
    tmp_path: Path, exchanges: bool
) -> None:
    seen: set[str] = set()
    for number in range(100):
        folder = tmp_path / str(number) / "run"
        write(folder, "old")
        command = [sys.executable, "-c", KILLED, str(folder), str(number), str(exchanges)]
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
        assert done.returncode in (0, -signal.SIGKILL), done.stderr
        # Reading alone puts back what was taken away.
        seen.add(words(folder))
        write(folder, "next")
        assert words(folder) == "next"
        assert [file.name for file in folder.parent.iterdir()] == ["run"]
        if done.returncode == 0:
            assert number > 15
            break
    else:
        pytest.fail("it was killed a hundred times and never came to its end")
    assert seen == {"old", "new"}


def test_a_disk_that_fills_while_saving_leaves_the_old_one(tmp_path: Path) -> None:
    write_log(egg_drop_log(), tmp_path / "run")
    before = {file.name: file.read_bytes() for file in (tmp_path / "run").iterdir()}
    code = (
        "import resource, sys; from prolepsis.log.files import write_log; from tests.synthetic import wet_log\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), -1))\n"
        "try:\n    write_log(wet_log(), sys.argv[1])\nexcept OSError as error:\n    print('full')"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    for most in (0, 100, 1000, 5000):
        command = [sys.executable, "-c", code, str(tmp_path / "run"), str(most)]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        assert (done.stdout, done.stderr) == ("full\n", "")
        assert {file.name: file.read_bytes() for file in (tmp_path / "run").iterdir()} == before
        assert [file.name for file in tmp_path.iterdir()] == ["run"]


@pytest.mark.laws
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_projection_that_is_ended_at_any_moment_leaves_the_old_or_the_new(
    tmp_path: Path, how: signal.Signals
) -> None:
    examples = Path(__file__).parents[2] / "examples"
    shutil.copy(examples / "dropped_egg.ttl", tmp_path)
    texts = {"old": "wait(0.01)", "new": "wait(0.02)"}
    for name, plan in texts.items():
        text = f'situation = "dropped_egg.ttl"\nplan = "{plan}"\nduration = 0.03\n'
        (tmp_path / f"{name}.toml").write_text(text)

    def command(name: str) -> list[str]:
        return [sys.executable, "-m", "prolepsis", "project", str(tmp_path / f"{name}.toml"), "--out", str(run)]

    run = tmp_path / "out" / "run"
    began = time.monotonic()
    subprocess.run(command("old"), check=True, capture_output=True)
    whole = time.monotonic() - began
    random = np.random.default_rng(5)
    for _ in range(10):
        with subprocess.Popen(command("new"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            with suppress(subprocess.TimeoutExpired):
                # Most of the moments are late, when something is written.
                process.wait(whole * (1.2 - random.random() ** 2))
            process.send_signal(how)
        assert process.returncode in (0, -how, 130)
        plan = json.loads((read_sealed(run) / "scenario.json").read_text())["plan"]
        assert plan in texts.values()
        if plan == texts["new"]:
            subprocess.run(command("old"), check=True, capture_output=True)
    subprocess.run(command("new"), check=True, capture_output=True)
    assert [file.name for file in run.parent.iterdir()] == ["run"]


def test_a_file_that_comes_during_a_run_does_not_cost_it(tmp_path: Path) -> None:
    (tmp_path / "s.ttl").write_text("@prefix : <https://w3id.org/prolepsis#> .\n:floor a :Floor .")
    (tmp_path / "s.toml").write_text('situation = "s.ttl"\nplan = "wait(0.02)"\n')
    write(tmp_path / "run", "old")
    (tmp_path / "run-2").mkdir()

    def take_note(doing: str) -> None:
        if doing.startswith("simulating"):
            (tmp_path / "run" / "notes.txt").write_text("mine")

    with pytest.warns(
        Note, match=r"saved in .*run-3 instead; .*run: is left alone: prolepsis did not write notes\.txt"
    ):
        result = project(tmp_path / "s.toml", out=tmp_path / "run", progress=take_note)
    assert Projection.load(tmp_path / "run-3").timeline == result.timeline
    assert words(tmp_path / "run") == "old"
    assert files(tmp_path / "run-2") == []
    assert sorted(file.name for file in tmp_path.iterdir()) == ["run", "run-2", "run-3", "s.toml", "s.ttl"]


def test_the_command_says_where_it_has_saved(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "s.ttl").write_text("@prefix : <https://w3id.org/prolepsis#> .\n:floor a :Floor .")
    (tmp_path / "s.toml").write_text('situation = "s.ttl"\nplan = "wait(0.02)"\n')
    monkeypatch.chdir(tmp_path)
    simulated = simulation.simulate

    def simulate(*arguments: Any, **named: Any) -> Any:
        Path("run").write_text("mine")
        return simulated(*arguments, **named)

    monkeypatch.setattr(simulation, "simulate", simulate)
    assert main(["project", "s.toml", "--out", "run"]) == 0
    told = capfd.readouterr()
    assert told.out.endswith("saved in run-2\n")
    assert told.err.replace(f"{tmp_path}/", "") == (
        "prolepsis: note: saved in run-2 instead; run: is a file; give a folder that does not exist or that prolepsis"
        " wrote\n"
    )
    assert Path("run").read_text() == "mine"


def test_of_two_that_are_saved_beside_none_is_lost(tmp_path: Path) -> None:
    places = {aside.made_beside(tmp_path / "run") for _ in range(3)}
    assert sorted(place.name for place in places) == ["run-2", "run-3", "run-4"]


def test_what_is_saved_beside_and_fails_leaves_no_folder(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("mine")

    def fail(path: Path) -> None:
        raise OSError

    with pytest.raises(OSError):
        sealed.write_sealed_beside(tmp_path / "run", fail)
    assert [file.name for file in tmp_path.iterdir()] == ["run"]

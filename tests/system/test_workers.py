"""A process that dies takes only its task along, and none outlives the one that started it; status 1 is only no."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from tests import tasks

from prolepsis.campaigns.campaign import Outcomes, Row, sweep
from prolepsis.commands import sweep as command
from prolepsis.system.workers import Lost, carry_out

ROOT = Path(__file__).parents[2]
STEP = 0.05
"""Between two looks [s]."""


def until_it_exists(file: Path) -> None:
    for _ in range(int(120 / STEP)):
        if file.exists():
            return
        time.sleep(STEP)
    pytest.fail(f"{file} never came")


def until_it_is_gone(process: int) -> None:
    for _ in range(int(60 / STEP)):
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return
        if state == "Z":
            return
        time.sleep(STEP)
    pytest.fail(f"process {process} goes on")


def test_results_come_with_their_numbers() -> None:
    assert dict(carry_out(tasks.square, [(n,) for n in range(5)], 2)) == {n: n * n for n in range(5)}


def test_a_task_whose_process_was_killed_is_tried_once_more_alone(tmp_path: Path) -> None:
    (tmp_path / "survivals").write_text("")
    given = [(n, 1, str(tmp_path / "survivals")) for n in range(4)]
    found = list(carry_out(tasks.square_or_die, given, 2))
    assert found[-1] == (1, 1)
    assert dict(found) == {0: 0, 1: 1, 2: 4, 3: 9}


def test_a_task_that_always_ends_its_process_is_lost_and_the_others_are_not() -> None:
    found = dict(carry_out(tasks.square_or_end, [(n, 1) for n in range(4)], 2))
    assert found.pop(1) == Lost(reason="its process ended with exit status 1, also when tried once more alone")
    assert found == {0: 0, 2: 4, 3: 9}


def test_a_task_that_fails_says_where() -> None:
    found = dict(carry_out(tasks.square_or_fail, [(n, 1) for n in range(3)], 2))
    lost = found.pop(1)
    assert lost.reason == "unexpected failure: KeyError: 1"
    assert "in square_or_fail" in lost.trace
    assert found == {0: 0, 2: 4}


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_however_a_process_ends_its_workers_end_too(tmp_path: Path, how: signal.Signals) -> None:
    code = (
        "import signal, sys; from prolepsis.system.workers import carry_out; from tests.tasks import tell_and_sleep\n"
        # What runs in the background of a shell begins deaf to Ctrl-C.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "list(carry_out(tell_and_sleep, [(name,) for name in sys.argv[1:]], 2))"
    )
    files = [tmp_path / "a", tmp_path / "b"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    started = [sys.executable, "-c", code, *map(str, files)]
    with subprocess.Popen(started, env=environment, cwd=ROOT, stderr=subprocess.DEVNULL) as process:
        for file in files:
            until_it_exists(file)
        process.send_signal(how)
        try:
            process.wait(timeout=60)
        finally:
            process.kill()
    for file in files:
        until_it_is_gone(int(file.read_text()))


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    shutil.copy(ROOT / "examples" / "dropped_egg.ttl", tmp_path)
    file = tmp_path / "short.toml"
    file.write_text('situation = "dropped_egg.ttl"\nplan = "wait(Time)"\nduration = 0.05\n[parameters]\nTime = 0.03\n')
    return file


def test_a_sweep_needs_no_guard_in_the_users_script(scenario: Path) -> None:
    script = scenario.with_name("script.py")
    script.write_text(
        f"import prolepsis\nrows = prolepsis.sweep({str(scenario)!r}, {{'Time': [0.01, 0.02]}}).rows\n"
        "print([row.error for row in rows])"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=True)
    assert done.stdout == "[None, None]\n"


def test_a_lost_row_is_a_row_and_the_others_come_out(scenario: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("prolepsis.campaigns.campaign._run", tasks.row_or_end)
    outcomes = sweep(scenario, {"Time": [0.01, 0.02, 0.03]})
    assert [row.error is None for row in outcomes.rows] == [True, False, True]
    assert "was killed by SIGKILL, also when tried once more alone" in str(outcomes.rows[1].error)


def test_an_interrupted_sweep_ends_with_130_and_leaves_nobody(scenario: Path) -> None:
    values = ",".join(str(0.001 * n) for n in range(1, 40))
    started = [sys.executable, "-m", "prolepsis", "sweep", str(scenario), "--over", f"Time={values}", "--progress"]
    with subprocess.Popen(started, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert "of 39 runs done" in process.stderr.readline()
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (130, "")
    assert errors.splitlines()[-1].startswith("prolepsis: interrupted")
    assert len(children) == 2
    for child in children:
        until_it_is_gone(int(child))


NO, YES = Row(values={}, answers=[]), Row(values={}, answers=[{}])
WRONG, INVALID = Row(values={}, error="wrong"), Row(values={}, error="unstable", invalid=True)
LOST = Row(values={}, error="lost", unexpected="killed")


@pytest.mark.parametrize(
    ("rows", "status"),
    [
        ([NO, NO], 1),
        ([NO, YES, LOST], 0),
        ([NO, WRONG], 2),
        ([NO, INVALID, WRONG], 3),
        ([NO, LOST, INVALID], 4),
        ([LOST], 4),
    ],
)
def test_one_is_only_ever_no(rows: list[Row], status: int) -> None:
    assert command.status_of(Outcomes(rows=tuple(rows)), "true") == status


def test_rows_of_json_tell_of_a_lost_one(capsys: pytest.CaptureFixture[str]) -> None:
    print(command.as_json(Outcomes(rows=(NO, LOST))))
    assert [json.loads(line).get("error") for line in capsys.readouterr().out.splitlines()] == [None, "lost"]

"""The wall around Prolog: what each of its parts keeps out, what is said where there is none, and that it ends."""

from __future__ import annotations

import fcntl
import os
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
import warnings
from contextlib import suppress
from pathlib import Path

import pytest
from tests.logic.test_session import timeline

from prolepsis.cli import main
from prolepsis.log.timeline import Timeline
from prolepsis.logic import process as processes
from prolepsis.logic.confinement import Walls, offered, system_calls
from prolepsis.logic.process import PrologProcess
from prolepsis.logic.process_folder import new_folder
from prolepsis.logic.session import Session
from prolepsis.terms.errors import MissingToolError, Note

READ = "catch((read_file_to_string('{}', S, []), string_concat(\"read \", S, Reply)), _, Reply = closed)"
CONNECT = (
    "catch(catch(( \\+ \\+ (socket:tcp_socket(S), socket:tcp_connect(S, localhost:1)), Reply = open ),"
    " error(socket_error(econnrefused, _), _), Reply = reached), _, Reply = closed)"
)


def touched(process: PrologProcess, file: Path) -> bool:
    process.call(f"ignore(catch(shell('/usr/bin/touch {file}'), _, true)), Reply = ok", 10.0)
    process.call(f"catch(\\+ \\+ (open('{file}', append, S), close(S)), _, true), Reply = ok", 10.0)
    return file.exists()


@pytest.mark.skipif(not offered().landlock, reason="this kernel has no Landlock")
def test_confined_prolog_runs_no_program_reads_no_file_and_has_no_network(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("a secret")
    process = PrologProcess()
    try:
        assert not touched(process, tmp_path / "mark")
        assert process.call(READ.format(tmp_path / "secret"), 10.0) == "closed"
        assert process.call(CONNECT, 10.0) == "closed"
        assert process.call("(getenv('PATH', P) -> Reply = P ; Reply = none)", 10.0) == "/nonexistent"
    finally:
        process.close()


def test_without_walls_it_could_do_all_of_that(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "secret").write_text("a secret")
    monkeypatch.setattr(processes, "offered", Walls)
    with pytest.warns(Note, match="Prolog is not confined; only the check of each goal protects: files can be read"):
        process = PrologProcess()
    try:
        assert touched(process, tmp_path / "mark")
        assert process.call(READ.format(tmp_path / "secret"), 10.0) == "read a secret"
        assert process.call(CONNECT, 10.0) == "reached"
    finally:
        process.close()


@pytest.mark.skipif(not system_calls.can_filter(), reason="this kernel filters no system calls")
def test_the_filter_alone_keeps_from_programs_writing_and_the_network(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(processes, "offered", lambda: Walls(calls=True))
    with pytest.warns(Note, match="programs and the network are out of reach, but files can be read"):
        process = PrologProcess()
    try:
        assert not touched(process, tmp_path / "mark")
        assert process.call(CONNECT, 10.0) == "closed"
    finally:
        process.close()


@pytest.mark.skipif(shutil.which("bwrap") is None, reason="bubblewrap is not installed")
def test_bubblewrap_stands_in_for_landlock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "secret").write_text("a secret")
    walls = Walls(bubblewrap=shutil.which("bwrap"), calls=system_calls.can_filter())
    assert walls.missing == ""
    monkeypatch.setattr(processes, "offered", lambda: walls)
    process = PrologProcess()
    try:
        assert not touched(process, tmp_path / "mark")
        assert process.call(READ.format(tmp_path / "secret"), 10.0) == "closed"
        assert process.call(CONNECT, 10.0) == "closed"
    finally:
        process.close()
    session = Session()
    assert session.ask(timeline(), "holds(broken(X), _)") == [{"X": "egg1"}]
    session.close()


def test_a_wall_that_must_stand_and_cannot_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "offered", Walls)
    monkeypatch.setenv("PROLEPSIS_REQUIRE_CONFINEMENT", "1")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(MissingToolError, match="Prolog cannot be confined, as required: files can be read"):
        Session().ask(timeline(), "true")
    assert list(tmp_path.iterdir()) == []


def test_a_wall_that_does_not_hold_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def pretended() -> Walls:
        return Walls(landlock=0, calls=True, bubblewrap=None)

    monkeypatch.setattr(Walls, "missing", property(lambda _: ""))
    monkeypatch.setattr(processes, "offered", pretended)
    with pytest.warns(Note, match="it reads files in spite of its walls"):
        PrologProcess().close()


def test_prolog_that_cannot_start_within_its_walls_starts_without_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    real = processes.command

    def narrow(program: str, arguments: list[str], **given: object) -> list[str]:
        walls = given["walls"]
        assert isinstance(walls, Walls)
        return ["false"] if walls.landlock else real(program, arguments, **given)  # type: ignore[arg-type]

    monkeypatch.setattr(processes, "command", narrow)
    monkeypatch.setattr(processes, "offered", lambda: Walls(landlock=1, calls=True))
    with pytest.warns(Note, match="it does not start within Landlock 1 and a filter of system calls"):
        PrologProcess().close()


def egg(folder: str) -> Timeline:
    return timeline()


def test_the_command_line_can_require_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(processes, "offered", Walls)
    monkeypatch.setenv("PROLEPSIS_REQUIRE_CONFINEMENT", "")
    monkeypatch.setattr("prolepsis.logic.session.shared_session", Session)
    monkeypatch.setattr("prolepsis.log.saved.read_timeline", egg)
    assert main(["ask", str(tmp_path), "holds(broken(X), _)", "--require-confinement"]) == 2
    assert "Prolog cannot be confined, as required" in capsys.readouterr().err
    monkeypatch.setenv("PROLEPSIS_REQUIRE_CONFINEMENT", "")
    assert main(["ask", str(tmp_path), "holds(broken(X), _)"]) == 0
    said = capsys.readouterr()
    assert said.out == "X = egg1\n"
    assert said.err.startswith("prolepsis: note: Prolog is not confined") and said.err.count("\n") == 1


def test_a_lower_memory_limit_of_the_shell_stays() -> None:
    code = "from tests.logic.test_session import timeline; print(timeline().ask('holds(broken(X), _)'))"

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))

    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, preexec_fn=limit, check=False)
    assert (done.stdout, done.stderr) == ("[{'X': 'egg1'}]\n", "")


@pytest.mark.parametrize("end", ["killed", "left", "forked and left"])
def test_prolog_ends_with_the_program_however_that_ends(end: str) -> None:
    ends = {
        "killed": "os.kill(os.getpid(), 9)",
        "left": "os._exit(0)",
        "forked and left": "os._exit(0) if os.fork() else time.sleep(600)",
    }
    code = (
        "import os, time; from prolepsis.logic.process import PrologProcess\n"
        f"process = PrologProcess(); print(process.process_id, flush=True)\n{ends[end]}"
    )
    if end == "forked and left":  # The child lets go of what it has of the session, and lives on.
        code = code.replace("PrologProcess()", "session._running()").replace(
            "from prolepsis.logic.process import PrologProcess",
            "from prolepsis.logic.session import Session; session = Session()",
        )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, start_new_session=True) as program:
        assert program.stdout is not None
        number = int(program.stdout.readline())
        program.wait()
        try:
            for _ in range(1000):
                if not _runs(number):
                    break
                time.sleep(0.01)
            assert not _runs(number)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(program.pid, signal.SIGKILL)


def _runs(number: int) -> bool:
    try:
        status = Path(f"/proc/{number}/stat").read_text()
    except OSError:
        return False
    return status.rpartition(")")[2].split()[0] != "Z"


def test_prolog_ends_with_the_program_while_it_is_busy() -> None:
    code = (
        "from prolepsis.logic.process import PrologProcess\n"
        "process = PrologProcess(); print(process.process_id, flush=True)\n"
        "process.call('findall(X, between(1, 99999999, X), L), length(L, Reply)', 600.0)"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as program:
        assert program.stdout is not None
        number = int(program.stdout.readline())
        time.sleep(0.5)
        program.kill()
    for _ in range(1000):
        if not _runs(number):
            break
        time.sleep(0.01)
    assert not _runs(number)


def test_prolog_outlives_the_thread_that_asked_first() -> None:
    session, egg = Session(), timeline()
    thread = threading.Thread(target=session.ask, args=(egg, "true"))
    thread.start()
    thread.join()
    process = session._process  # pyright: ignore[reportPrivateUsage]
    time.sleep(0.2)
    assert session.ask(egg, "holds(broken(X), _)") == [{"X": "egg1"}]
    assert session._process is process  # pyright: ignore[reportPrivateUsage]
    session.close()


def test_folders_of_killed_programs_are_cleaned_by_the_next() -> None:
    code = (
        "import os; from prolepsis.logic.process import PrologProcess\n"
        "process = PrologProcess(); print(process.folder, flush=True); os.kill(os.getpid(), 9)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    folder = Path(done.stdout.strip())
    assert folder.is_dir()
    living = PrologProcess()
    PrologProcess().close()
    assert not folder.exists() and living.folder.exists()
    living.close()
    assert not living.folder.exists()


def test_a_new_folder_is_not_cleaned_by_another_that_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    lock_of = fcntl.flock
    cleaned: list[int] = []

    def flock(descriptor: int, how: int) -> None:
        if how == fcntl.LOCK_EX and not cleaned:
            # Another begins between the making of the folder and its lock.
            cleaned.append(descriptor)
            other, lock = new_folder()
            shutil.rmtree(other)
            os.close(lock)
        lock_of(descriptor, how)

    monkeypatch.setattr(fcntl, "flock", flock)
    folder, lock = new_folder()
    assert cleaned and folder.is_dir()
    shutil.rmtree(folder)
    os.close(lock)


@pytest.mark.parametrize("way", ["os.fork", "multiprocessing"])
def test_a_forked_child_asks_for_itself(way: str) -> None:
    code = f"""
import os, sys, threading, multiprocessing
from prolepsis.log.timeline import Timeline
from tests.logic.test_session import timeline
from prolepsis.logic.session import shared_session
egg = timeline()
egg.ask("true")
shared_session()._lock.acquire()  # As when another thread is just asking.

def ask():
    print("child", egg.ask("holds(broken(X), _)"), flush=True)

if "{way}" == "os.fork":
    child = os.fork()
    if not child:
        ask()
        sys.exit(0)
    os.waitpid(child, 0)
else:
    child = multiprocessing.get_context("fork").Process(target=ask)
    child.start()
    child.join()
print("parent", egg.ask("holds(broken(X), _)"))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout == "child [{'X': 'egg1'}]\nparent [{'X': 'egg1'}]\n", done.stderr


@pytest.mark.parametrize(
    ("script", "message"),
    [
        ("exit 1", "does not start as SWI-Prolog does: it tells no socket"),
        ("echo broken >&2; exit 1", "does not start as SWI-Prolog does: broken"),
        ("echo rubbish; echo more; sleep 60", "does not start as SWI-Prolog does"),
        ("exec yes", "does not start as SWI-Prolog does"),
    ],
)
def test_a_broken_swipl_is_told_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str, message: str
) -> None:
    program = tmp_path / "swipl"
    program.write_text(f"#!/bin/sh\nPATH=/usr/bin:/bin\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(processes, "offered", Walls)
    with pytest.raises(MissingToolError, match=message) as refused:
        PrologProcess()
    assert "\n" not in str(refused.value)


def test_a_long_folder_for_temporary_files_is_passed_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    long = tmp_path / ("x" * 100)
    long.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(long))
    process = PrologProcess()
    assert not str(process.folder).startswith(str(long))
    process.close()


def test_an_older_prolog_is_told_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = shutil.copytree(processes.PROLOG_FILES, tmp_path / "prolog")
    main = files / "main.pl"
    main.write_text(main.read_text().replace(">= 90004", ">= 9900004"))
    monkeypatch.setattr(processes, "PROLOG_FILES", files)
    with pytest.raises(MissingToolError, match=r"version 9\.0\.4 or newer is needed"):
        PrologProcess()


def test_a_script_in_the_place_of_swipl_leads_to_what_it_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = tmp_path / "swipl"
    script.write_text(f'#!/bin/sh\nexec {shutil.which("swipl")} "$@"\n')
    script.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        PrologProcess().close()


def test_what_cannot_be_started_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(*words: object, **given: object) -> list[str]:
        return ["/nonexistent/python"]

    monkeypatch.setattr(processes, "command", absent)
    with pytest.raises(MissingToolError, match="cannot be started: No such file"):
        PrologProcess()


def test_a_program_with_python_built_in_finds_another_for_the_launcher(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "")
    PrologProcess().close()

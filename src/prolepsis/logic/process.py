"""One SWI-Prolog process behind a unix domain socket, confined, and the connections to it.

This is the one place that knows ``swiplserver``, which has no types of its own. The process is started here, not by
that library: so it stands within its walls, no thread of this program waits for it, and it ends with this program,
however that ends, since then its standard input is closed.
"""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportPrivateUsage=false

from __future__ import annotations

import json
import multiprocessing.util
import os
import queue
import select
import shutil
import socket
import subprocess
import tempfile
import threading
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any, cast

from swiplserver import PrologError, PrologLaunchError, PrologMQI, PrologThread

from prolepsis.logic.confinement import Walls, command, offered
from prolepsis.logic.process_folder import new_folder
from prolepsis.logic.saved_state import saved_state
from prolepsis.terms.errors import InputError, MissingToolError, Note, brief
from prolepsis.terms.terms import format_atom

PROLOG_FILES = Path(__file__).parent / "prolog"
STACK_LIMIT = 256
"""Memory that one query may use for terms [MB]."""
PROCESS_LIMIT = 4 << 30
"""Address space of the whole process [bytes]: what findall/3 collects is not on the stacks."""
START_LIMIT = 60.0
"""Longest time for starting [s]; it takes a quarter of a second."""
SCRIPT_LIMIT = 10.0
"""Longest time in which a script in its place tells what it starts [s]."""
LISTENS_AFTER = 0.02
"""Time from which on Prolog listens, mostly, after it has told its socket [s]."""
RECEIVING_LIMIT = 5.0
"""Longest time for receiving an answer that is there [s]: tens of megabytes."""
REQUIRE_CONFINEMENT = "PROLEPSIS_REQUIRE_CONFINEMENT"
"""Environment variable that refuses to ask where Prolog cannot be confined."""
NO_SWIPL = "SWI-Prolog is not installed (no 'swipl' on PATH): sudo apt install swi-prolog-nox"
STATE = "state"
"""Saved state in the folder for the socket."""


class ProcessLost(Exception):
    """The Prolog process died or did not answer in time."""


class _Connection(PrologThread):
    """A connection that notices when the process is gone: the library's own would wait for ever."""

    deadline = float("inf")

    def _receive(self) -> str:
        stream = cast(socket.socket, self._socket)
        received = bytearray()
        while True:
            header = received.lstrip(b".")  # dots are signs of life
            digits, found, body = bytes(header).partition(b".\n")
            if not found:
                digits, found, body = bytes(header).partition(b"\n")
            if found:
                break
            received += self._more(stream)
        self.deadline += RECEIVING_LIMIT
        message = bytearray(body)
        while len(message) < int(digits):
            message += self._more(stream)
        return message.decode()

    def _more(self, stream: socket.socket) -> bytes:
        left = self.deadline - time.monotonic()
        if left <= 0:
            raise ProcessLost("time")
        stream.settimeout(min(left, 3600.0))
        try:
            data = stream.recv(1 << 16)
        except TimeoutError as error:
            raise ProcessLost("time") from error
        if not data:
            raise ProcessLost("gone")
        return data

    def abandon(self) -> None:
        """Close the socket without a word to the process."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None


class PrologProcess:
    """A running Prolog with our modules loaded. It keeps no facts that Python does not have, too."""

    def __init__(self) -> None:
        """Start it, confined as well as this system can.

        Raises:
            MissingToolError: If there is no SWI-Prolog, it does not start, or it cannot be confined and must be.
        """
        program = _program()
        self.died = False
        """Whether it had ended before it was ended here."""
        self.folder, self._lock = new_folder()
        self._idle: list[_Connection] = []
        try:
            self._start(program)
        except BaseException:
            self._remove()
            raise
        # Not atexit, without which a child ends that multiprocessing forked.
        self._finalizer = multiprocessing.util.Finalize(None, self.close, exitpriority=0)

    def _start(self, program: str) -> None:
        walls = offered()
        missing = walls.missing
        # A system whose libraries stand elsewhere than the walls let be read starts with fewer.
        state = saved_state(program, PROLOG_FILES, STACK_LIMIT, self.folder)
        for fewer in (walls, Walls(calls=walls.calls), Walls()):
            try:
                self._launch_from(program, fewer, state)
                break
            except MissingToolError as error:
                if _must_be_confined():
                    raise MissingToolError(f"Prolog cannot be confined, as required: {error}") from None
                if fewer == Walls():
                    raise
                missing = missing or f"it does not start within {walls}: {brief(error, 100)}"
        missing = missing or self._hole()
        if missing and _must_be_confined():
            self._end()
            raise MissingToolError(f"Prolog cannot be confined, as required: {missing}")
        if missing:
            warnings.warn(f"Prolog is not confined; only the check of each goal protects: {missing}", Note, 2)

    def _launch_from(self, program: str, walls: Walls, state: bytes | None) -> None:
        """Start it from a saved state, or from its files where there is none or it does not start from that."""
        files = [
            "-O",
            f"--stack-limit={STACK_LIMIT}m",
            "-s",
            str(PROLOG_FILES / "main.pl"),
            "-g",
            "serve",
            "-t",
            "halt",
        ]
        if state is not None:
            saved = self.folder / STATE
            try:
                saved.write_bytes(state)
                self._launch(program, walls, ["-x", str(saved)])
                return
            except (MissingToolError, OSError):
                # Half of it may fill the disk.
                saved.unlink(missing_ok=True)
        self._launch(program, walls, files)

    def _launch(self, program: str, walls: Walls, start: Sequence[str]) -> None:
        arguments = [
            *start,
            "-f",
            "none",
            "--quiet",
            "--",
            "--write_connection_values=true",
            "--pending_connections=64",
        ]
        arguments += [f"--unix_domain_socket={PrologMQI.unix_domain_socket_file(str(self.folder))}"]
        words = command(program, arguments, walls=walls, folder=self.folder, code=PROLOG_FILES, memory=PROCESS_LIMIT)
        with tempfile.TemporaryFile() as said:
            try:
                self._process, self._ended = _started(words, said)
            except OSError as error:
                raise MissingToolError(f"{program} cannot be started: {error.strerror}") from None
            try:
                path, password = _lines(cast(IO[bytes], self._process.stdout), 2, time.monotonic() + START_LIMIT)
                server: Any = PrologMQI(launch_mqi=False, unix_domain_socket=path, password=password)
                self._server = server
                # Prolog tells its socket just before it listens, and the library waits a second for a second try.
                time.sleep(LISTENS_AFTER)
                self.call("Reply = ok", START_LIMIT)
            except (ProcessLost, PrologLaunchError, OSError, ValueError) as error:
                self._end()
                said.seek(0)
                why = " ".join(said.read(2000).decode(errors="replace").split()) or str(error)
                raise MissingToolError(f"{program} does not start as SWI-Prolog does: {brief(why, 120)}") from None

    def _hole(self) -> str:
        """Try the walls: return what can be reached, empty if a file of this user's cannot be."""
        with tempfile.NamedTemporaryFile(dir=self.folder.parent, prefix="prolepsis-wall-") as file:
            path = format_atom(file.name)
            goal = (
                f"( \\+ catch((open({path}, read, S), close(S)), error(_, _), fail) -> Reply = closed ; Reply = open )"
            )
            return "it reads files in spite of its walls" if self.call(goal, START_LIMIT) == "open" else ""

    @property
    def process_id(self) -> int:
        """Process number of SWI-Prolog."""
        return self._process.pid

    def call(self, goal: str, seconds: float) -> str:
        """Run ``goal``, which binds ``Reply`` to a string, and return that string.

        Safe to call from several threads at once: each call has a connection to itself.

        Raises:
            ProcessLost: If the process died, or did not answer in ``seconds``.
            InputError: If the goal raised an error.
        """
        try:
            connection = self._idle.pop()
        except IndexError:
            connection = _Connection(self._server)
        connection.deadline = time.monotonic() + seconds
        try:
            result = cast(Any, connection.query(goal))
        except (OSError, json.JSONDecodeError) as error:
            raise ProcessLost("gone") from error
        except PrologError as error:
            self._idle.append(connection)
            raise InputError(str(error)) from error
        except BaseException:  # such as Ctrl-C: what comes next on this connection is the answer to this goal
            connection.abandon()
            raise
        self._idle.append(connection)
        return result[0]["Reply"]

    def close(self) -> None:
        """End the process and remove its folder."""
        self._finalizer.cancel()
        self._end()
        self._remove()

    def leave_to_parent(self) -> None:
        """In a forked child: close this program's ends of what leads to the process, which is the parent's."""
        self._close_ends()
        os.close(self._lock)
        self._process.returncode = 0  # Else it is waited for when it is forgotten.

    def _end(self) -> None:
        self._close_ends()
        self.died = self.died or self._process.poll() is not None
        self._process.kill()
        self._process.wait()
        self._ended.set()

    def _remove(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)
        if self._lock >= 0:
            os.close(self._lock)
            self._lock = -1

    def _close_ends(self) -> None:
        for connection in self._idle:
            connection.abandon()
        self._idle.clear()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()


def _started(words: list[str], said: IO[bytes]) -> tuple[subprocess.Popen[bytes], threading.Event]:
    """Start a process that is killed when this program ends, and return it with the event that is set when it ended.

    The system kills it when the *thread* that started it ends. So one of its own does, which waits for the event.
    """
    made: queue.SimpleQueue[subprocess.Popen[bytes] | OSError] = queue.SimpleQueue()
    ended = threading.Event()

    def start() -> None:
        try:
            process = subprocess.Popen(
                words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=said, start_new_session=True
            )
        except OSError as error:
            made.put(error)
            return
        made.put(process)
        ended.wait()

    threading.Thread(target=start, name="prolepsis-prolog", daemon=True).start()
    process = made.get()
    if isinstance(process, OSError):
        raise process
    return process, ended


def _must_be_confined() -> bool:
    return os.environ.get(REQUIRE_CONFINEMENT, "") not in ("", "0")


def _program() -> str:
    """Return the path of SWI-Prolog itself: what stands on PATH may be a script, which no wall lets start another."""
    program = shutil.which("swipl")
    if program is None:
        raise MissingToolError(NO_SWIPL)
    program = os.path.abspath(program)
    try:
        with open(program, "rb") as file:
            is_script = file.read(2) == b"#!"
    except OSError:
        is_script = False
    if not is_script:
        return program
    asked = [program, "-f", "none", "-g", "current_prolog_flag(executable, E), print(E), nl", "-t", "halt"]
    try:
        with subprocess.Popen(
            asked, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        ) as asks:
            try:
                (told,) = _lines(cast(IO[bytes], asks.stdout), 1, time.monotonic() + SCRIPT_LIMIT)
            finally:
                asks.kill()
    except (OSError, ValueError, ProcessLost):
        return program
    own = told.strip("'")
    return own if os.access(own, os.X_OK) else program


def _lines(stream: IO[bytes], count: int, deadline: float) -> list[str]:
    """Return the first lines that a program writes.

    Raises:
        ProcessLost: If it does not write as many until the deadline, or far more.
        ValueError: If they are no text.
    """
    said = b""
    while said.count(b"\n") < count:
        left = deadline - time.monotonic()
        if left <= 0 or not select.select([stream], [], [], left)[0]:
            raise ProcessLost("it tells no socket in time")
        data = os.read(stream.fileno(), 4096)
        if not data or len(said) > 10_000:
            raise ProcessLost("it tells no socket")
        said += data
    return said.decode().split("\n")[:count]

"""One SWI-Prolog process behind a unix domain socket, and the connections to it.

This is the one place that knows ``swiplserver``, which has no types of its own.
"""

# pyright: reportMissingTypeStubs=false, reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportPrivateUsage=false

from __future__ import annotations

import json
import os
import resource
import shutil
import socket
import tempfile
import time
from pathlib import Path
from typing import Any, cast

from swiplserver import PrologError, PrologMQI, PrologThread

from prolepsis.errors import InputError, MissingToolError

PROLOG_FILES = Path(__file__).parent / "prolog"
STACK_LIMIT = 256
"""Memory that one query may use for terms [MB]."""
PROCESS_LIMIT = 4 << 30
"""Address space of the whole process [bytes]: what findall/3 collects is not on the stacks."""
NO_SWIPL = "SWI-Prolog is not installed (no 'swipl' on PATH): sudo apt install swi-prolog-nox"


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


class PrologProcess:
    """A running Prolog with our modules loaded. It keeps no facts that Python does not have, too."""

    def __init__(self) -> None:
        if shutil.which("swipl") is None:
            raise MissingToolError(NO_SWIPL)
        self.owner = os.getpid()
        self.folder = Path(tempfile.mkdtemp(prefix="prolepsis-"))
        self._idle: list[_Connection] = []
        self._server: Any = PrologMQI(
            unix_domain_socket=PrologMQI.unix_domain_socket_file(str(self.folder)),
            pending_connection_count=64,
            prolog_path_args=["-f", "none", "-O", f"--stack-limit={STACK_LIMIT}m", "-s", str(PROLOG_FILES / "main.pl")],
        )
        self._server.start()
        resource.prlimit(self.process_id, resource.RLIMIT_AS, (PROCESS_LIMIT, PROCESS_LIMIT))

    @property
    def process_id(self) -> int:
        """Process number of SWI-Prolog."""
        return self._server.process_id()

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
        self._idle.append(connection)
        return result[0]["Reply"]

    def close(self) -> None:
        """End the process and remove its folder. In a forked child, leave both to the parent."""
        if self.owner != os.getpid():
            return
        for connection in self._idle:
            if connection._socket is not None:
                connection._socket.close()
        self._idle.clear()
        self._server._process.kill()
        self._server._process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

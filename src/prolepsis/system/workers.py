"""Processes that work for this one: each has nothing of what is open here, and one that dies takes only its task along.

A worker is a fresh interpreter, not a fork and not a copy of the user's script. It ends when this process does, however
that ends, and Ctrl-C at the terminal does not reach it: this process decides.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import traceback
from collections import deque
from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, Pipe, wait
from typing import Any

_START = "import sys; from prolepsis.system.workers import serve; serve(int(sys.argv[1]), int(sys.argv[2]))"
_END_WITH_PARENT = 1
"""PR_SET_PDEATHSIG of Linux."""

Task = Callable[..., Any]


@dataclass(frozen=True, kw_only=True, slots=True)
class Lost:
    """What takes the place of a result: the task ended its worker, or failed in a way that nobody foresaw."""

    reason: str
    """In a few words."""
    trace: str = ""
    """Where it failed, as Python tells it."""


class Worker:
    """One process that carries out tasks, one after the other."""

    def __init__(self) -> None:
        """Start it."""
        self.here, there = Pipe()
        # The user's own script may have told Python where to look.
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        with there:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-c", _START, str(there.fileno()), str(os.getpid())],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                pass_fds=(there.fileno(),),
                process_group=0,
                env=environment,
            )

    def send(self, task: Task, arguments: Sequence[Any]) -> None:
        """Hand it a task, a function that can be imported, with arguments that can be pickled."""
        with suppress(BrokenPipeError, ConnectionResetError):  # It is dead, as its end will say.
            self.here.send((task, tuple(arguments)))

    def result(self) -> Any:
        """Return the result of its task.

        Raises:
            EOFError: If it died.
        """
        try:
            return self.here.recv()
        except OSError:  # in the middle of a word
            raise EOFError from None

    def end(self) -> str:
        """End it, with all that it has started, and return how it ended if it has already."""
        code = self._process.poll()
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self.here.close()
        code = self._process.returncode if code is None else code
        return f"was killed by {signal.Signals(-code).name}" if code < 0 else f"ended with exit status {code}"


def carry_out(task: Task, tasks: Sequence[Sequence[Any]], workers: int) -> Generator[tuple[int, Any]]:
    """Yield the number and the result of each call of ``task`` as they come, from several processes.

    A call whose process dies is made once more when all others are done, with no other beside it: memory may have been
    short. If that dies too its result is ``Lost``, as is that of a call that raises.

    Args:
        task: A function that can be imported.
        tasks: The arguments of each call.
        workers: Number of processes.
    """
    waiting, again = deque(range(len(tasks))), deque[int]()
    at_work: dict[Connection, tuple[Worker, int]] = {}
    try:
        while waiting or at_work:
            while waiting and len(at_work) < workers:
                _give(Worker(), waiting.popleft(), task, tasks, at_work)
            for ready in wait(list(at_work)):
                worker, number = at_work.pop(ready)  # pyright: ignore[reportArgumentType]
                try:
                    found = worker.result()
                except EOFError:
                    worker.end()
                    again.append(number)
                    continue
                if waiting:
                    _give(worker, waiting.popleft(), task, tasks, at_work)
                else:
                    worker.end()
                yield number, found
        for number in again:
            _give(worker := Worker(), number, task, tasks, at_work)
            try:
                found = worker.result()
            except EOFError:
                found = Lost(reason=f"its process {worker.end()}, also when tried once more alone")
            worker.end()
            at_work.clear()
            yield number, found
    finally:
        for worker, _ in at_work.values():
            worker.end()


def _give(
    worker: Worker,
    number: int,
    task: Task,
    tasks: Sequence[Sequence[Any]],
    at_work: dict[Connection, tuple[Worker, int]],
) -> None:
    at_work[worker.here] = worker, number
    worker.send(task, tasks[number])


def serve(number: int, parent: int) -> None:
    """Carry out what comes through the connection with a file's ``number``, until it or the ``parent`` ends."""
    ctypes.CDLL(None).prctl(_END_WITH_PARENT, signal.SIGKILL)
    if os.getppid() != parent:
        return
    with Connection(number) as parents:
        while True:
            try:
                task, arguments = parents.recv()
            except (EOFError, ConnectionResetError):
                return
            try:
                found = task(*arguments)
            except Exception as error:
                found = Lost(
                    reason=f"unexpected failure: {type(error).__name__}: {error}", trace=traceback.format_exc()
                )
            parents.send(found)

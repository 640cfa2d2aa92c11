"""The command line: it runs a command, and says in one line and an exit status what became of it.

Everything else is imported within ``main``, so that an interruption while it loads is told like any other.
"""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any, TextIO

ANSWERED, NO, BAD_INPUT, INVALID, UNEXPECTED = 0, 1, 2, 3, 4
INTERRUPTED = 130
"""As shells report a process that was ended by Ctrl-C."""
TRACEBACK = "--traceback"
"""Option of every command, before it or after it."""
LEAST_MEMORY = 512
"""Address space without which numerical libraries end the process as they are loaded [MB]."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status; ``arguments`` are those of the process if None."""
    given = sys.argv[1:] if arguments is None else arguments
    try:
        if arguments is None:
            import gc
            import signal

            signal.signal(signal.SIGINT, _interrupt)
            # MuJoCo would start a process to look for a window system; what draws opens OpenGL by itself.
            os.environ.setdefault("MUJOCO_GL", "off")
            # Hardly anything here is garbage; to look for it seldom saves about a fiftieth of a run.
            gc.set_threshold(100_000, 20, 20)
        status = _answer(given)
    except KeyboardInterrupt:
        status = _tell("interrupted; nothing was written", INTERRUPTED)
    if arguments is None:
        # All is said, and another Ctrl-C would only show how Python takes itself apart.
        import signal

        signal.signal(signal.SIGINT, signal.SIG_IGN)
    return status


class _Interrupted(KeyboardInterrupt):
    """Ctrl-C. With KeyboardInterrupt itself, Python may end by the signal instead of with our status."""

    happened = False


def _interrupt(number: int, frame: object) -> None:
    del number, frame
    _Interrupted.happened = True
    raise _Interrupted


def _answer(given: Sequence[str]) -> int:
    """Run a command with a standard output that may fail."""
    stream = _standard_output()
    if stream is None:
        return _tell("standard output is closed, so there is nowhere to answer", BAD_INPUT)
    sys.stdout = output = _Output(stream)
    try:
        status = _run(given)
    except SystemExit:  # The parser has shown the help, or refused the command line.
        if output.problem_at_end() is None:
            raise
        status = ANSWERED
    finally:
        sys.stdout = stream
    problem = output.problem_at_end()
    return status if problem is None else _tell(f"standard output: {problem.strerror}", BAD_INPUT)


def _run(given: Sequence[str]) -> int:
    traced = TRACEBACK in given
    try:
        from prolepsis.commands.output import notes_told
        from prolepsis.commands.parser import parser

        read = parser().parse_args(given)
        traced = read.traceback
        if (room := _memory()) < LEAST_MEMORY:
            return _tell(f"{room} MB of memory are allowed (ulimit -v); needed: {LEAST_MEMORY} MB", BAD_INPUT)
        with notes_told():
            return read.run(read)
    except (KeyboardInterrupt, SystemExit, GeneratorExit):
        raise
    except BaseException as error:  # Rust's panics, for one, are no Exception.
        if _Interrupted.happened:
            # A library that was being loaded has made an error of its own of it.
            raise _Interrupted from error
        return _refuse(error, traced)


def _memory() -> float:
    """Return how much memory may be addressed [MB]."""
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return float("inf") if limit == resource.RLIM_INFINITY else limit >> 20


def _refuse(error: BaseException, traced: bool) -> int:
    """Say what is wrong, and return the exit status that says whose matter it is."""
    from prolepsis.terms.errors import InputError, InvalidSimulationError, MissingToolError

    match error:
        case InvalidSimulationError():
            return _tell(error, INVALID)
        case InputError() | MissingToolError():
            return _tell(error, BAD_INPUT)
        case OSError(strerror=str(reason)) if not isinstance(error, BrokenPipeError):
            names = [os.fsdecode(name) for name in (error.filename, error.filename2) if isinstance(name, str | bytes)]
            return _tell(": ".join([*names, reason]), BAD_INPUT)
        case _ if _memory() < float("inf") and (isinstance(error, MemoryError) or "allocate memory" in str(error)):
            # MuJoCo has words of its own for it. Without a limit, whoever asks for too much is at fault.
            return _tell("memory ran short: allow more of it (ulimit -v), or make the scenario smaller", BAD_INPUT)
        case _:
            return _fail(error, traced)


def _fail(error: BaseException, traced: bool) -> int:
    """Tell of an error that nobody foresaw."""
    if traced:
        import traceback

        traceback.print_exception(error)
        return UNEXPECTED
    from prolepsis.terms.errors import error_line

    words = f"{type(error).__name__}: {error_line(error, 160)}".removesuffix(": ")
    return _tell(f"unexpected failure: {words}; the same command with {TRACEBACK} shows where", UNEXPECTED)


def _tell(error: object, status: int) -> int:
    from prolepsis.terms.errors import error_line

    line = f"prolepsis: {error}"
    if encoding := getattr(sys.stderr, "encoding", None):
        # What cannot be written is written longer.
        line = line.encode(encoding, "backslashreplace").decode(encoding)
    try:
        print(error_line(line), file=sys.stderr, flush=True)
    except OSError:
        # Then the status alone says it.
        _give_up(sys.stderr)
    return status


def _give_up(stream: TextIO) -> None:
    """Let a stream that cannot be written lead nowhere, or Python would complain once more when it ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


class _Output:
    """Standard output of a command: when it cannot be written the command goes on, and the reason is kept."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._problem: OSError | None = None

    def write(self, text: str) -> int:
        """Write a text."""
        try:
            self._stream.write(text)
        except OSError as problem:
            self._give_up(problem)
        return len(text)

    def flush(self) -> None:
        """Write what is left."""
        try:
            self._stream.flush()
        except OSError as problem:
            self._give_up(problem)

    def problem_at_end(self) -> OSError | None:
        """Write what is left and return what went wrong; that a reader such as `head` has gone is no problem."""
        self.flush()
        return None if isinstance(self._problem, BrokenPipeError) else self._problem

    def _give_up(self, problem: OSError) -> None:
        self._problem = self._problem or problem
        _give_up(self._stream)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def _standard_output() -> TextIO | None:
    """Return standard output if it is open; no other file takes the place of a closed stream."""
    output: TextIO | None = sys.stdout
    errors: TextIO | None = sys.stderr
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    if errors is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    if output is not None and callable(reconfigure := getattr(output, "reconfigure", None)):
        reconfigure(errors="backslashreplace")
    return output

"""Asking: one Prolog session serves the whole program, and each timeline in it is a run.

The session survives whatever a goal does: it refuses what is not permitted, stops what takes too long or
too much, and starts the process again should it die. Facts are loaded when a timeline is first asked.
"""

from __future__ import annotations

import os
import re
import threading
import weakref
from functools import lru_cache
from pathlib import Path

from prolepsis.errors import GoalError, GoalLimitError, InputError
from prolepsis.logic.process import ProcessLost, PrologProcess
from prolepsis.logic.refusals import refusal, shown
from prolepsis.logic.run_file import write_run
from prolepsis.terms import Value, format_atom, format_value, parse_term
from prolepsis.timeline import Timeline

GRACE = 5.0
"""Time beyond its limit after which a query that does not even stop is ended with its process [s]."""
LOAD_LIMIT = 600.0
"""Longest time for loading one run [s]."""
LONGEST = 86_400.0
"""Longest time limit [s]."""
LONGEST_GOAL = 20_000
"""Longest goal [characters]."""


class Session:
    """A Prolog process that is started when needed, with the runs that were asked about."""

    def __init__(self, *, chronicles: tuple[str | Path, ...] = ()) -> None:
        """Prepare a session.

        Args:
            chronicles: Prolog files with further rules ``chronicle(Event, Start-End) :- ...``.
        """
        self._chronicles = tuple(Path(file).resolve() for file in chronicles)
        self._process: PrologProcess | None = None
        self._lock = threading.RLock()
        self._alone = threading.Lock()
        self._names: dict[int, str] = {}
        self._loaded: set[str] = set()
        self._made = 0
        # Not atexit: that comes after Python has waited for swiplserver's threads, which read until Prolog ends.
        threading.Thread(target=self._close_with_the_program, name="prolepsis-session").start()

    def _close_with_the_program(self) -> None:
        threading.main_thread().join()
        self.close()

    def load(self, timeline: Timeline, *, run: str | None = None) -> str:
        """Load a timeline as a run, unless it is loaded, and return the name of the run.

        Args:
            timeline: The facts.
            run: Name by which ``in(Run, Goal)`` finds it; made up when ``None``.
        """
        try:
            return self._load(timeline, run)
        except ProcessLost:
            raise GoalLimitError(f"a run of {len(timeline.facts)} facts could not be loaded") from None

    def _load(self, timeline: Timeline, run: str | None = None) -> str:
        with self._lock:
            process = self._running()
            key = id(timeline)
            if run is not None and self._names.get(key) != run:
                self._loaded.discard(run)
                self._names[key] = run
            elif key not in self._names:
                self._made += 1
                self._names[key] = f"run{self._made}"
            name = self._names[key]
            if name not in self._loaded:
                file = process.folder / "facts.pl"
                write_run(timeline, file)
                goal = f"runs:load_run({format_atom(name)}, {format_atom(str(file))}), Reply = ok"
                try:
                    process.call(goal, LOAD_LIMIT)
                except ProcessLost:
                    self._lose(process)
                    raise
                except InputError as error:
                    self._lose(process)
                    raise InputError(f"the facts cannot be loaded, or a chronicle fails: {error}") from None
                file.unlink()
                self._loaded.add(name)
                weakref.finalize(timeline, self._forget, key, name)
            return name

    def ask(
        self, timeline: Timeline, goal: str, *, limit: int | None = None, time_limit: float = 10.0
    ) -> list[dict[str, Value]]:
        """Return the answers to ``goal`` about a timeline; see ``Timeline.ask``."""
        goal = goal.strip()
        _check_question(goal, limit, time_limit)
        try:
            reply = self._reply(timeline, goal, limit, time_limit)
        except ProcessLost as lost:
            if str(lost) == "gone":  # perhaps by no fault of ours: it is asked again, alone
                with self._alone:
                    try:
                        reply = self._reply(timeline, goal, limit, time_limit)
                    except ProcessLost:
                        raise GoalLimitError(f"memory limit reached: {shown(goal)}") from None
            else:
                raise GoalLimitError(f"time limit of {time_limit:g} s reached: {shown(goal)}") from None
        status, _, body = reply.partition("\n")
        if status != "ok":
            raise refusal(status, body, goal, time_limit, timeline)
        return _answers(body)

    def _reply(self, timeline: Timeline, goal: str, limit: int | None, time_limit: float) -> str:
        name = self._load(timeline)
        process = self._running()
        count = "inf" if limit is None else str(limit)
        seconds = format_value(float(time_limit))
        call = f"answers:ask({format_atom(name)}, {format_atom(goal)}, {count}, {seconds}, Reply)"
        try:
            return process.call(call, time_limit + GRACE)
        except ProcessLost:
            self._lose(process)
            raise

    def close(self) -> None:
        """End the process; the next question starts another."""
        with self._lock:
            if self._process is not None:
                self._lose(self._process)

    def _running(self) -> PrologProcess:
        with self._lock:
            if self._process is None or self._process.owner != os.getpid():
                self._loaded.clear()
                self._process = PrologProcess()
                for file in self._chronicles:
                    self._load_chronicles(self._process, file)
            return self._process

    def _load_chronicles(self, process: PrologProcess, file: Path) -> None:
        try:
            process.call(f"chronicles:load_chronicles({format_atom(str(file))}), Reply = ok", LOAD_LIMIT)
        except InputError as error:
            self._lose(process)
            raise InputError(f"chronicles, {file}: {error}") from None

    def _lose(self, process: PrologProcess) -> None:
        with self._lock:
            process.close()
            if self._process is process:
                self._process = None
                self._loaded.clear()

    def _forget(self, key: int, name: str) -> None:
        with self._lock:
            if self._names.get(key) == name:
                del self._names[key]
            process = self._process
            if name not in self._loaded or process is None or process.owner != os.getpid():
                return
            self._loaded.discard(name)
            try:
                process.call(f"runs:drop_run({format_atom(name)}), Reply = ok", GRACE)
            except ProcessLost:
                self._lose(process)


@lru_cache(maxsize=1)
def shared_session() -> Session:
    """Return the session of this program."""
    return Session()


def _check_question(goal: str, limit: object, time_limit: float) -> None:
    if limit is not None and (not isinstance(limit, int) or isinstance(limit, bool) or limit < 1):
        raise GoalError(f"limit: a whole number of answers, at least 1, not {limit!r}")
    if not 0 < time_limit <= LONGEST:
        raise GoalError(f"time_limit: a number of seconds above 0 and at most {LONGEST:g}, not {time_limit!r}")
    if len(goal) > LONGEST_GOAL:
        raise GoalError(f"the goal has {len(goal):,} characters; at most {LONGEST_GOAL:,} are read")
    for place, character in enumerate(goal, start=1):
        if character == "\0" or "\ud800" <= character <= "\udfff":
            raise GoalError(f"syntax error at column {place}: no character of a text: {character!r}")


_NUMBER = re.compile(r"-?[0-9]{1,18}(\.[0-9]+)?")
_NAME = re.compile(r"[a-z][A-Za-z0-9_]*")


@lru_cache(maxsize=65536)
def _value(text: str) -> Value:
    number = _NUMBER.fullmatch(text)
    if number:
        return float(text) if number.group(1) else int(text)
    if _NAME.fullmatch(text):
        return text
    try:
        return parse_term(text, where="answer")
    except (InputError, RecursionError) as error:
        raise GoalError(f"an answer that Python cannot hold (too deep, or no plain term): {text[:80]!r}") from error


def _answers(body: str) -> list[dict[str, Value]]:
    header, *rows = body.split("\n")
    names = header.split("\t") if header else []
    if not names:
        return [{} for _ in rows]
    return [dict(zip(names, map(_value, row.split("\t")), strict=True)) for row in rows]

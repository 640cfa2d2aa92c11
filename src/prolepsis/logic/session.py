"""Asking: one Prolog session serves the whole program, and each timeline in it is a run.

The session survives whatever a goal does: it refuses what is not permitted, stops what takes too long or
too much, and starts the process again should it die. Facts are loaded when a timeline is first asked.
"""

from __future__ import annotations

import difflib
import os
import threading
import weakref
from functools import lru_cache
from pathlib import Path

from prolepsis.errors import GoalError, GoalLimitError, InputError
from prolepsis.logic.process import STACK_LIMIT, ProcessLost, PrologProcess
from prolepsis.logic.run_file import write_run
from prolepsis.terms import Value, format_atom, parse_term
from prolepsis.timeline import Timeline

GRACE = 5.0
"""Time beyond its limit after which a query that does not even stop is ended with its process [s]."""
LOAD_LIMIT = 600.0
"""Longest time for loading one run [s]."""
PERMITTED = "a query only reads the timeline and computes; it may not change facts, reach files or start programs"


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
                    raise GoalLimitError(f"run {name!r} of {len(timeline.facts)} facts could not be loaded") from None
                file.unlink()
                self._loaded.add(name)
                weakref.finalize(timeline, self._forget, key, name)
            return name

    def ask(
        self, timeline: Timeline, goal: str, *, limit: int | None = None, time_limit: float = 10.0
    ) -> list[dict[str, Value]]:
        """Return the answers to ``goal`` about a timeline; see ``Timeline.ask``."""
        if limit is not None and limit < 1:
            raise GoalError(f"limit: at least 1 answer, not {limit}")
        name = self.load(timeline)
        process = self._running()
        count = "inf" if limit is None else str(limit)
        call = f"answers:ask({format_atom(name)}, {format_atom(goal)}, {count}, {time_limit}, Reply)"
        try:
            reply = process.call(call, time_limit + GRACE)
        except ProcessLost as lost:
            self._lose(process)
            if str(lost) == "time":
                raise GoalLimitError(f"time limit of {time_limit:g} s reached: {goal!r}") from None
            raise GoalLimitError(f"memory limit reached: {goal!r}") from None
        status, _, body = reply.partition("\n")
        if status != "ok":
            raise _refusal(status, body, goal, time_limit)
        return _answers(body)

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
                    self._process.call(f"load_files(chronicles:{format_atom(str(file))}, []), Reply = ok", LOAD_LIMIT)
            return self._process

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


@lru_cache(maxsize=65536)
def _value(text: str) -> Value:
    try:
        return parse_term(text, where="answer")
    except (InputError, RecursionError) as error:
        raise GoalError(f"an answer is too deep or not a term: {text[:80]!r}") from error


def _answers(body: str) -> list[dict[str, Value]]:
    header, *rows = body.split("\n")
    names = header.split("\t") if header else []
    if not names:
        return [{} for _ in rows]
    return [dict(zip(names, map(_value, row.split("\t")), strict=True)) for row in rows]


def _refusal(status: str, body: str, goal: str, time_limit: float) -> GoalError:
    """Return the error for a goal that was refused: what, where, and what is allowed."""
    match status:
        case "syntax":
            position, message = body.split("\n", 1)
            return GoalError(f"syntax error at column {int(position) + 1}: {message}: {goal!r}")
        case "predicate":
            name, known = body.split("\n", 1)
            return GoalError(f"unknown predicate {name}; {_nearest(name, known.split(chr(9)))}")
        case "relation":
            relations = "before, after, meets, met_by, overlaps, overlapped_by, starts, started_by, during, contains, "
            return GoalError(f"unknown relation {body!r}; known: {relations}finishes, finished_by, equals")
        case "permission":
            return GoalError(f"not permitted: {body}: {PERMITTED}")
        case "unbound":
            return GoalError(f"not permitted: a goal that is known only when the query runs: {goal!r}")
        case "interval":
            return GoalError(f"not an interval: {body}; an interval is Start-End, with Start before End")
        case "time":
            return GoalLimitError(f"time limit of {time_limit:g} s reached: {goal!r}")
        case "memory":
            return GoalLimitError(f"memory limit of {STACK_LIMIT} MB reached: {goal!r}")
        case _:
            return GoalError(f"{body.strip() or status}: {goal!r}")


def _nearest(name: str, known: list[str]) -> str:
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.7)
    if near:
        return f"did you mean {near[0]}?"
    return "see docs/queries.md; among others: holds/2, occurs/2, fluentT/2, eventT/2, argsOf/2, objOf/2, allen/3"

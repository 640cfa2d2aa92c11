"""Asking: one Prolog session serves the whole program, and each timeline in it is a run.

The session survives whatever a goal does: it refuses what is not permitted, stops what takes too long or
too much, and starts the process again should it die. Facts are loaded when a timeline is first asked.
"""

from __future__ import annotations

import os
import re
import threading
import time
import warnings
import weakref
from functools import lru_cache
from pathlib import Path

from prolepsis.log.timeline import Timeline
from prolepsis.logic.notes import notes
from prolepsis.logic.pasting import pasted
from prolepsis.logic.process import ProcessLost, PrologProcess
from prolepsis.logic.refusals import refusal, shown
from prolepsis.logic.rules import read_rules, rule_refusal
from prolepsis.logic.run_file import write_run
from prolepsis.terms.answers import as_answer
from prolepsis.terms.errors import GoalError, GoalLimitError, InputError, Note, brief
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Value, format_atom, format_value

LATE = 2.0
"""Time beyond its limit after which a query that does not even stop is ended with its process [s]: no limit interrupts
one step of arithmetic, as `3**1000000000` is. A busy machine tells a second late that a limit was reached."""
GRACE = 5.0
"""The same of what is no query [s]."""
LOAD_LIMIT = 600.0
"""Longest time for loading one run [s]."""
CHRONICLE_LIMIT = 10.0
"""Longest time for working out one chronicle of a user's in one run [s]."""
ALL_CHRONICLES_LIMIT = 60.0
"""Longest time for those of one file together [s]."""
LONGEST = 86_400.0
"""Longest time limit [s]."""
LONGEST_GOAL = 20_000
"""Longest goal [characters]."""


class Session:
    """A Prolog process that is started when needed, with the runs that were asked about."""

    def __init__(self, *, chronicles: tuple[str | Path, ...] = ()) -> None:
        """Prepare a session.

        Args:
            chronicles: Prolog files with further rules ``chronicle(Event, Start-End) :- ...``. They are read as data
                and checked as goals are, so that a file from anybody can be given.
        """
        self._chronicles = tuple(Path(file).resolve() for file in chronicles)
        self._process: PrologProcess | None = None
        self._lock = threading.RLock()
        self._names: dict[int, str] = {}
        self._runs: dict[str, weakref.ref[Timeline]] = {}
        self._loaded: set[str] = set()
        self._made = 0
        _sessions.add(self)

    def begin_anew(self) -> None:
        """In a forked child: leave the process to the parent. Locks may be held by threads that only the parent has."""
        self._lock = threading.RLock()
        if self._process is not None:
            self._process.leave_to_parent()
        self._process = None
        self._loaded.clear()

    def load(self, timeline: Timeline, *, run: str | None = None) -> str:
        """Load a timeline as a run, unless it is loaded, and return the name of the run.

        Args:
            timeline: The facts.
            run: Name by which ``in(Run, Goal)`` finds it, which another timeline loses; made up when ``None``.
        """
        try:
            return self._load(timeline, run)[1]
        except ProcessLost:
            raise GoalLimitError(f"a run of {len(timeline.facts)} facts could not be loaded") from None

    def _load(self, timeline: Timeline, run: str | None = None) -> tuple[PrologProcess, str]:
        with self._lock:
            name = self._name(timeline, run)
            process = self._running()
            # All that have a name: a process that died has lost them, and in/2 would find nothing.
            for each, reference in list(self._runs.items()):
                known = reference()
                if each not in self._loaded and known is not None:
                    self._load_run(process, each, known)
            return process, name

    def _name(self, timeline: Timeline, run: str | None) -> str:
        key = id(timeline)
        known = self._names.get(key)
        if known is not None and run in (None, known):
            return known
        name = run
        while name is None or (run is None and name in self._runs):
            self._made += 1
            name = f"run{self._made}"
        if known is not None:
            self._drop(known)
        if name in self._runs:
            self._names = {other: its for other, its in self._names.items() if its != name}
            self._drop(name)
        self._names[key] = name
        self._runs[name] = weakref.ref(timeline)
        weakref.finalize(timeline, self._forget, key)
        return name

    def _load_run(self, process: PrologProcess, name: str, timeline: Timeline) -> None:
        file, atom = process.folder / "facts.pl", format_atom(name)
        try:
            write_run(timeline, file)
            process.call(f"runs:load_run({atom}, {format_atom(str(file))}), Reply = ok", LOAD_LIMIT)
            file.unlink()
        except (ProcessLost, FileNotFoundError):
            self._lose(process)
            raise ProcessLost("gone") from None
        except InputError as error:
            self._lose(process)
            raise InputError(f"the facts cannot be loaded: {error}") from None
        self._add_rules(process, atom)
        try:
            process.call(f"runs:finish_run({atom}), Reply = ok", LOAD_LIMIT)
        except ProcessLost:
            self._lose(process)
            raise
        self._loaded.add(name)

    def _add_rules(self, process: PrologProcess, run: str) -> None:
        for number, file in enumerate(self._chronicles):
            goal = f"rules:add_rules_to_run({number}, {run}, {format_value(CHRONICLE_LIMIT)}, Reply)"
            self._rules_reply(process, goal, file, ALL_CHRONICLES_LIMIT)

    def _rules_reply(self, process: PrologProcess, goal: str, file: Path, seconds: float, text: str = "") -> None:
        try:
            reply = process.call(goal, seconds + GRACE)
        except ProcessLost as lost:
            self._lose(process)
            reached = f"time limit of {seconds:g} s" if str(lost) == "time" else "memory limit"
            raise GoalLimitError(f"chronicles, {file}: {reached} reached") from None
        if reply != "ok":
            self._lose(process)
            raise rule_refusal(reply, file, text=text, limit=CHRONICLE_LIMIT)

    def ask(
        self, timeline: Timeline, goal: str, *, limit: int | None = None, time_limit: float = 10.0
    ) -> list[dict[str, Value]]:
        """Return the answers to ``goal`` about a timeline; see ``Timeline.ask``."""
        if not isinstance(goal, str):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise GoalError(f"a goal is text, as 'holds(F, T)', not {brief(type(goal).__name__)}")
        goal = pasted(goal)
        _check_question(goal, limit, time_limit)
        started = time.monotonic()
        try:
            reply = self._reply(timeline, goal, limit, time_limit)
        except ProcessLost as lost:
            # Perhaps by no fault of this goal: another one was stopped, or somebody killed the process.
            left = time_limit - (time.monotonic() - started if str(lost) == "died" else 0.0)
            if str(lost) == "time" or left <= 0:
                raise GoalLimitError(f"time limit of {time_limit:g} s reached: {shown(goal)}") from None
            reply = self._reply_apart(timeline, goal, limit, left)
        first, _, body = reply.partition("\n")
        status, *open_ends = first.split("\t")
        if status not in ("ok", "cut"):
            raise refusal(status, body, goal, time_limit, timeline)
        if status == "cut":
            what = "a value is too large or too deep to be told whole; ... stands for the rest"
            warnings.warn(f"{what}: {shown(goal)}", Note, 3)
        read, denied, body = body.split("\n", 2)
        answers = _answers(body, time.monotonic() + time_limit + GRACE, goal)
        for note in notes(timeline, goal, answers, read=read, open_ends=open_ends, denied=denied):
            warnings.warn(note, Note, 3)
        return answers

    def _reply(self, timeline: Timeline, goal: str, limit: int | None, time_limit: float) -> str:
        process, name = self._load(timeline)
        count = "inf" if limit is None else str(limit)
        seconds = format_value(float(time_limit))
        call = f"answers:ask({format_atom(name)}, {format_atom(goal)}, {count}, {seconds}, Reply)"
        try:
            return process.call(call, time_limit + LATE)
        except ProcessLost as lost:
            self._lose(process)
            raise ProcessLost("died" if str(lost) == "gone" and process.died else str(lost)) from None

    def _reply_apart(self, timeline: Timeline, goal: str, limit: int | None, time_limit: float) -> str:
        """Reply from a process of its own, where nobody else's goal is stopped."""
        apart = Session(chronicles=self._chronicles)
        with self._lock:
            runs = [(name, known) for name, reference in self._runs.items() if (known := reference()) is not None]
        try:
            for name, known in runs:
                apart._name(known, name)
            return apart._reply(timeline, goal, limit, time_limit)
        except ProcessLost as lost:
            reached = f"time limit of {time_limit:g} s" if str(lost) == "time" else "memory limit"
            raise GoalLimitError(f"{reached} reached: {shown(goal)}") from None
        finally:
            apart.close()

    def close(self) -> None:
        """End the process; the next question starts another."""
        with self._lock:
            if self._process is not None:
                self._lose(self._process)

    def _running(self) -> PrologProcess:
        with self._lock:
            if self._process is None:
                self._process = PrologProcess()
                for number in range(len(self._chronicles)):
                    self._load_chronicles(self._process, number)
            return self._process

    def _load_chronicles(self, process: PrologProcess, number: int) -> None:
        from prolepsis.fluents import fact_types

        file = self._chronicles[number]
        text = read_rules(file)
        copy = process.folder / "rules.pl"
        copy.write_text(text, encoding="utf-8")
        taken = ",".join(map(format_atom, fact_types()))
        goal = f"rules:add_rules({number}, {format_atom(str(copy))}, [{taken}], {format_value(CHRONICLE_LIMIT)}, Reply)"
        self._rules_reply(process, goal, file, CHRONICLE_LIMIT, text)
        copy.unlink()

    def _lose(self, process: PrologProcess) -> None:
        with self._lock:
            process.close()
            if self._process is process:
                self._process = None
                self._loaded.clear()

    def _forget(self, key: int) -> None:
        with self._lock:
            name = self._names.pop(key, None)
            if name is not None:
                self._drop(name)

    def _drop(self, name: str) -> None:
        """Forget a run."""
        self._runs.pop(name, None)
        process = self._process
        if name not in self._loaded or process is None:
            return
        self._loaded.discard(name)
        try:
            process.call(f"runs:drop_run({format_atom(name)}), Reply = ok", GRACE)
        except ProcessLost:
            self._lose(process)


_sessions: weakref.WeakSet[Session] = weakref.WeakSet()


def _begin_anew() -> None:
    for session in list(_sessions):
        session.begin_anew()


os.register_at_fork(after_in_child=_begin_anew)


@lru_cache(maxsize=1)
def shared_session() -> Session:
    """Return the session of this program."""
    return Session()


def _check_question(goal: str, limit: object, time_limit: float) -> None:
    if limit is not None and (not isinstance(limit, int) or isinstance(limit, bool) or limit < 1):
        raise GoalError(f"limit: a whole number of answers, at least 1, not {brief(limit)}")
    if not isinstance(time_limit, int | float) or not 0 < time_limit <= LONGEST:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise GoalError(f"time_limit: a number of seconds above 0 and at most {LONGEST:g}, not {brief(time_limit)}")
    if len(goal) > LONGEST_GOAL:
        raise GoalError(f"the goal has {len(goal):,} characters; at most {LONGEST_GOAL:,} are read")
    for column, character in enumerate(goal, start=1):
        if character == "\0" or "\ud800" <= character <= "\udfff":
            raise GoalError(f"syntax error at column {column}: no character of a text: {character!r}")


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
        return as_answer(parse_term(text, where="answer"))
    except (InputError, RecursionError) as error:
        raise GoalError(f"an answer that Python cannot hold (too deep, or no plain term): {text[:80]!r}") from error


def _answers(body: str, deadline: float, goal: str) -> list[dict[str, Value]]:
    header, *rows = body.split("\n")
    names = header.split("\t") if header else []
    if not names:
        return [{} for _ in rows]
    answers: list[dict[str, Value]] = []
    for row in rows:
        if time.monotonic() > deadline:
            raise GoalLimitError(f"time limit reached while {len(rows):,} answers were read: {shown(goal)}")
        answers.append(dict(zip(names, map(_value, row.split("\t")), strict=True)))
    return answers

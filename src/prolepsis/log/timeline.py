"""A run in symbols: which fluents held and which events occurred, over which right-open intervals.

Instances are maximal: one fluent or event that goes on over successive ticks is one fact, so the pair of
term and interval names it. Times are instants of ticks, each always the same float (``terms/ticks.py``).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any, Literal, cast

from prolepsis.log.domain import Domain
from prolepsis.terms.decimals import decimal_of
from prolepsis.terms.errors import InputError, brief
from prolepsis.terms.terms import Term, Value
from prolepsis.terms.ticks import Ticks, ticks_of

Kind = Literal["fluent", "event"]
Argument = str | int | float
Evidence = Mapping[str, "float | str"]
_GREATEST, _LONGEST = 1e300, 1e15
"""What is greater is no number of a fact, and no time [s]."""
_KINDS = ("fluent", "event")
_NUMBER = r"-?[0-9]+(?:\.[0-9]+(?:e[-+]?[0-9]+)?)?"
NUMBERS = re.compile(rf"\[{_NUMBER}(?:,{_NUMBER})*\]")
"""A list of numbers as an argument has it."""
ENDS, WITH_LOG = "ends", "with the log"
"""Evidence of an event that still went on when the log ended: its end is not its own."""


def _of_a_term(argument: Argument) -> Value:
    """Return an argument as it stands in a term: a displacement is a list there, as in the plan."""
    if isinstance(argument, str) and NUMBERS.fullmatch(argument):
        return tuple(float(each) if "." in each else int(each) for each in argument[1:-1].split(","))
    return argument


def _no_evidence() -> dict[str, float | str]:
    return {}


@dataclass(frozen=True, kw_only=True, slots=True)
class Fact:
    """One fluent that held, or one event that occurred, over one interval."""

    kind: Kind
    """``"fluent"`` for a condition, ``"event"`` for what happens."""
    type: str
    """Lower camel case: ``contacts``, ``closingGripper``."""
    args: tuple[Argument, ...] = ()
    """Names of things, or numbers."""
    start: float
    """First instant [s]."""
    end: float
    """First instant no longer [s]."""
    evidence: Evidence = field(default_factory=_no_evidence)
    """Measured numbers (SI units) and names behind the fact: ``{"level": "force7", "force": 12.5}``."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        # It is also shown where it is refused, with arguments that are none.
        given: Any = self.args
        args = ",".join(map(str, cast("tuple[Any, ...]", given))) if isinstance(given, list | tuple) else given
        return f"Fact({self.kind} {self.type}({args}), {self.start}-{self.end})"

    @property
    def term(self) -> Value:
        """The fact as a term, ``contacts(hand1,egg1)``; an atom when there are no arguments."""
        return Term(self.type, tuple(map(_of_a_term, self.args))) if self.args else self.type


@dataclass(frozen=True, kw_only=True, slots=True, weakref_slot=True, eq=False)
class Timeline:
    """All facts of one run with what is known of its individuals. Made by ``make_timeline``."""

    facts: tuple[Fact, ...]
    """Maximal facts, ordered by start, end, kind, type and arguments."""
    dt: float
    """Tick of the log [s]."""
    duration: float
    """End of the run [s]."""
    domain: Domain = Domain()
    """What queries can read of the individuals."""
    near_misses: tuple[Fact, ...] = ()
    """What did not come about but nearly, ordered as facts are, over the time in which it nearly was; ``margin`` is its
    only evidence."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Timeline({len(self.facts)} facts in {self.duration:g} s)"

    def __post_init__(self) -> None:
        """Refuse what is no timeline, before it is asked.

        Raises:
            InputError: If a fact is none, or the tick or the duration is no length of time.
        """
        _refuse_no_time("dt", self.dt)
        _refuse_no_time("duration", self.duration)
        for number, fact in enumerate((*self.facts, *self.near_misses), start=1):
            _refuse_no_fact(fact, number)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Timeline):
            return NotImplemented
        mine = (self.facts, self.dt, self.duration, self.domain, self.near_misses)
        return mine == (other.facts, other.dt, other.duration, other.domain, other.near_misses)

    __hash__ = object.__hash__

    def select(self, *, type: str | None = None, kind: Kind | None = None) -> tuple[Fact, ...]:
        """Return the facts of one type (either spelling, ``Broken`` or ``broken``), of one kind, or both."""
        name = None if type is None else type[:1].lower() + type[1:]
        return tuple(f for f in self.facts if name in (None, f.type) and kind in (None, f.kind))

    def ask(self, goal: str, *, limit: int | None = None, time_limit: float = 10.0) -> list[dict[str, Value]]:
        """Return the answers to a Prolog goal: ``[]`` means no, ``[{}]`` means yes.

        Args:
            goal: One goal, such as ``holds(broken(X), T)``; see ``docs/queries.md``.
            limit: Greatest number of answers that are computed; all when ``None``.
            time_limit: Time after which the query is stopped [s].

        Returns:
            For each distinct answer, the values of the goal's variables (those beginning with ``_`` left out);
            ``json.dumps`` takes them as they are.

        Raises:
            GoalError: If the goal cannot be read, names an unknown predicate or relation, or is not permitted.
            GoalLimitError: If it used up its time or memory.
            MissingToolError: If SWI-Prolog is not installed.
        """
        from prolepsis.logic.session import shared_session

        return shared_session().ask(self, goal, limit=limit, time_limit=time_limit)

    def to_json(self) -> list[dict[str, Any]]:
        """Return the facts as plain data, one dictionary each."""
        return [plain(fact) for fact in self.facts]

    @classmethod
    def from_json(
        cls,
        rows: Iterable[Mapping[str, Any]],
        *,
        dt: float,
        duration: float,
        domain: Domain | None = None,
        near_misses: Iterable[Mapping[str, Any]] = (),
    ) -> Timeline:
        """Return the timeline of which ``rows`` are the facts, as ``to_json`` gives them, and what nearly was.

        Raises:
            InputError: If a row is not a fact.
        """
        facts = [_read_fact(row, number) for number, row in enumerate(rows, start=1)]
        missed = [_read_fact(row, number) for number, row in enumerate(near_misses, start=1)]
        return make_timeline(facts, dt=dt, duration=duration, domain=domain, near_misses=missed)


def plain(fact: Fact) -> dict[str, Any]:
    """Return a fact as plain data."""
    return {
        "kind": fact.kind,
        "type": fact.type,
        "args": list(fact.args),
        "start": fact.start,
        "end": fact.end,
        "evidence": dict(fact.evidence),
    }


def make_timeline(
    facts: Iterable[Fact],
    *,
    dt: float,
    duration: float,
    domain: Domain | None = None,
    near_misses: Iterable[Fact] = (),
) -> Timeline:
    """Return the timeline of ``facts``: sorted, maximal, and at the instants of ticks that are nearest to their times.

    A number among their arguments is the decimal that it is but for rounding. Stretches of the same fact that overlap
    or meet become one. Its evidence keeps, of a number given by several, the greatest (of one called ``_least`` the
    least), and of a name, the first. A fact within one tick is made one tick long. Of an event that goes on to the end
    of the log, evidence tells that it ends with it.

    Args:
        facts: The facts, in any order.
        dt: Tick of the log [s].
        duration: End of the run [s].
        domain: What is known of the individuals.
        near_misses: What did not come about but nearly, in any order.

    Raises:
        InputError: If a time is not finite, or a fact ends before it starts.
    """
    _refuse_no_time("dt", dt)
    _refuse_no_time("duration", duration)
    facts, missed = tuple(facts), tuple(near_misses)
    for number, fact in enumerate((*facts, *missed), start=1):
        _refuse_no_fact(fact, number)
    ticks = ticks_of(dt)
    last = ticks.snapped(duration) if duration >= dt else duration
    told = sorted((_with_its_end(fact, last) for fact in _maximal(facts, ticks)), key=_by_time)
    nearly = tuple(sorted(_maximal(missed, ticks), key=_by_time))
    return Timeline(facts=tuple(told), dt=dt, duration=last, domain=domain or Domain(), near_misses=nearly)


def _maximal(facts: Iterable[Fact], ticks: Ticks) -> Iterable[Fact]:
    ordered = sorted((_at_ticks(fact, ticks) for fact in facts), key=lambda f: (_identity(f), f.start, f.end))
    return (whole for _, same in groupby(ordered, key=_identity) for whole in _merge(same))


def _by_time(fact: Fact) -> tuple[Any, ...]:
    return fact.start, fact.end, *_identity(fact)


def _identity(fact: Fact) -> tuple[str, str, tuple[tuple[bool, Any], ...]]:
    # Numbers and names do not compare with each other, so numbers are put first.
    return fact.kind, fact.type, tuple((isinstance(a, str), a) for a in fact.args)


def _at_ticks(fact: Fact, ticks: Ticks) -> Fact:
    if not (math.isfinite(fact.start) and math.isfinite(fact.end)) or fact.end < fact.start:
        raise InputError(f"fact {fact.term}: cannot hold over {fact.start}-{fact.end}; the end must follow the start")
    start, end = ticks.snapped(fact.start), ticks.snapped(fact.end)
    if end <= start:
        end = ticks.time(ticks.number(start) + 1) if ticks.counts(start) else math.nextafter(start, math.inf)
    args = tuple(each if isinstance(each, str) else decimal_of(each) for each in fact.args)
    same = (start, end) == (fact.start, fact.end) and args == tuple(fact.args)
    return fact if same else replace(fact, start=start, end=end, args=args)


def _merge(stretches: Iterable[Fact]) -> Iterable[Fact]:
    """Yield the maximal facts of one term from its stretches in order of start."""
    whole: Fact | None = None
    for stretch in stretches:
        if whole is None or stretch.start > whole.end:
            if whole is not None:
                yield whole
            whole = stretch
        else:
            evidence = _merged_evidence(whole.evidence, stretch.evidence)
            whole = replace(whole, end=max(whole.end, stretch.end), evidence=evidence)
    if whole is not None:
        yield whole


def _merged_evidence(first: Evidence, second: Evidence) -> dict[str, float | str]:
    merged = dict(first)
    for name, value in second.items():
        known = merged.setdefault(name, value)
        if not isinstance(known, str) and not isinstance(value, str):
            merged[name] = min(known, value) if name.endswith("_least") else max(known, value)
    return merged


def _with_its_end(fact: Fact, last: float) -> Fact:
    is_open = fact.kind == "event" and fact.end >= last
    if is_open == (fact.evidence.get(ENDS) == WITH_LOG):
        return fact
    evidence = {name: value for name, value in fact.evidence.items() if (name, value) != (ENDS, WITH_LOG)}
    return replace(fact, evidence={**evidence, ENDS: WITH_LOG} if is_open else evidence)


def _read_fact(row: Any, number: int) -> Fact:
    """Return the fact that a row of plain data says.

    Raises:
        InputError: If it is none.
    """
    if not isinstance(row, Mapping):
        raise InputError(f"timeline, fact {number}: not a fact: {brief(repr(row))}")
    table = cast("Mapping[Any, Any]", row)
    kind, name, start, end = (table.get(key) for key in ("kind", "type", "start", "end"))
    args: Any = table.get("args") or ()
    evidence: Any = table.get("evidence") or {}
    if not isinstance(kind, str) or kind not in _KINDS:
        raise InputError(f"timeline, fact {number}: no kind {brief(repr(kind))}; known: fluent, event")
    if not _is_fact(name, start, end, args, evidence):
        raise InputError(f"timeline, fact {number}: not a fact: {brief(repr(table))}")
    return Fact(
        kind=kind,
        type=cast(str, name),
        args=tuple(cast("list[Argument]", args)),
        start=float(cast(float, start)),
        end=float(cast(float, end)),
        evidence=dict(cast("Mapping[str, float | str]", evidence)),
    )


def _refuse_no_time(what: str, time: Any) -> None:
    if not _is_number(time) or not 0 < time < _LONGEST:
        raise InputError(f"timeline, {what}: a time above 0 s, not {brief(time)}")


def _refuse_no_fact(fact: Any, number: int) -> None:
    if not isinstance(fact, Fact):
        raise InputError(f"timeline, fact {number}: not a fact: {brief(fact)}")
    if fact.kind not in _KINDS:
        raise InputError(f"timeline, fact {number}: no kind {brief(fact.kind)}; known: fluent, event")
    if not _is_fact(fact.type, fact.start, fact.end, fact.args, fact.evidence):
        raise InputError(f"timeline, fact {number}: not a fact: {brief(fact)}")


def _is_fact(name: object, start: object, end: object, args: object, evidence: object) -> bool:
    return (
        isinstance(name, str)
        and _is_number(start)
        and _is_number(end)
        and isinstance(args, list | tuple)
        and all(isinstance(each, str) or _is_number(each) for each in cast("list[Any]", args))
        and isinstance(evidence, Mapping)
        and all(isinstance(key, str) for key in cast("Mapping[Any, Any]", evidence))
        and all(isinstance(each, str) or _is_number(each) for each in cast("Mapping[Any, Any]", evidence).values())
    )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _GREATEST

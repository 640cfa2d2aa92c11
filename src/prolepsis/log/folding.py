"""A timeline for people: facts that differ only in which of many like things they are about, told as one.

What is alike is read off what is known of the things, never off their names: parts of one whole that belong to the same
classes (the shards of a shell, the links of a robot), and, of what is no part, things of the same classes and mass.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from prolepsis.log.domain import Domain
from prolepsis.log.near import is_near
from prolepsis.log.timeline import Argument, Fact, Kind, Timeline
from prolepsis.terms.terms import format_atom, format_value

MANY = 6
"""Like things that are told of together; up to five are told apart at a glance."""
APART = 0.5
"""Gap between facts that are not told as one [s]: what comes later is a story of its own."""
MOST_TEXTS = 3
"""Different texts of one evidence that are shown."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Told:
    """One fact, or several that are told as one."""

    kind: Kind
    """``"fluent"`` or ``"event"``."""
    what: str
    """The term; in the place of many things, how many they are and of what: ``[12 parts of eggshell1]``."""
    start: float
    """First instant of the first [s]."""
    end: float
    """First instant no longer of the last [s]."""
    evidence: str
    """In one line, numbers with four digits; of several facts how many, and from the least to the greatest."""


@dataclass(frozen=True, kw_only=True, slots=True)
class _Group:
    """Like things."""

    of: str
    """The whole that all are parts of; empty if they are no parts."""
    first: str
    """The first of them."""

    def text(self, count: int) -> str:
        return f"[{count} parts of {format_atom(self.of)}]" if self.of else f"[{count} like {format_atom(self.first)}]"


Groups = Mapping[str, _Group]
_Key = tuple[Kind, str, tuple["Argument | _Group", ...]]


def fold(facts: Iterable[Fact], domain: Domain) -> list[Told]:
    """Return facts in order of time, those about many like things as one."""
    groups = _groups(domain)
    alike: dict[_Key, list[Fact]] = {}
    for fact in facts:
        alike.setdefault((fact.kind, fact.type, tuple(_folded(each, groups) for each in fact.args)), []).append(fact)
    told: list[Told] = []
    for key, each in alike.items():
        for burst in _bursts(each):
            told += _tell(key, burst)
    return sorted(told, key=lambda row: (row.start, row.end, row.kind, row.what))


def tell(fact: Fact) -> Told:
    """Return one fact by itself."""
    evidence = ", ".join(f"{name}={_text(value)}" for name, value in fact.evidence.items()) + _near([fact])
    return Told(kind=fact.kind, what=format_value(fact.term), start=fact.start, end=fact.end, evidence=evidence)


def about(timeline: Timeline, name: str) -> frozenset[str]:
    """Return a thing and all of its parts, and theirs."""
    parts: dict[str, list[str]] = {}
    for whole, part in timeline.domain.parts:
        parts.setdefault(whole, []).append(part)
    found, waiting = {name}, [name]
    while waiting:
        new = [part for part in parts.get(waiting.pop(), ()) if part not in found]
        found.update(new)
        waiting += new
    return frozenset(found)


def _tell(key: _Key, facts: Sequence[Fact]) -> list[Told]:
    """Return the facts as one if they are about several things, else each."""
    kind, type_, pattern = key
    members: dict[_Group, set[Argument]] = {}
    for fact in facts:
        for each, argument in zip(pattern, fact.args, strict=True):
            if isinstance(each, _Group):
                members.setdefault(each, set()).add(argument)
    if len(facts) == 1 or not any(len(names) > 1 for names in members.values()):
        return [tell(fact) for fact in facts]
    args = ",".join(_shown(each, members) for each in pattern)
    start, end = min(fact.start for fact in facts), max(fact.end for fact in facts)
    evidence = ", ".join([f"facts={len(facts)}", *_ranges(facts)]) + _near(facts)
    return [Told(kind=kind, what=f"{format_atom(type_)}({args})", start=start, end=end, evidence=evidence)]


def _shown(each: Argument | _Group, members: Mapping[_Group, set[Argument]]) -> str:
    if not isinstance(each, _Group):
        return format_value(each)
    names = members[each]
    return each.text(len(names)) if len(names) > 1 else format_value(next(iter(names)))


def _ranges(facts: Sequence[Fact]) -> Iterable[str]:
    """Yield each evidence of several facts, numbers from the least to the greatest."""
    for name in dict.fromkeys(name for fact in facts for name in fact.evidence):
        values = [fact.evidence[name] for fact in facts if name in fact.evidence]
        numbers = [value for value in values if not isinstance(value, str)]
        texts = list(dict.fromkeys(value for value in values if isinstance(value, str)))
        shown = list(dict.fromkeys([_text(min(numbers)), _text(max(numbers))] if numbers else ()))
        shown = ["..".join(shown)] if shown else []
        yield f"{name}={'|'.join([*shown, *texts[:MOST_TEXTS], *(['...'] if len(texts) > MOST_TEXTS else [])])}"


def _near(facts: Iterable[Fact]) -> str:
    """Return the mark of what lies near its threshold."""
    return ", near its threshold" if any(is_near(fact.evidence) for fact in facts) else ""


def _text(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"


def _bursts(facts: Iterable[Fact]) -> Iterable[list[Fact]]:
    """Yield facts in order of start, those together between which there is no gap."""
    burst: list[Fact] = []
    end = 0.0
    for fact in sorted(facts, key=lambda each: each.start):
        if burst and fact.start > end + APART:
            yield burst
            burst = []
        end = max(end, fact.end) if burst else fact.end
        burst.append(fact)
    if burst:
        yield burst


def _folded(argument: Argument, groups: Groups) -> Argument | _Group:
    return groups.get(argument, argument) if isinstance(argument, str) else argument


def _groups(domain: Domain) -> dict[str, _Group]:
    """Return of each thing that is one of many the group that it belongs to."""
    wholes = {part: whole for whole, part in domain.parts}
    masses = {name: value for name, prop, value in domain.values if prop == "mass"}
    classes: dict[str, set[str]] = {}
    for name, kind in domain.instances:
        classes.setdefault(name, set()).add(kind)
    # What is no part is alike only if it weighs the same; of what is known to weigh nothing there are not many.
    known = [name for name in classes if name in wholes or name in masses]

    def likeness(name: str) -> tuple[str, str, list[str]]:
        return (_topmost(name, wholes), "" if name in wholes else str(masses[name]), sorted(classes[name]))

    found: dict[str, _Group] = {}
    for _, same in groupby(sorted(known, key=likeness), key=likeness):
        names = list(same)
        if len(names) >= MANY:
            above = {wholes.get(name, "") for name in names}
            of = above.pop() if len(above) == 1 else _topmost(names[0], wholes)
            group = _Group(of=of, first=names[0])
            found.update(dict.fromkeys(names, group))
    return found


def _topmost(name: str, wholes: Mapping[str, str]) -> str:
    """Return the whole that a thing is part of, through all that lies between; empty if it is no part."""
    above, seen = "", {name}
    while name in wholes and wholes[name] not in seen:
        name = above = wholes[name]
        seen.add(name)
    return above

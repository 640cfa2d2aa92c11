"""Facts of a timeline by type and by outcome, sorted once: what is said of many answers looks among few facts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from weakref import WeakKeyDictionary

from prolepsis.log.outcomes import OUTCOMES
from prolepsis.log.timeline import Fact, Timeline


@dataclass(frozen=True, kw_only=True, slots=True)
class Lookup:
    """The facts of one timeline, in its order."""

    by_type: Mapping[str, tuple[Fact, ...]]
    """Those of each type that occurs."""
    actions: tuple[Fact, ...]
    """Those with an outcome."""

    def of(self, type_: str) -> tuple[Fact, ...]:
        """Return the facts of a type."""
        return self.by_type.get(type_, ())


_KNOWN: WeakKeyDictionary[Timeline, Lookup] = WeakKeyDictionary()


def lookup(timeline: Timeline) -> Lookup:
    """Return the facts of a timeline, sorted when they are first looked for."""
    known = _KNOWN.get(timeline)
    if known is None:
        by_type: dict[str, list[Fact]] = {}
        for fact in timeline.facts:
            by_type.setdefault(fact.type, []).append(fact)
        actions = tuple(fact for fact in timeline.facts if fact.evidence.get("outcome") in OUTCOMES)
        known = Lookup(by_type={type_: tuple(facts) for type_, facts in by_type.items()}, actions=actions)
        _KNOWN[timeline] = known
    return known

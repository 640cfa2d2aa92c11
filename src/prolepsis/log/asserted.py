"""What a situation asserts of its things, as facts: from the start until the log shows otherwise."""

from __future__ import annotations

from dataclasses import replace

from prolepsis.log.timeline import Fact, Timeline

SHOWN_AS = {"on": "supports"}
"""Relations that are seen the other way round: ``on(egg1, table1)`` as ``supports(table1, egg1)``."""
BY = {"by": "situation"}
"""Evidence of what the situation says."""


def with_asserted(timeline: Timeline) -> tuple[Fact, ...]:
    """Return the facts of a timeline with what its situation asserts, in order of time.

    A relation that a fluent shows is so of what the situation asserts it, whenever the fluent holds, with whatever:
    what is set down again is on it again. What is asserted is so from the start: up to the end of the first stretch of
    it; or, if it is not seen before, until its thing falls, or is borne or held by another in its place; else to the
    end.
    """
    told = {relation for relation, _, _ in timeline.domain.relations}
    subjects = {(relation, subject) for relation, subject, _ in timeline.domain.relations}
    inverses = {SHOWN_AS[relation]: relation for relation in sorted(told & SHOWN_AS.keys())}
    facts = list(timeline.facts)
    facts += [
        replace(fact, type=inverses[fact.type], args=fact.args[::-1])
        for fact in timeline.facts
        if fact.kind == "fluent" and fact.type in inverses and (inverses[fact.type], fact.args[-1]) in subjects
    ]
    for relation, subject, other in timeline.domain.relations:
        term = (relation, (subject, other))
        shown = (SHOWN_AS[relation], (other, subject)) if relation in SHOWN_AS else term
        first = next((fact for fact in facts if fact.kind == "fluent" and (fact.type, fact.args) == term), None)
        otherwise = _otherwise(timeline, shown)
        if first is not None and (otherwise is None or first.start <= otherwise):
            facts.remove(first)
            evidence = first.evidence if shown == term else {**first.evidence, **BY}
            facts.append(replace(first, start=0.0, evidence=evidence))
        else:
            end = timeline.duration if otherwise is None else max(otherwise, timeline.dt)
            facts.append(Fact(kind="fluent", type=relation, args=(subject, other), start=0.0, end=end, evidence=BY))
    return tuple(sorted(facts, key=lambda fact: (fact.start, fact.end)))


def _otherwise(timeline: Timeline, shown: tuple[str, tuple[str, str]]) -> float | None:
    """Return from when on the log shows that what should be ``shown`` is no longer so; None if it never does."""
    type_, (_, held) = shown
    return next(
        (
            fact.start
            for fact in timeline.facts
            if (fact.type == type_ and fact.args[1:] == (held,)) or (fact.type == "falling" and fact.args == (held,))
        ),
        None,
    )

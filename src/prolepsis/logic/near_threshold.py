"""What is said of an answer that rests on what lies near its threshold."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from itertools import islice

from prolepsis.log.near import MARGIN, is_near
from prolepsis.log.timeline import Fact, Timeline
from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import brief
from prolepsis.terms.terms import Term, Value, format_value

MOST = 3
"""So many facts are told of."""
MOST_LOOKED_AT = 1000
"""Answers that are looked through; more nobody reads one by one."""


def near_note(timeline: Timeline, answers: Sequence[Mapping[str, Value]], goal: str) -> str:
    """Return the note on an answer, empty if it needs none: a little more or less, and it might have been another.

    A yes rests on a fact that an answer shows, or of which the goal and the answer name type and things; a no on what
    nearly was, if the goal names its type, and no thing but its own.

    Args:
        timeline: What was asked.
        answers: All answers.
        goal: The goal as it was asked.
    """
    words = set(re.findall(r"\w+", goal))
    types = {_spelt(word) for word in words}
    if answers:
        some = [*islice(answers, MOST_LOOKED_AT)]
        near = [fact for fact in timeline.facts if is_near(fact.evidence)]
        alike = [fact for fact in timeline.facts if fact.type in {each.type for each in near}]
        times = {time for fact in alike for time in (fact.start, fact.end, Term("-", (fact.start, fact.end)))}
        told = [fact for fact in near if any(_rests_on(fact, types, words, [*a.values()], times) for a in some)]
        return _note(told, "near its threshold, so that a little might change the answer", goal)
    named = words & {name for name, _ in timeline.domain.instances}
    told = [fact for fact in timeline.near_misses if _spelt(fact.type) in types and named <= {*fact.args}]
    return _note(told, "no, but nearly so", goal)


def _rests_on(
    fact: Fact, types: Collection[str], words: Collection[str], values: Sequence[Value], times: Collection[Value]
) -> bool:
    """Return whether a fact is among those of an answer: of its time, if the answer shows ``times``."""
    shown_times = [value for value in values if not isinstance(value, tuple) and value in times]
    if shown_times and not {fact.start, fact.end, Term("-", (fact.start, fact.end))} & {*shown_times}:
        return False
    return fact.term in values or (_spelt(fact.type) in types and all(a in words or a in values for a in fact.args))


def _spelt(name: str) -> str:
    return name.replace("_", "").lower()


def _note(told: Sequence[Fact], what: str, goal: str) -> str:
    if not told:
        return ""
    names = [f"{brief(format_value(each.term), 80)} (margin {each.evidence[MARGIN]:.3g})" for each in told]
    names = list(dict.fromkeys(names))
    return f"{what}: {', '.join(names[:MOST])}{' ...' if len(names) > MOST else ''}: {shown(goal)}"

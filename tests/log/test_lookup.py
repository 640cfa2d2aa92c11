"""The facts of a timeline are sorted once for all that is said of its answers."""

from __future__ import annotations

from tests.synthetic import egg_drop_log

from prolepsis.fluents import recognize
from prolepsis.log.lookup import lookup
from prolepsis.log.outcomes import OUTCOMES


def test_facts_are_found_by_type_in_their_order_and_sorted_once() -> None:
    timeline = recognize(egg_drop_log())
    found = lookup(timeline)
    assert lookup(timeline) is found
    assert all(found.of(type_) == timeline.select(type=type_) for type_ in found.by_type)
    assert sum(map(len, found.by_type.values())) == len(timeline.facts)
    assert found.of("none") == ()
    assert found.actions == tuple(f for f in timeline.facts if f.evidence.get("outcome") in OUTCOMES) != ()

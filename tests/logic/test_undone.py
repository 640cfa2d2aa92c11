"""A "no" says which action did not do what it aimed at."""

from __future__ import annotations

from contextlib import nullcontext

import pytest

from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.terms.errors import Note


@pytest.mark.parametrize(("outcome", "noted"), [("not_reached", True), ("done", False)])
def test_no_proves_nothing_where_an_action_fell_short(
    outcome: str, noted: bool, recwarn: pytest.WarningsRecorder
) -> None:
    evidence = {"outcome": outcome, "reason": "19.1 of 45 N"}
    pressed = Fact(kind="event", type="pressing", args=("hand1", "egg1", 45.0), start=0.0, end=1.0, evidence=evidence)
    timeline = make_timeline([pressed], dt=1e-3, duration=2.0)
    told = r"no, but pressing\(hand1,egg1,45\.0\) was not_reached \(19\.1 of 45 N\)"
    with pytest.warns(Note, match=told) if noted else nullcontext():
        assert timeline.ask("holds(broken(egg1), T)") == []
    assert timeline.ask("occurs(pressing(Hand, egg1, _), _)") == [{"Hand": "hand1"}]
    assert not recwarn.list

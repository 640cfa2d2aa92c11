"""A "no" says that what is asked never comes about of a thing here, and what was told instead."""

from __future__ import annotations

import pytest

from prolepsis.log.domain import Domain
from prolepsis.log.fact_types import ONLY_OF, TOLD_INSTEAD, fact_types
from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.terms.errors import Note

RUN = make_timeline(
    [
        Fact(kind="event", type="overloading", args=("cup1", 4.9), start=0.4, end=0.401),
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.5, end=2.0),
    ],
    dt=1e-3,
    duration=2.0,
    domain=Domain(
        instances=(("cup1", "Cup"), ("egg1", "Breakable"), ("eggshell1", "Breakable"), ("bowl 2", "Bowl")),
        parts=(("egg1", "eggshell1"),),
    ),
)


@pytest.mark.parametrize(
    ("goal", "told"),
    [
        (
            "holds(broken(cup1), T)",
            r"overloading\(cup1,4\.9\) occurred, and broken is told of nothing but what is Breakab",
        ),
        ("occurs(breaking(cup1), T)", r"overloading\(cup1,4\.9\) occurred"),
        ("holds(F, T), F = cracked(cup1)", r"overloading\(cup1,4\.9\) occurred"),
        ("holds(F, T), fluentT(F, open), objOf(F, cup1)", r"overloading\(cup1,4\.9\) occurred"),
        ("holds(crushed(X), T)", r"overloading\(cup1,4\.9\) occurred, and crushed is"),
        ("holds(broken('bowl 2'), T)", "'bowl 2' is not Breakable, and broken is told of nothing else"),
        ("holds(broken(eggshell1), T)", r"broken\(egg1\) tells of it: eggshell1 is a part"),
    ],
)
def test_no_says_what_never_comes_about(goal: str, told: str) -> None:
    with pytest.warns(Note, match=f"^no, but {told}"):
        assert RUN.ask(goal) == []


@pytest.mark.parametrize("goal", ["holds(broken(egg1), 0.1)", "holds(open(egg1), T)", "holds(dented(cup1), T)"])
def test_no_word_is_lost_about_what_breaks(goal: str) -> None:
    assert RUN.ask(goal) == []
    unknown = make_timeline([], dt=1e-3, duration=2.0, domain=Domain(instances=(("cup1", "Cup"),)))
    assert unknown.ask("holds(broken(cup1), T)") == []


def test_the_types_are_those_that_are_found() -> None:
    import prolepsis.fluents

    assert prolepsis.fluents
    assert {*ONLY_OF, *TOLD_INSTEAD.values()} <= fact_types().keys()

"""What still went on when the log ended is marked, and an answer that depends on it says so."""

from __future__ import annotations

import warnings

import pytest

from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.errors import Note

POUR = [
    Fact(
        kind="event",
        type="flowingOut",
        args=("cup1", "liq1"),
        start=1.0,
        end=3.0,
        evidence={"over_rim": 1.0, "tilt": 1.0},
    ),
    Fact(kind="event", type="flowingOnto", args=("liq1", "cup2"), start=1.2, end=3.0, evidence={"source": "cup1"}),
    Fact(kind="fluent", type="contains", args=("cup1", "liq1"), start=0.0, end=3.0),
    Fact(kind="event", type="tilting", args=("hand1", "cup1"), start=0.5, end=2.0),
]


def timeline(duration: float) -> Timeline:
    return make_timeline(POUR, dt=0.001, duration=duration)


CUT, WHOLE = timeline(3.0), timeline(4.0)


def note(asked: Timeline, goal: str) -> str:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        asked.ask(goal)
    assert all(issubclass(each.category, Note) for each in told)
    return "; ".join(str(each.message) for each in told)


def test_an_event_that_ends_with_the_log_is_marked() -> None:
    marked = [fact.type for fact in CUT.facts if fact.evidence.get("ends") == "with the log"]
    assert marked == [
        "flowingOut",
        "flowingOnto",
    ]
    assert not any("ends" in fact.evidence for fact in WHOLE.facts)
    longer = make_timeline(CUT.facts, dt=0.001, duration=4.0)
    assert longer == WHOLE
    assert make_timeline(longer.facts, dt=0.001, duration=3.0) == CUT


def test_what_goes_on_is_asked_for() -> None:
    asked = CUT.ask("findall(F, ongoing(F), Fs)")[0]["Fs"]
    assert str(asked).count("Term") == 4
    assert CUT.ask("ongoing(pouringTo(cup1, liq1, Cup))") == [{"Cup": "cup2"}]
    assert CUT.ask("evidence(pouringTo(cup1, liq1, cup2), _, ends, 'with the log')") == [{}]
    assert WHOLE.ask("ongoing(F)") == []
    assert CUT.ask("ongoing(tilting(X, Y))") == []


NO = [
    "occurs(pouringTo(cup1, liq1, cup2), _T), holds(spilled(X), _U), after(_U, _T)",
    "holds(contains(cup2, liq1), _)",
    "holds(spilled(liq1), _)",
    "occurs(E, _T), eventT(E, 'FlowingOut'), holds(F, _U), after(_U, _T)",
    "occurs(E, S-End), End - S > 2.5",
]
YES = [
    "occurs(flowingOut(cup1, X), T)",
    "occurs(pouringTo(A, B, C), S-E)",
    "occurs(E, T), eventT(E, flowingOnto)",
    "occurs(E, T)",
    "occurs(_, _-E), E > 2.5",
    "findall(T, occurs(flowingOut(_, _), T), L)",
    "setof(E, occurs(_, _-E), L)",
    "evidence(E, T, tilt, _)",
]
RESTS = [
    "occurs(flowingOut(_, _), S-_E), D is _E - S",
    "aggregate_all(max(E - S), occurs(_, S-E), M)",
    "aggregate_all(count, (occurs(_, S-E), E - S > 1.9), N)",
    "\\+ (occurs(_, S-E), E - S > 2.5)",
    "forall(occurs(flowingOut(_, _), S-E), E - S < 5)",
    "occurs(flowingOut(A, B), _T), holds(contains(A, B), _U), allen(R, _U, _T)",
]
APART = [
    "holds(contains(cup2, hand1), _)",
    "occurs(tilting(hand1, X), T)",
    "holds(broken(X), _T)",
    "occurs(E, S-_)",
    "aggregate_all(count, occurs(_, _), N)",
    "occurs(E, 2.9)",
    "occurs(E, T), eventT(E, tilting)",
    "holds(contains(A, B), S-E), D is E - S",
    "occurs(flowingOut(A, B), _T), holds(contains(A, B), _U), \\+ after(_T, _U), X = 1.0",
]


@pytest.mark.parametrize("goal", NO)
def test_a_no_that_depends_on_it_says_so(goal: str) -> None:
    assert "still went on when the log ended at 3 s; the answer no holds until then" in note(CUT, goal)
    assert not note(WHOLE, goal)


@pytest.mark.parametrize("goal", YES)
def test_an_end_that_is_the_log_s_is_told(goal: str) -> None:
    assert "still went on when the log ended at 3 s; the end that it shows is the log's" in note(CUT, goal)
    assert not note(WHOLE, goal)


@pytest.mark.parametrize("goal", RESTS)
def test_what_rests_on_such_an_end_says_so(goal: str) -> None:
    assert "still went on when the log ended at 3 s; had it ended later, the answer might be another" in note(CUT, goal)
    assert not note(WHOLE, goal)


def test_only_the_event_that_matters_is_named() -> None:
    goal = "aggregate_all(count, (occurs(_, S-E), E - S > 1.9), N)"
    assert note(CUT, goal).startswith("flowingOnto(liq1,cup2) still went on")


@pytest.mark.parametrize("goal", APART)
def test_nothing_is_said_of_other_answers(goal: str) -> None:
    assert not note(CUT, goal)

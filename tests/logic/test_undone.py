"""A "no" says which action did not do what it aimed at."""

from __future__ import annotations

from contextlib import nullcontext

import pytest

from prolepsis.log.domain import Domain
from prolepsis.log.fact_types import event_of
from prolepsis.log.plan_end import plan_end_told, plan_outcome
from prolepsis.log.timeline import Fact, Timeline, make_timeline
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


@pytest.mark.parametrize("goal", ["has_part(yolk1, egg1)", "value(egg1, mass, 3.0)", "subclass_of(egg1, egg1)"])
def test_what_is_known_of_a_thing_from_the_start_waits_for_no_action(goal: str) -> None:
    squeezed = Fact(
        kind="event", type="squeezing", args=("hand1", "egg1"), start=0.0, end=1.0, evidence={"outcome": "crushed"}
    )
    domain = Domain(instances=(("egg1", "Egg"), ("yolk1", "EggYolk"), ("egg1", "egg1")))
    assert make_timeline([squeezed], dt=1e-3, duration=2.0, domain=domain).ask(f"{goal}, fail") == []


def _run(*actions: tuple[str, tuple[str | float, ...], float, float, str]) -> Timeline:
    facts = [
        Fact(kind="event", type=type_, args=args, start=start, end=end, evidence={"outcome": outcome})
        for type_, args, start, end, outcome in actions
    ]
    facts.append(Fact(kind="fluent", type="contains", args=("cup1", "tea1"), start=0.0, end=2.0))
    domain = Domain(instances=(("cup1", "Cup"), ("tea1", "Liquid"), ("egg1", "Breakable"), ("hand1", "Hand")))
    return make_timeline(facts, dt=1e-3, duration=2.0, domain=domain)


REACHING = ("reaching", ("hand1", "egg1"), 0.0, 0.4, "done")
FAILED = ("grasping", ("hand1", "egg1", 10.0), 0.4, 1.03, "in_collision")
ENDED = r"the plan ended at 1\.03 s: grasping\(hand1,egg1,10\.0\) was in_collision"


@pytest.mark.parametrize(
    "goal",
    [
        "holds(spilled(tea1), T)",
        "holds(contains(egg1, tea1), 1.5)",
        "occurs(E, T), eventT(E, pouring)",
        "holds(broken(egg1), T)",
        "occurs(E, S-_), S > 1",
    ],
)
def test_no_says_that_the_plan_ended_early_whatever_is_asked(goal: str) -> None:
    with pytest.warns(Note, match=f"^no, but {ENDED}: "):
        assert _run(REACHING, FAILED).ask(goal) == []


@pytest.mark.parametrize("goal", ["holds(spilled(tea1), 0.5)", "instance_of(tea1, 'Cup')", "1 > 2"])
def test_nothing_is_said_of_the_plan_where_no_action_bears_on_it(goal: str) -> None:
    assert _run(REACHING, FAILED).ask(goal) == []


@pytest.mark.parametrize("outcome", ["done", "dropped", "crushed", "not_reached", "unfinished"])
def test_a_plan_that_goes_on_did_not_end(outcome: str) -> None:
    assert plan_end_told(_run(REACHING, (*FAILED[:4], outcome))) == ""


def test_a_plan_ends_when_the_last_does_that_was_going_on() -> None:
    lifting = ("lifting", ("hand2", 0.1), 0.9, 1.5, "done")
    assert plan_end_told(_run(FAILED, lifting)).startswith("the plan ended at 1.5 s: grasping(hand1,egg1,10.0) was in")
    after = ("lifting", ("hand1", 0.1), 1.1, 1.5, "done")
    assert plan_end_told(_run(FAILED, after)) == "", "a plan of elsewhere that goes on after a failure"
    carried = ("lifting", ("hand1", 0.1), 0.5, 1.0, "not_held")
    assert plan_end_told(_run(carried)) == ""
    closed = (event_of("close"), ("hand1", 20.0), 0.5, 1.0, "missed")
    assert plan_end_told(_run(closed)) == ""


def test_of_an_action_and_its_part_that_failed_the_action_is_told() -> None:
    whole = ("grasping", ("hand1", "egg1", 10.0), 0.0, 1.03, "in_collision")
    part = ("reaching", ("hand1", "egg1"), 0.4, 1.03, "in_collision")
    assert plan_end_told(_run(whole, part)) == "the plan ended at 1.03 s: grasping(hand1,egg1,10.0) was in_collision"
    with pytest.warns(Note, match="^no, but the plan ended at [^;]*$"):
        assert _run(whole, part).ask("holds(broken(egg1), T)") == []


@pytest.mark.parametrize(
    ("actions", "outcome"),
    [
        ((), "done"),
        ((REACHING,), "done"),
        ((REACHING, FAILED), "in_collision"),
        ((("pressing", ("hand1", "egg1", 45.0), 0.0, 0.4, "not_reached"), REACHING), "not_reached"),
        ((("pressing", ("hand1", "egg1", 45.0), 0.0, 0.4, "not_reached"), FAILED), "in_collision"),
        ((FAILED, ("pressing", ("hand2", "cup1", 5.0), 0.5, 1.5, "not_reached")), "in_collision"),
        ((("lifting", ("hand1", 0.1), 0.5, 1.0, "dropped"), ("waiting", (1.0,), 1.0, 2.0, "unfinished")), "unfinished"),
    ],
)
def test_a_plan_has_the_outcome_of_what_ended_it_or_of_the_last_that_fell_short(
    actions: tuple[tuple[str, tuple[str | float, ...], float, float, str], ...], outcome: str
) -> None:
    assert plan_outcome(_run(*actions)) == outcome

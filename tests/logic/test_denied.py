"""Where an answer rests on a "no", the same is said of it as of the no itself."""

from __future__ import annotations

import pytest

from prolepsis.log.domain import Domain
from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.terms.errors import Note

RUN = make_timeline(
    [
        Fact(kind="event", type="overloading", args=("cup1", 4.9), start=0.4, end=0.401),
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.5, end=2.0),
        Fact(kind="fluent", type="contains", args=("cup1", "egg1"), start=0.0, end=2.0),
        Fact(
            kind="event",
            type="pushing",
            args=("hand1", "box1"),
            start=0.0,
            end=1.0,
            evidence={"outcome": "not_reached"},
        ),
        Fact(kind="event", type="rolling", args=("ball1",), start=1.0, end=2.0, evidence={"ends": "with the log"}),
    ],
    dt=1e-3,
    duration=2.0,
    domain=Domain(instances=(("cup1", "Cup"), ("egg1", "Breakable"), ("box1", "Box"), ("ball1", "Ball"))),
    near_misses=(Fact(kind="fluent", type="wet", args=("ball1",), start=0.5, end=0.6, evidence={"margin": 0.9}),),
)

# Of some no, more is said than one thing.
several = pytest.mark.filterwarnings("ignore::prolepsis.terms.errors.Note")
OVERLOADED = r"no, but overloading\(cup1,4\.9\) occurred, and broken is told of nothing"


@several
@pytest.mark.parametrize(
    ("goal", "told"),
    [
        ("\\+ holds(broken(cup1), _)", OVERLOADED),
        ("aggregate_all(count, holds(broken(cup1), _), N)", OVERLOADED),
        ("findall(T, holds(broken(cup1), T), L)", OVERLOADED),
        ("forall(holds(broken(cup1), T), T = 0-1)", OVERLOADED),
        ("(holds(broken(cup1), _) -> X = broken ; X = whole)", OVERLOADED),
        ("ignore(holds(broken(cup1), T))", OVERLOADED),
        ("instance_of(X, _), \\+ holds(broken(X), _)", OVERLOADED),
        ("X = cup1, once(\\+ holds(broken(X), _))", OVERLOADED),
        ("findall(X, (instance_of(X, _), \\+ holds(broken(X), _)), L)", OVERLOADED),
        ("setof(X, C^(instance_of(X, C), \\+ holds(broken(X), _)), L)", OVERLOADED),
        ("forall(instance_of(X, 'Cup'), \\+ holds(broken(X), _))", OVERLOADED),
        ("\\+ (holds(broken(cup1), S-_), S < 1)", OVERLOADED),
        ("\\+ holds(wet(ball1), _)", r"no, but nearly so: wet\(ball1\) \(margin 0\.9\)"),
        ("\\+ holds(contains(egg1, cup1), _)", r"contains\(cup1,egg1\) is so, the other way round"),
        ("\\+ holds(supports(box1, cup1), 5)", "no, but the log tells nothing of 5 s"),
        ("\\+ holds(broken(box1), _)", r"no, but pushing\(hand1,box1\) was not_reached"),
        (
            "\\+ (holds(broken(egg1), T), holds(contains(cup1, egg1), T))",
            "no, but one interval, the very same, is asked",
        ),
        ("\\+ holds(broken(egg1), 0.7-1)", "no, but an interval is the whole of it"),
        ("aggregate_all(count, holds(broken(X), 2.0), N)", r"no, but there is broken\(egg1\) over 0\.5-2\.0"),
        ("\\+ occurs(falling(ball1), _)", r"rolling\(ball1\) still went on when the log ended"),
    ],
)
def test_an_answer_that_rests_on_a_no_says_what_the_no_would(goal: str, told: str) -> None:
    with pytest.warns(Note, match=told):
        assert RUN.ask(goal)


def test_a_note_tells_of_which_part_it_is() -> None:
    with pytest.warns(Note, match=r": 'holds\(broken\(cup1\),_\)'$"):
        assert RUN.ask("instance_of(X, 'Cup'), \\+ holds(broken(X), _)") == [{"X": "cup1"}]


@pytest.mark.parametrize(
    "goal",
    [
        "\\+ holds(broken(egg1), 0.1)",
        "aggregate_all(count, holds(broken(_), _), N)",
        "\\+ cup1 = box1",
        "(holds(broken(egg1), T) ; holds(broken(cup1), T), \\+ fail)",
        "\\+ \\+ holds(broken(egg1), _)",
        "holds(broken(X), _), \\+ X = cup1",
        "(holds(broken(egg1), _) -> X = yes ; \\+ holds(broken(cup1), _))",
        "forall(holds(broken(X), _), \\+ holds(broken(X), 0.2))",
        "\\+ (instance_of(egg1, _), \\+ holds(broken(egg1), _))",
        "findall(X, (member(X, [1, 2]), \\+ X = 1), L)",
    ],
)
def test_nothing_is_said_where_no_such_no_counts(goal: str) -> None:
    assert RUN.ask(goal)


def test_what_takes_long_beside_an_answer_is_left_out() -> None:
    assert RUN.ask("\\+ (between(1, 200000, N), holds(broken(cup1), N))") == [{}]


@several
def test_of_many_a_few_are_told_and_how_many_are_not() -> None:
    domain = Domain(instances=tuple((f"cup{number}", "Cup") for number in range(30)))
    facts = [Fact(kind="event", type="overloading", args=(name, 4.9), start=0, end=1) for name, _ in domain.instances]
    cups = make_timeline(facts, dt=1e-3, duration=2.0, domain=domain)
    with pytest.warns(Note) as told:
        assert len(cups.ask("instance_of(X, 'Cup'), \\+ holds(broken(X), _)")) == 30
    assert len(told) == 6
    assert str(told[-1].message).startswith("25 more notes on what is not so are left out")

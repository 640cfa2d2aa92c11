"""A time that a goal says is that of the tick nearest to it: what is printed reads back, and 2 is 2.0."""

from __future__ import annotations

import pytest

from prolepsis.commands.output import bindings
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.errors import GoalError

DT = 0.001


def of_ticks(dt: float) -> Timeline:
    """Return facts over neighbouring stretches of ticks of each length."""
    stretches = [(0, 693), (693, 2000), (1, 2), (700, 1400)]
    return make_timeline(
        [
            Fact(kind="fluent", type=f"held{i}", args=("egg1",), start=a * dt, end=b * dt, evidence={"force": 1.5})
            for i, (a, b) in enumerate(stretches)
        ],
        dt=dt,
        duration=2001 * dt,  # Of what ends with the log a note says that no interval contains its end.
    )


@pytest.mark.parametrize("dt", [0.001, 0.01, 1 / 240, 1 / 60, 0.0005])
def test_printed_times_read_back(dt: float) -> None:
    timeline = of_ticks(dt)
    for answer in timeline.ask("holds(F, T), T = S-E"):
        told = dict(row.split(" = ") for row in bindings(answer).split(", "))
        term = told["F"]
        assert timeline.ask(f"holds({term}, {told['T']})") == [{}]
        assert timeline.ask(f"holds({term}, {told['S']}), \\+ holds({term}, {told['E']})") == [{}]
        assert timeline.ask(f"holds({term}, I), equals(I, {told['T']})")
        assert timeline.ask(f"evidence({term}, {told['T']}, force, 1.5), evidence({term}, {told['S']}, force, 1.5)")


TWO = make_timeline(
    [
        Fact(kind="event", type="closing", args=("hand1",), start=0.0, end=2.0, evidence={"level": "force7"}),
        Fact(kind="fluent", type="broken", args=("egg1",), start=2.0, end=3.0),
    ],
    dt=DT,
    duration=4.0,
)
SAYING_TWO = [
    "occurs(closing(hand1), S-{})",
    "occurs(closing(hand1), 0-{})",
    "occurs(E, 0.0-{})",
    "occurs(closing(X), T), T = 0.0-E, equals(0-{}, T)",
    "holds(broken(X), {})",
    "holds_at(broken(egg1), {})",
    "holds(broken(X), {}-E)",
    "evidence(closing(hand1), 0-{}, level, L)",
    "evidence(closing(hand1), S-{}, level, L)",
    "evidence(E, S-{}, level, L)",
    "fact(_, Id, closing, A, S, {})",
    "fact(_, Id, broken, A, {}, E)",
    "before(0-{}, J)",
    "allen(R, S-{}, J)",
    "meets(0-{}, {}-E)",
    "overlaps(0-{}, 1-3)",
]


@pytest.mark.parametrize("goal", SAYING_TWO)
def test_two_is_two_everywhere(goal: str) -> None:
    asked = [TWO.ask(goal.replace("{}", two)) for two in ("2.0", "2", "2.0000001", "(1.9999999999)")]
    assert asked[0]
    assert len({repr(answers) for answers in asked}) == 1


def test_what_is_computed_of_times_meets_what_is_stored() -> None:
    assert TWO.ask("occurs(closing(hand1), _-_E), _S is _E-0.1-0.2, meets(_S-_E, T)") == TWO.ask("meets(1.7-2, T)")
    assert TWO.ask("X is 0.1+0.2, equals(0-X, 0-0.3), \\+ overlaps(0-X, 0.3-1)")
    assert TWO.ask("after(0.3-0.9, 0.2-0.8), X is 0.1+0.2, \\+ after(X-0.9, 0.3-0.8)")


def test_what_is_shorter_than_a_tick_is_a_tick_long() -> None:
    assert TWO.ask("equals(0.50001-0.50002, 0.5-0.501), allen(starts, 0.5-0.50001, 0.5-1)")


@pytest.mark.parametrize("time", ["1.0e300", "-1.0e300", "1000000000000000000000"])
def test_times_of_no_tick_are_times_like_others(time: str) -> None:
    assert TWO.ask(f"T is {time}, holds(F, T)") == []


@pytest.mark.parametrize("time", ["inf", "nan", "-inf"])
@pytest.mark.parametrize("goal", ["holds(F, T)", "holds(F, T-_)", "evidence(closing(hand1), T, level, L)"])
def test_what_is_no_number_of_seconds_is_no_time(goal: str, time: str) -> None:
    with pytest.raises(GoalError, match=rf"^not a time: {time}; a time is a finite number of seconds, or an interval"):
        TWO.ask(f"T is {time}, {goal}")


@pytest.mark.parametrize("goal", ["E = {}", "E == {}", "member(E, [7, {}])", "T = 0-E, T = S-{}", "T = 0-{}"])
def test_two_is_two_in_what_is_compared_afterwards(goal: str) -> None:
    asked = [TWO.ask("occurs(closing(hand1), T), T = S-E, " + goal.replace("{}", two)) for two in ("2.0", "2")]
    assert asked[0] and repr(asked[0]) == repr(asked[1])


def test_an_interval_that_ends_before_it_starts_is_none() -> None:
    with pytest.raises(GoalError, match=r"not an interval: 2-2\.0"):
        TWO.ask("meets(2-2.0, T)")


@pytest.mark.parametrize("time", ["0.1+0.2", "2*0.5", "(1+2)-4"])
def test_what_is_to_be_computed_is_told_of(time: str) -> None:
    with pytest.raises(GoalError, match=r"not an interval: .*; compute it first: T is "):
        TWO.ask(f"holds(F, {time})")

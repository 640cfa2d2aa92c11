"""What a goal computes of 0.1 and 0.2 is what it is of a tenth and a fifth, and meets what is stored."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from prolepsis.log.domain import Domain
from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.logic.session import Session
from prolepsis.terms.decimals import decimal_of
from prolepsis.terms.errors import GoalError
from prolepsis.terms.units import to_si

RUN = make_timeline(
    [
        Fact(kind="event", type="lifting", args=("hand1", 0.3), start=0.0, end=0.3, evidence={"force": 0.3}),
        Fact(kind="event", type="lifting", args=("hand1", to_si(35, "cm")), start=0.0, end=0.3),
        Fact(kind="event", type="waiting", args=(0.7,), start=0.3, end=1.0, evidence={"force": to_si(1.1, "N")}),
        Fact(kind="event", type="waiting", args=(0.1,), start=100.2, end=100.3),
        Fact(kind="event", type="waiting", args=(1,), start=50.1, end=51.1),
        Fact(kind="event", type="carrying", args=("hand1", "[0.1,0.2,0.3]"), start=1.3, end=1.6),
        Fact(kind="event", type="closing", args=("hand1",), start=0.0, end=1.0, evidence={"level": 0.3}),
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.3, end=2.0),
    ],
    dt=0.001,
    duration=110.0,
    domain=Domain(
        values=(
            ("egg1", "mass", 0.3),
            ("cup1", "radius", 0.1),
            ("cup1", "height", 0.2),
            ("cup2", "mass", to_si(1.1, "g")),
        )
    ),
)
"""35 cm and 1.1 g are 0.35000000000000003 m and 0.0011000000000000001 kg by multiplication."""
SUM = "value(cup1, radius, _R), value(cup1, height, _H), M is _R + _H"


@pytest.mark.parametrize(
    "goal",
    [
        "M is 0.1 + 0.2, occurs(lifting(hand1, M), T)",
        "occurs(lifting(hand1, M), T), M is 0.1 + 0.2",
        "occurs(lifting(hand1, M), T), M =:= 0.1 + 0.2",
        "occurs(lifting(hand1, 0.35), T)",
        "value(cup2, mass, 0.0011)",
        f"{SUM}, value(egg1, mass, M)",
        f"{SUM}, evidence(E, T, force, M)",
        f"{SUM}, argsOf(closing(hand1), [H, M])",
        f"{SUM}, holds(broken(X), S-_), S = M",
        f"{SUM}, holds(broken(X), S-_), S == M",
        f"{SUM}, \\+ (holds(broken(_), _S-_), _S < M)",
        "findall(_V, value(cup1, _, _V), _L), sum_list(_L, M), value(egg1, mass, M)",
        "aggregate_all(sum(_V), value(cup1, _, _V), M), value(egg1, mass, M)",
        "aggregate_all(max(_V + 0.2), value(cup1, radius, _V), M), value(egg1, mass, M)",
        "aggregate_all(min(_V + 0.2, X), value(X, radius, _V), min(M, _)), value(egg1, mass, M)",
        "foldl([_X, _A, _B]>>(_B is _A + _X), [0.1, 0.2], 0, M), value(egg1, mass, M)",
        "foldl(plus, [0.1, 0.2], 0, M), value(egg1, mass, M)",
        "maplist(is, [M], [0.1 + 0.2]), value(egg1, mass, M)",
        "include(=:=(0.1 + 0.2), [0.3, 0.4], [M])",
        "occurs(waiting(D), S-E), D is E - S, S > 100",
        "occurs(waiting(D), S-E), D is E - S, D = 1",
        "occurs(waiting(D), S-E), E - S =:= D, S > 100",
        "occurs(waiting(_), S-E), D is E - S, occurs(waiting(D), T), S > 100",
        "aggregate_all(max(E - S), occurs(waiting(_), S-E), 1)",
        "occurs(carrying(_, [X, Y, Z]), _), Z is X + Y",
        "X is floor((0.1 + 0.7) * 10), X = 8",
        "(X is 0.1 ** 2 -> X = 0.01)",
        "once((member(X, [1.1]), Y is X * 3)), Y = 3.3",
    ],
)
def test_what_is_computed_meets_what_is_stored(goal: str) -> None:
    assert len(RUN.ask(goal)) == 1


def test_all_that_waited_so_long_are_found() -> None:
    assert RUN.ask("occurs(waiting(D), S-E), D is E - S") == RUN.ask("occurs(waiting(D), S-E)")


def test_rules_compute_as_goals_do(tmp_path: Path) -> None:
    file = tmp_path / "rules.pl"
    rules = "chronicle(waited(D), S-E) :- occurs(waiting(D), S-E), took(S, E, D).\ntook(S, E, D) :- D is E - S.\n"
    file.write_text(rules)
    session = Session(chronicles=(file,))
    try:
        assert len(session.ask(RUN, "occurs(waited(D), T)")) == 3
    finally:
        session.close()


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("7 / 2", 3.5),
        ("6 / 2", 3),
        ("2 ** -1", 0.5),
        ("2 ^ 70", 2**70),
        ("1 / 3 * 3", 1.0),
        ("sqrt(0.0625) + 0.1", 0.35),
        ("1.0e-40 * 2", 2e-40),
        ("max(0.1, 1)", 1),
        ("round(2.5)", 3),
        ("-(0.1) + abs(-0.3)", 0.2),
        ("7 mod 4", 3),
        ("1.5 ** 100", 1.5**100),
        ("2 ** 0.5", 2**0.5),
        ("pi * 2", 6.283185307179586),
    ],
)
def test_expressions_come_to_what_they_are(expression: str, value: float) -> None:
    assert RUN.ask(f"X is {expression}") == [{"X": value}]


@pytest.mark.parametrize("expression", ["1 / 0.0", "0.0 ** -1", "1.0e300 * 1.0e300", "_ + 1", "foo + 0.1", "egg1"])
def test_what_comes_to_nothing_is_an_error_as_ever(expression: str) -> None:
    with pytest.raises(GoalError):
        RUN.ask(f"X is {expression}")


@settings(max_examples=30, deadline=None)
@given(st.lists(st.decimals(-1000, 1000, places=3), min_size=2, max_size=6))
def test_a_sum_of_decimals_is_the_decimal(decimals: list[object]) -> None:
    texts = [f"{each}" for each in decimals]
    (answer,) = RUN.ask(f"X is {' + '.join(f'({text})' for text in texts)}")
    assert answer["X"] == float(sum(decimals))  # type: ignore[arg-type]


def test_a_number_stays_but_for_rounding() -> None:
    assert decimal_of(35 * 0.01) == 0.35 and decimal_of(0.1 + 0.2) == 0.3
    for number in (1 / 3, 0.123456789012345, float("inf"), 5e-324, 2**70 + 0.0, 7):
        assert decimal_of(number) == number and type(decimal_of(number)) is type(number)

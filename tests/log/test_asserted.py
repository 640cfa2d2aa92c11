"""What a situation asserts holds from the start until the log shows otherwise, and is one fact with what shows it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from prolepsis.log.domain import Domain
from prolepsis.log.timeline import Fact, Timeline, make_timeline

TABLE = Fact(kind="fluent", type="supports", args=("table1", "egg1"), start=0.0, end=1.0)
AGAIN = Fact(kind="fluent", type="supports", args=("table1", "egg1"), start=2.0, end=3.0)
FLOOR = Fact(kind="fluent", type="supports", args=("floor", "egg1"), start=0.6, end=3.0)
FALL = Fact(kind="event", type="falling", args=("egg1",), start=0.4, end=0.6)
AT_ONCE = Fact(kind="event", type="falling", args=("egg1",), start=0.0, end=0.6)
INSIDE = Fact(kind="fluent", type="contains", args=("cup1", "liq1"), start=0.0, end=1.5, evidence={"fill": 0.5})
ELSEWHERE = Fact(kind="fluent", type="contains", args=("cup2", "liq1"), start=1.2, end=3.0)
ON, IN, WET = ("on", "egg1", "table1"), ("contains", "cup1", "liq1"), ("wetWith", "hand1", "liq1")


def timeline(relation: tuple[str, str, str], *facts: Fact) -> Timeline:
    return make_timeline(facts, dt=0.001, duration=3.0, domain=Domain(relations=(relation,)))


@pytest.mark.filterwarnings("ignore:no, but there is .*, where the log ends")
@pytest.mark.parametrize(
    ("relation", "facts", "end"),
    [
        pytest.param(ON, (TABLE,), 1.0, id="as long as it is seen"),
        pytest.param(ON, (TABLE, AGAIN), 1.0, id="until it is lifted"),
        pytest.param(ON, (), 3.0, id="to the end when nothing is seen"),
        pytest.param(ON, (FALL, FLOOR), 0.4, id="until a fall"),
        pytest.param(ON, (FLOOR,), 0.6, id="until something else bears it"),
        pytest.param(ON, (FALL, AGAIN), 0.4, id="until a fall although it comes back"),
        pytest.param(ON, (AT_ONCE,), 0.001, id="for a tick when it falls at once"),
        pytest.param(IN, (INSIDE, ELSEWHERE), 1.5, id="with the fluent of its own name"),
        pytest.param(IN, (ELSEWHERE,), 1.2, id="until it is elsewhere"),
        pytest.param(WET, (FALL, FLOOR), 3.0, id="of what no fluent shows"),
    ],
)
def test_it_ends_when_the_log_shows_otherwise(
    relation: tuple[str, str, str], facts: tuple[Fact, ...], end: float
) -> None:
    asserted = timeline(relation, *facts)
    term = f"{relation[0]}({relation[1]}, {relation[2]})"
    assert asserted.ask(f"holds({term}, 0.0-E)") == [{"E": end}]
    assert asserted.ask(f"aggregate_all(count, holds({term}, 0.0), N)") == [{"N": 1}]
    assert asserted.ask(f"holds({term}, {end - 0.001})")
    assert not asserted.ask(f"holds({term}, {end})")


@pytest.mark.parametrize("first", [(TABLE,), (FALL,), (FLOOR,)])
def test_what_is_set_down_again_is_on_it_again(first: tuple[Fact, ...]) -> None:
    asked = timeline(ON, *first, AGAIN)
    assert asked.ask("holds(on(egg1, table1), 2.5)")
    assert not asked.ask("holds(on(egg1, table1), 1.5)")
    assert asked.ask("holds(on(egg1, table1), 2.0-3.0)")


def test_on_is_supports_the_other_way_round_of_what_it_is_asserted_of() -> None:
    others = (
        replace(TABLE, args=("table1", "cup1"), evidence={"share": 1.0}),
        replace(AGAIN, args=("cup1", "egg1"), evidence={"share": 0.4}),
    )
    asked = timeline(ON, TABLE, *others)
    borne = "findall(on(egg1, Y)-T, holds(supports(Y, egg1), T), L)"
    assert asked.ask(borne) == asked.ask("findall(on(X, Y)-T, holds(on(X, Y), T), L)")
    assert asked.ask("evidence(on(egg1, cup1), T, share, S)") == asked.ask("T = 2.0-3.0, S = 0.4")
    # Of a log of which no situation speaks, nothing is on anything.
    assert not make_timeline(others, dt=0.001, duration=3.0).ask("holds(F, T), fluentT(F, on)")


def test_it_is_found_as_any_fluent_is() -> None:
    asked = timeline(ON, TABLE)
    assert asked.ask("holds(F, T), fluentT(F, 'On'), objOf(F, egg1), evidence(F, T, by, Who)")[0]["Who"] == "situation"
    assert asked.ask("holds(supports(X, Y), T), holds(on(Y, X), T)") == asked.ask("holds(supports(X, Y), T)")


def test_what_the_fluent_measured_is_kept() -> None:
    assert timeline(IN, INSIDE).ask("evidence(contains(cup1, liq1), T, Name, V)") == timeline(IN).ask(
        "T = 0.0-1.5, Name = fill, V = 0.5"
    )

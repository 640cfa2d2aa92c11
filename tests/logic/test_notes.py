"""What is said beside an answer that is right, and asks something else than was meant, perhaps."""

from __future__ import annotations

import pytest

from prolepsis.log.domain import Domain
from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.terms.errors import Note

RUN = make_timeline(
    [
        Fact(kind="fluent", type="contains", args=("cup1", "liq1"), start=0.0, end=1.0, evidence={"fraction": 0.8132}),
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.5, end=2.0, evidence={"by": "situation"}),
        Fact(
            kind="event",
            type="colliding",
            args=("egg1", "cup1"),
            start=0.5,
            end=0.6,
            evidence={"speed": 1.0, "peak_force": 3.0},
        ),
        Fact(kind="event", type="lifting", args=("hand1", 0.1), start=0.1, end=0.2),
        Fact(kind="fluent", type="wet", args=("eggshell1",), start=0.6, end=2.0),
        Fact(kind="fluent", type="contacts", args=("shard1", "table1"), start=0.6, end=2.0),
        Fact(kind="fluent", type="supports", args=("table1", "shard1"), start=0.6, end=2.0),
    ],
    dt=1e-3,
    duration=2.0,
    domain=Domain(
        parts=(("egg1", "eggshell1"), ("eggshell1", "shard1")),
        values=(("egg1", "mass", 0.0582),),
        units=(("mass", "kg"),),
    ),
)


@pytest.mark.parametrize(
    ("goal", "told"),
    [
        ("holds(contains(liq1, cup1), T)", r"contains\(cup1,liq1\) is so, the other way round"),
        ("holds(F, T), F = contains(liq1, cup1)", r"contains\(cup1,liq1\) is so"),
        ("occurs(E, T), E = colliding(cup1, egg1)", r"colliding\(egg1,cup1\) is so, the other way round"),
        ("occurs(E, T), memberchk(E, [colliding(cup1, egg1)])", r"colliding\(egg1,cup1\) is so"),
        ("findall(E, occurs(E, _), L), memberchk(colliding(cup1, egg1), L)", r"colliding\(egg1,cup1\) is so"),
        ("eventT(E, X), X = 'Colliding'", "a type that is found is told as colliding, not 'Colliding'"),
        ("occurs(E, T), eventT(E, X), memberchk(X, ['Colliding'])", "a type that is found is told as colliding"),
        ("occurs(colliding(egg1, cup1), T1), holds(broken(egg1), T2), after(T2, T1)", "they begin in the same tick"),
        ("after(T2, T1), occurs(colliding(X, _), T1), holds(broken(X), T2)", "they begin in the same tick, and after"),
        ("occurs(colliding(egg1, _), S-E), holds(broken(egg1), T), before(S-E, T)", "they begin in the same tick"),
        ("has_part(eggshell1, egg1)", r"has_part\(egg1,eggshell1\) is so"),
        ("holds(wet(egg1), T)", r"wet is told of parts of egg1: wet\(eggshell1\)"),
        ("holds(supports(table1, egg1), T)", r"supports is told of parts of egg1: supports\(table1,shard1\)"),
        ("holds(contacts(table1, eggshell1), T)", r"contacts is told of parts of eggshell1: contacts\(shard1,table1\)"),
        ("holds(supports(_, egg1), T)", "supports is told of parts of egg1"),
        ("value(egg1, mass, 58)", r"mass of egg1 is 0\.0582 kg"),
        ("value(egg1, mass, 0.06)", r"mass of egg1 is 0\.0582 kg"),
        ("evidence(contains(cup1, liq1), T, fraction, 0.8)", r"fraction of contains\(cup1,liq1\) is 0\.8132"),
        (
            "evidence(colliding(egg1, cup1), T, force, V)",
            "colliding has no force here; its evidence is peak_force, speed",
        ),
        ("evidence(colliding(X, Y), T, tilt, V)", "colliding has no tilt here; its evidence is peak_force, speed"),
        ("evidence(E, T, force, V), eventT(E, colliding)", "colliding has no force here; its evidence is peak_force"),
        ("evidence(lifting(hand1, 0.1), T, force, V)", "lifting has no force here; nothing was measured of it"),
        ("holds(broken(egg1), 99)", "the log tells nothing of 99 s: it lasts from 0 to 2 s"),
        ("holds_at(F, 99)", "the log tells nothing of 99 s: it lasts from 0 to 2 s"),
        ("T = 99, holds_at(F, T)", "the log tells nothing of 99 s"),
        ("T = -1, occurs(E, T)", "the log tells nothing of -1 s"),
        ("holds(F, 1-99)", "the log tells nothing of 99 s"),
        ("holds(F, S-99)", "the log tells nothing of 99 s"),
        ("evidence(F, 99, force, V)", "the log tells nothing of 99 s"),
        ("member(T, [99, 98]), holds_at(F, T)", "the log tells nothing of 9[89] s"),
        ("near_miss(F, 99, M)", "the log tells nothing of 99 s"),
        ("fact(_, _, colliding, _, 99, _)", "the log tells nothing of 99 s"),
        ("occurs(lifting(hand1, 10), T)", r"lifting\(hand1,0\.1\) is so"),
        ("evidence(broken(egg1), T, Name, fraction)", "no value is fraction here"),
        ("evidence(broken(egg1), T, Name, V), V == mass", "no value is mass here"),
        ("occurs(E, S-E)", "E stands for a fluent or event, and for a time, and nothing is both"),
        ("holds(broken(egg1), S-E), D == 1.5", "nothing gives D the value that == compares"),
    ],
)
def test_no_says_what_is_told_otherwise(goal: str, told: str) -> None:
    with pytest.warns(Note, match=f"^no, but {told}"):
        assert RUN.ask(goal) == []


@pytest.mark.parametrize(
    ("goal", "told"),
    [
        (
            "holds(broken(egg1), T), occurs(colliding(egg1, _), T)",
            r"one interval, the very same, is asked of broken\(egg1\) over 0\.5-2\.0, colliding\(egg1,cup1\) over",
        ),
        ("holds(broken(X), S-E), holds(contains(Y, _), S-E)", r"one interval, .*contains\(cup1,liq1\) over 0\.0-1\.0;"),
        ("holds(broken(egg1), T), evidence(colliding(X, _), T, speed, V), V < 2", "one interval, the very same"),
        ("occurs(lifting(H, D), T), holds(F, T), T = S-_, S > 0", "one interval, the very same"),
        ("holds(broken(egg1), 0.7-1.0)", r"an interval is the whole of it, as of broken\(egg1\) over 0\.5-2\.0; write"),
        ("holds(broken(X), 0-2)", r"an interval is the whole of it, as of broken\(egg1\)"),
        ("holds(broken(egg1), 0.7-E)", r"an interval is the whole of it, as of broken\(egg1\)"),
        ("holds(broken(egg1), S-1.9)", r"an interval is the whole of it, as of broken\(egg1\)"),
        (
            "holds(broken(egg1), 2)",
            r"there is broken\(egg1\) over 0\.5-2\.0, where the log ends; no interval contains its end",
        ),
        ("holds_at(broken(X), 2.0)", r"there is broken\(egg1\) over 0\.5-2\.0, where the log ends"),
    ],
)
def test_no_says_what_is_so_over_another_interval(goal: str, told: str) -> None:
    with pytest.warns(Note, match=f"^no, but {told}"):
        assert RUN.ask(goal) == []


@pytest.mark.parametrize(
    ("goal", "told"),
    [
        ("holds(broken(egg1), S-E), D = E-S", r"D = 2\.0-0\.5 is not computed; write D is"),
        ("holds(broken(egg1), S-E), D = S*2", r"D = 0\.5\*2 is not computed"),
        ("findall(X, holds(broken(Y), T), L)", "X is collected, and stands in no goal that gives it a value"),
        ("setof(X-Y, T^holds(broken(X), T), L)", "Y is collected"),
    ],
)
def test_an_answer_says_what_it_is_not(goal: str, told: str) -> None:
    with pytest.warns(Note, match=told):
        assert RUN.ask(goal)


@pytest.mark.parametrize(
    "goal",
    [
        "holds(contains(cup1, liq1), 1.5)",  # what is told so holds at another time
        "holds(contains(liq1, egg1), T)",
        "occurs(lifting(hand1, 0.1), 1.5)",
        "occurs(lifting(_, 10), T)",
        "value(egg1, mass, 0.07)",
        "evidence(contains(cup1, liq1), T, fraction, 0.5)",
        "evidence(E, T, Name, situation), fail",
        "occurs(colliding(cup1, egg1), 1.5)",
        "evidence(colliding(egg1, cup1), 1.5, speed, V)",
        "evidence(dented(egg1), T, force, V)",
        "occurs(lifting(_, _), T1), holds(broken(egg1), T2), after(T1, T2)",
        "occurs(colliding(_, _), T1), holds(broken(egg1), T2), after(T2, T1), 1 > 2",
        "eventT(E, X), X = lifting, X == colliding",
        "holds(broken(X), T), before(T, 99-100), T = 0-1",
        "holds(broken(egg1), 0.1-0.4)",
        "holds(supports(cup1, egg1), T)",
        "holds(supports(egg1, table1), T)",
        "holds(wet(table1), T)",
        "holds(wet(eggshell1), 0.1)",
        "holds(contains(cup1, liq1), 2)",
        "occurs(lifting(H, _), T), evidence(lifting(H, _), T, _, V)",
        "holds(broken(X), T), occurs(colliding(X, _), T), 1 > 2",
        "holds(contains(X, egg1), T), occurs(colliding(egg1, X), T)",
        "(occurs(E, _) ; holds(broken(X), S-E)), fail",
    ],
)
def test_no_is_no_where_nothing_else_is_told(goal: str) -> None:
    assert RUN.ask(goal) == []


@pytest.mark.parametrize(
    "goal",
    [
        "holds(broken(egg1), S-E), T = S-E",
        "holds(broken(X), _), findall(X, true, L)",
        "findall(found, holds(broken(_), _), L)",
        "X = egg1, X == egg1",
        "findall(_X, holds(broken(_), _), L)",
    ],
)
def test_no_word_is_lost_where_nothing_is_mistaken(goal: str) -> None:
    assert RUN.ask(goal)

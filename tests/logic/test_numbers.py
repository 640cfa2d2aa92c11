"""A number is one however it is written: 10 and 10.0 are one argument, and one value."""

from __future__ import annotations

import pytest

from prolepsis.commands.output import bindings
from prolepsis.log.domain import Domain
from prolepsis.log.timeline import Fact, make_timeline

RUN = make_timeline(
    [
        Fact(kind="event", type="grasping", args=("hand1", "egg1", 10), start=0.0, end=1.0, evidence={"force": 12.0}),
        Fact(kind="event", type="grasping", args=("hand1", "egg1", 10.0), start=2.0, end=3.0),
        Fact(kind="event", type="waiting", args=(2.0,), start=1.0, end=2.0, evidence={"tries": 3}),
        Fact(kind="event", type="carrying", args=("hand1", "[0,1,0.5]"), start=3.0, end=4.0),
        Fact(kind="event", type="closing", args=("hand1",), start=0.0, end=1.0, evidence={"level": 10.0}),
        Fact(kind="event", type="closing", args=("hand2",), start=0.0, end=1.0, evidence={"level": 7.0}),
    ],
    dt=0.001,
    duration=5.0,
    domain=Domain(values=(("egg1", "mass", 1.0), ("egg1", "count", 6))),
)


@pytest.mark.parametrize(
    "goal",
    [
        "occurs(grasping(hand1, egg1, {10}), 0.0-1.0), occurs(grasping(hand1, X, {10}), 2.0-3.0)",
        "_N is {10}, occurs(grasping(H, O, _N), T)",
        "occurs(E, T), E = grasping(_, _, {10})",
        "occurs(E, T), E == grasping(hand1, egg1, {10})",
        "occurs(grasping(_, _, N), T), N = {10}",
        "occurs(grasping(_, _, N), T), member(N, [9, {10}])",
        "findall(N, occurs(grasping(_, _, N), _), L), memberchk({10}, L)",
        "E =.. [grasping, hand1, egg1, {10}], occurs(E, T)",
        "occurs(E, T), E =.. [grasping, _, _, {10}]",
        "occurs(E, T), arg(3, E, {10})",
        "occurs(E, T), argsOf(E, [H, O, {10}])",
        "occurs(E, T), argsOf(E, L), L = [_, _, {10}]",
        "argsOf(grasping(hand1, egg1, {10}), L)",
        "objOf(grasping(hand1, egg1, {10}), O)",
        "evidence(grasping(hand1, egg1, {10}), T, force, F)",
        "fact(R, I, grasping, [hand1, egg1, {10}], S, E)",
        "occurs(waiting({2}), T)",
        "occurs(carrying(hand1, [{0}, 1, 0.5]), T)",
        "occurs(carrying(hand1, [_, Y, _]), T), Y = {1}",
        "occurs(carrying(hand1, [X|_]), T), X == {0}",
        "occurs(E, T), arg(2, E, [X|_]), X == {0}",
        "argsOf(E, [hand1, {10}])",
        "occurs(E, T), argsOf(E, [hand2, {7}])",
        "occurs(E, T), argsOf(E, [_, L]), L = {7}",
        "occurs(E, T), argsOf(E, [hand1, L]), L == {10}",
        "argsOf(closing(hand2), L), L = [_, {7}]",
        "occurs(E, T), argsOf(E, A), last(A, {10})",
        "evidence(closing(hand2), T, level, {7})",
        "aggregate_all(max(E), occurs(_, _-E), {4})",
        "aggregate_all(min(E, F), occurs(F, _-E), M), M = min({1}, _)",
        "aggregate_all(max(E), occurs(_, _-E), M), M == {4}",
        "findall(E, occurs(_, _-E), L), max_list(L, {4})",
        "aggregate_all(max(V), value(_, count, V), {6})",
        "aggregate_all(max(E - S), occurs(waiting(_), S-E), M), M =:= {1}",
        "evidence(E, T, force, {12})",
        "evidence(E, T, force, N), N == {12}",
        "evidence(E, T, tries, {3})",
        "value(egg1, mass, {1})",
        "value(egg1, mass, M), M = {1}",
        "value(X, count, {6})",
    ],
)
def test_ten_is_ten_everywhere(goal: str) -> None:
    asked = [RUN.ask(goal.replace("{", "").replace("}", more)) for more in ("", ".0")]
    assert asked[0] and repr(asked[0]) == repr(asked[1])


def test_what_is_printed_reads_back() -> None:
    for answer in RUN.ask("occurs(E, T), argsOf(E, L)"):
        told = dict(row.split(" = ") for row in bindings(answer).split(", "))
        assert RUN.ask(f"occurs({told['E']}, {told['T']}), argsOf({told['E']}, {told['L']})") == [{}]


def test_what_is_computed_with_stays_as_it_is_written() -> None:
    assert RUN.ask("X = 10, Y = 10.0, X \\== Y, Z is X / 4, occurs(waiting(_), _)") == [{"X": 10, "Y": 10.0, "Z": 2.5}]
    assert RUN.ask("occurs(grasping(_, _, 11), T)") == RUN.ask("occurs(grasping(_, _, 10.5), T)") == []

"""Files of chronicles from anybody: read as data, checked as goals are, apart from ours, and within limits."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.logic import session as sessions
from prolepsis.logic.session import Session
from prolepsis.terms.errors import GoalLimitError, InputError
from prolepsis.terms.terms import Term

HEAD = "chronicle(shaking(X), T) :- "


def timeline() -> Timeline:
    facts = [
        Fact(kind="fluent", type="attached", args=("hand1", "egg1"), start=0.0, end=1.0),
        Fact(kind="event", type="falling", args=("egg1",), start=1.0, end=1.4),
        Fact(kind="event", type="moving", args=("egg1",), start=0.5, end=1.4),
    ]
    return make_timeline(facts, dt=0.001, duration=2.0)


def asked(tmp_path: Path, *rules: str, goal: str = "occurs(E, T)") -> list[object]:
    files = [tmp_path / f"rules{number}.pl" for number in range(len(rules))]
    for file, text in zip(files, rules, strict=True):
        file.write_text(text)
    session = Session(chronicles=tuple(files))
    try:
        return [answer["E"] for answer in session.ask(timeline(), goal)]
    finally:
        session.close()


@pytest.mark.parametrize(
    ("rules", "message"),
    [
        (HEAD + "holds(X, T.", "rules0.pl, line 1: syntax error"),
        ("% words\n\n" + HEAD + "holds(X, T),.", "rules0.pl, line 3: syntax error"),
        (HEAD + "hols(X, T).", "line 1: unknown predicate hols/2; did you mean holds/2"),
        (":- initialization(shell('touch /tmp/x')).", "line 1: no rule: :-initialization.*nothing in it is executed"),
        ("?- shell(x).", "line 1: no rule"),
        ("a --> b.", "line 1: no rule"),
        ("chronicle(X, T) => true.", "line 1: no rule"),
        ("X :- true.", "line 1: no rule"),
        ("3.", "line 1: no rule: 3"),
        ("user:portray(X) :- shell(X).", "line 1: no rule: user:portray"),
        ("chronicle(X, T) :- holds(X, T).", "line 1: no event"),
        ("chronicle(3, T) :- holds(X, T).", "line 1: no event or interval: 3"),
        ("chronicle(a:b, T) :- holds(X, T).", "line 1: no event or interval: a:b"),
        (HEAD + "shell(x).", r"line 1: not permitted: shell\(x\)"),
        (HEAD + "\n  holds(X, T),\n  format(atom(_), '~@', [halt]).", "line 1: not permitted: format"),
        (HEAD + "aid(G, T), call(G).\naid(halt, T).", "line 1: not permitted: a goal that is known only when"),
        (HEAD + "aided(T).\naided(T) :- assertz(a).", "line 2: not permitted: assertz"),
        (HEAD + "lists:member(X, [a]).", "line 1: not permitted: lists:member"),
        ("holds(X, T) :- true.", "line 1: holds/2 exists already; give the helper another name"),
        ("append(X, Y, Z) :- true.", "line 1: append/3 exists already"),
        ("halt.", "line 1: halt/0 exists already"),
        ("chronicle([a|b], 0-1).", "line 1: no event"),
        ("chronicle(oops(X), 5) :- holds(X, _).", "line 1: no event or interval: 5"),
        ("chronicle('[]', 0-1) :- fail.\nend_of_file.\nx.", "line 2: no rule: end_of_file"),
        ("chronicle(falling(fake), 0-1).", "line 1: falling is known without this file; give the event another name"),
        ("chronicle(picking_up(a, b), 0-1).", "line 1: picking_up is known without this file"),
        (f"chronicle({'x' * 5000}(X), T) :- {'y' * 5000}(T).", "line 1: unknown predicate yyy"),
        (f"{'x' * 5000} :- {'y' * 5000} --> z.", "line 1: (no rule|syntax error)"),
        (
            "chronicle(x(R), 0-1) :- length(L, 32), foldl([_, A, B]>>(B = f(A, A)), L, x, R).",
            "chronicle x/1 needs a value before it is known, or leaves its event or interval open, or too large",
        ),
        ("chronicle(x(1), 0-nan).", "chronicle x/1"),
        ("shell(X) :- true.", "line 1: shell/1 exists already"),
        ("helper(X) :- true.", "holds no chronicle; a file holds rules"),
        ("", "holds no chronicle"),
        (HEAD + "true.", "chronicle shaking/1 needs a value before it is known, or leaves"),
        ("chronicle(shaking(a), 1-b).", "chronicle shaking/1 fails"),
        ("chronicle(x(1), 0.5-0.25).", r"chronicle x/1 has an interval that ends before it starts, 0\.5-0\.25"),
        (HEAD + "X > 1, T = 0-1.", "chronicle shaking/1 needs a value"),
        ("chronicle(shaking(X), 0-1) :- between(1, inf, X).", "chronicle shaking/1 has 100,000 answers or more"),
        ("chronicle(shaking(L), 0-1) :- numlist(1, 100000000, L).", "chronicle shaking/1: memory limit"),
    ],
)
def test_a_file_of_chronicles_that_is_wrong_is_refused(tmp_path: Path, rules: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as refused:
        asked(tmp_path, rules)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 300 + len(str(tmp_path))


def test_a_chronicle_that_does_not_end_is_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sessions, "CHRONICLE_LIMIT", 0.5)
    with pytest.raises(GoalLimitError, match=r"chronicle shaking/1: time limit of 0\.5 s reached"):
        asked(tmp_path, HEAD + "repeat, fail.")


def test_helpers_stay_in_their_file(tmp_path: Path) -> None:
    ours = asked(tmp_path, "chronicle(x(1), 0-1).", goal="occurs(E, _), E = dropping(_, _)")
    assert ours == [Term("dropping", ("hand1", "egg1"))]
    # A helper of the name of one of ours, and two files with a helper of the same name.
    first = "chronicle(first(N), 0-1) :- hold(N, a, b, c, d).\nhold(1, _, _, _, _)."
    second = "chronicle(second(N), 0-1) :- hold(N, a, b, c, d).\nhold(2, _, _, _, _)."
    events = asked(tmp_path, first, second, goal="occurs(E, _), \\+ E = falling(_), \\+ E = moving(_)")
    assert set(map(str, events)) == {
        str(term) for term in (Term("first", (1,)), Term("second", (2,)), Term("dropping", ("hand1", "egg1")))
    }


def test_times_are_found_however_they_are_written(tmp_path: Path) -> None:
    rule = "chronicle(x(N), S-E) :- member(N, [1, 2]), S is N rdiv 4, E is N rdiv 2."
    for goal in ("occurs(x(2), 0.5-1), E = 1", "occurs(x(2), 0.5-1.0), E = 1", "occurs(x(1), 0.25-E)"):
        assert len(asked(tmp_path, rule, goal=goal)) == 1, goal


def test_many_helpers_are_checked_soon(tmp_path: Path) -> None:
    helpers = "".join(f"z{number}.\n" for number in range(4500))
    rule = f"chronicle(x(1), 0-1) :- {', '.join(['z1'] * 20000)}.\n"
    assert asked(tmp_path, helpers + rule, goal="occurs(E, _), E = x(_)") == [Term("x", (1,))]


def test_a_later_file_sees_the_events_of_an_earlier_one(tmp_path: Path) -> None:
    first = "chronicle(first(X), T) :- occurs(falling(X), T)."
    second = "chronicle(second(X), T) :- occurs(first(X), T)."
    assert asked(tmp_path, first, second, goal="occurs(E, _), E = second(_)") == [Term("second", ("egg1",))]
    assert asked(tmp_path, second, first, goal="occurs(E, _), E = second(_)") == []


@pytest.mark.parametrize("kind", ["missing", "folder", "fifo", "long", "latin"])
def test_what_is_no_file_of_rules_is_refused(tmp_path: Path, kind: str) -> None:
    file = tmp_path / "rules.pl"
    expected = {
        "missing": "cannot read the file: No such file",
        "folder": "it is a folder, not a file",
        "fifo": "it is a pipe, not a file",
        "long": "is too long: more than 1,000,000 bytes",
    }
    if kind == "folder":
        file.mkdir()
    elif kind == "fifo":
        os.mkfifo(file)
    elif kind == "long":
        file.write_bytes(b" " * 1_000_001)
    elif kind == "latin":
        file.write_bytes(b"% \xff")
    session = Session(chronicles=(file,))
    with pytest.raises(InputError, match=expected.get(kind, "is not UTF-8 text at byte 2")):
        session.ask(timeline(), "true")
    session.close()

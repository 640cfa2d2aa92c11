"""A query pasted from the paper, a page or a prompt is answered as it stands."""

from __future__ import annotations

import pytest

from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.logic.pasting import OPERATORS, pasted
from prolepsis.logic.process import PrologProcess

THE_PAPERS = """?- occurs(E,T1), eventT(E,'ClosingGripper'),
   argsOf(E, [rightGripper, force12]), holds(F,T2),
   after (T2, T1), fluent (F, Type), argsOf (F, Args).
"""


def timeline() -> Timeline:
    closing = Fact(
        kind="event", type="closingGripper", args=("rightGripper",), start=0.1, end=0.2, evidence={"level": "force12"}
    )
    broken = Fact(kind="fluent", type="broken", args=("egg1",), start=0.15, end=2.0)
    return make_timeline([closing, broken], dt=0.001, duration=2.0)


def test_the_papers_query_is_answered_in_its_own_spacing() -> None:
    ((answer),) = timeline().ask(THE_PAPERS)
    assert (answer["Type"], answer["Args"]) == ("broken", ("egg1",))


@pytest.mark.parametrize(
    "goal",
    [
        "?- holds(broken(X), _).",
        "?-holds (broken\n(X), _) .",
        "  ?-  holds(broken(X), _)  ",
        "holds(broken(X), _). % yes",
        "?- \\+ (fail), once ((holds(broken(X), _))).",
        "atom_length('is (a', N), N is (2 + 3) , holds (broken(X), _)",
    ],
)
def test_a_prompt_a_full_stop_and_spaces_do_no_harm(goal: str) -> None:
    assert [answer["X"] for answer in timeline().ask(goal)] == ["egg1"]


@pytest.mark.parametrize(
    "text", ["X = 'f (a)'", 'X = "f (a) \\" g (b)"', "X = 0'a, Y = 'it''s f (x)'", "X is (1), Y = 7 mod (3)", "F (x)"]
)
def test_what_is_quoted_or_an_operator_stays(text: str) -> None:
    assert pasted(text) == text


def test_what_follows_stays_in_its_column() -> None:
    assert pasted("holds (F, T), x  (y)") == "holds( F, T), x(  y)"


def test_all_operators_that_are_words_are_known() -> None:
    process = PrologProcess()
    words = process.call("findall(W, current_op(_, _, W), Ws), atomic_list_concat(Ws, ' ', Reply)", 10.0)
    process.close()
    assert {word for word in words.split() if word[0].islower()} <= OPERATORS

"""What an answer holds is a term, and what ``json.dumps`` takes."""

from __future__ import annotations

import copy
import json
import pickle

import numpy as np
import pytest

import prolepsis
from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.terms.answers import as_answer
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, Value, Variable, format_value

WHOLE = make_timeline([Fact(kind="fluent", type="broken", args=("egg1",), start=0.3, end=2.0)], dt=1e-3, duration=2.0)


def test_answers_are_json_as_they_are() -> None:
    answers = WHOLE.ask("holds(F, T), T = S-E, L = [F, 1, T, 'Two words'], Y = f(_)")
    when = {"start": 0.3, "end": 2.0}
    told = {"F": "broken(egg1)", "T": when, "S": 0.3, "E": 2.0, "L": ["broken(egg1)", 1, when, "Two words"]}
    assert json.loads(json.dumps(answers)) == [told | {"Y": "f(_1)"}]
    assert json.dumps(answers) == json.dumps(prolepsis.json_value(answers))


@pytest.mark.parametrize(
    "text", ["broken(egg1)", "0.5-2.0", "X", "a-b", "f(X,[1,0.5-2.0])", "[a|T]", "- 1", "'A b'(x)", "-(0.5,X)"]
)
def test_they_are_terms_like_others(text: str) -> None:
    plain = parse_term(text)
    told = as_answer(plain)
    assert told == plain and plain == told and hash(told) == hash(plain) and {told} == {plain}
    assert format_value(told) == format_value(plain) == format_value((told,))[1:-1]
    assert (repr(told), str(told), f"{told}") == (repr(plain), str(plain), f"{plain}")
    assert isinstance(told, type(plain))
    for again in (copy.copy(told), copy.deepcopy(told), pickle.loads(pickle.dumps(told))):
        assert again == plain and type(again) is type(told)


def test_a_term_is_not_its_text() -> None:
    told: Value = as_answer(Term("broken", ("egg1",)))
    assert told != "broken(egg1)" and str(told) == "broken(egg1)"
    assert as_answer(Variable("X")) != "X"
    assert as_answer(Term("-", (0.5, 2.0))) != {"start": 0.5, "end": 2.0}


def test_a_number_of_numpy_is_told_as_a_number() -> None:
    assert format_value(np.float64(3.5)) == "3.5"
    assert format_value(Term("lifting", ("hand1", np.float64(0.1)))) == "lifting(hand1,0.1)"

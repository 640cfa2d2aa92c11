"""Answers as JSON."""

from __future__ import annotations

import json

import prolepsis
from prolepsis.log.timeline import Fact, make_timeline


def test_answers_can_be_written_as_json() -> None:
    fact = Fact(kind="fluent", type="broken", args=("egg1",), start=0.1 + 0.2, end=2.0, evidence={})
    timeline = make_timeline([fact], dt=1e-3, duration=2.0)
    answers = timeline.ask("holds(F, T), L = [F, 1, T]")
    when = {"start": 0.3, "end": 2.0}
    assert json.loads(json.dumps(prolepsis.json_value(answers))) == [
        {"F": "broken(egg1)", "T": when, "L": ["broken(egg1)", 1, when]}
    ]
    assert prolepsis.json_value(prolepsis.parse_term("a - b")) == "a-b"


def test_a_number_that_json_has_no_sign_for_is_the_text_that_prolog_writes() -> None:
    answers = make_timeline([], dt=1e-3, duration=2.0).ask("X is inf, Y is nan, Z = [X, 1.5]")
    text = json.dumps(prolepsis.json_value(answers), allow_nan=False)
    assert json.loads(text) == [{"X": "1.0Inf", "Y": "1.5NaN", "Z": ["1.0Inf", 1.5]}]

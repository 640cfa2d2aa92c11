"""A scenario is written down in Python as in a file: the plan as text, the situation as Turtle or as files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import prolepsis
from prolepsis.projection import Projection, project
from prolepsis.scenario.scenario import Parameter, Scenario
from prolepsis.terms.errors import InputError, PlanError, ScenarioError
from prolepsis.terms.reader import parse_term

TURTLE = ":floor a :Floor . :table1 a :Table . :egg1 a :Egg ; :on :table1 ."
PREFIX = "@prefix : <https://w3id.org/prolepsis#> .\n"


def test_a_plan_given_as_text_is_a_plan() -> None:
    given = Scenario(situation=TURTLE, plan="wait(Time)", parameters={"Time": Parameter(0.05, "s")})
    assert given.plan == parse_term("wait(Time)")
    assert given.bound_plan() == prolepsis.Term("wait", (0.05,))


def test_a_text_that_is_no_plan_is_refused() -> None:
    with pytest.raises(PlanError, match="scenario: plan: syntax error at column 6"):
        Scenario(situation=TURTLE, plan="wait(")


@pytest.mark.parametrize("text", [TURTLE, PREFIX + TURTLE, PREFIX.replace("@prefix", "PREFIX")[:-3] + "\n" + TURTLE])
def test_a_situation_given_as_text_is_turtle(text: str) -> None:
    assert Scenario(situation=text, plan="wait(0.1)").knowledge_base().is_a("egg1", "Egg")


def test_texts_and_files_make_one_situation(tmp_path: Path) -> None:
    file = tmp_path / "table.ttl"
    file.write_text(PREFIX + ":floor a :Floor . :table1 a :Table .")
    situation = [file, ":egg1 a :Egg ; :on :table1 .", ":cup1 a :Cup ; :on :table1 ."]
    assert {"table1", "egg1", "cup1"} <= set(Scenario(situation=situation, plan="wait(0.1)").knowledge_base().objects)


def test_what_was_given_as_text_is_saved_and_is_the_same_run_again(tmp_path: Path) -> None:
    given = Scenario(situation=[TURTLE, ":cup1 a :Cup ; :on :table1 ; :x 0.2 ."], plan="wait(0.01)", duration=0.02)
    first = project(given, out=tmp_path / "out")
    again = Projection.load(tmp_path / "out")
    assert again.scenario.plan == given.plan
    assert project(again.scenario).timeline == first.timeline


WRONG: list[tuple[Any, type[InputError], str]] = [
    (3, ScenarioError, "scenario: situation: 3 is none; allowed: a Path of a Turtle file"),
    ([None], ScenarioError, "situation: None is none"),
    ("egg.ttl", ScenarioError, r"situation: 'egg.ttl' is no Turtle; a file is given as Path\('egg.ttl'\)"),
    (":egg1 a :Eg .", InputError, "situation.ttl:1: no class named 'Eg'"),
    ([TURTLE, "\n:cup1 a :Cap ."], InputError, "situation_2.ttl:2: no class named 'Cap'"),
]


@pytest.mark.parametrize(("situation", "error", "message"), WRONG)
def test_what_is_no_situation_is_refused(situation: Any, error: type[InputError], message: str) -> None:
    with pytest.raises(error, match=message):
        Scenario(situation=situation, plan="wait(0.1)").knowledge_base()

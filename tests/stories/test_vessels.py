"""What is in a bowl or a cup, and what only stands on an upturned one, through the whole pipeline."""

from __future__ import annotations

import pytest
from tests.scenes import scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.fluents import recognize
from prolepsis.log.timeline import Timeline
from prolepsis.programs import read_program
from prolepsis.terms.reader import parse_term

ON_THE_TABLE = """:floor a :Floor . :table1 a :Table .
:bowl1 a :Bowl ; :on :table1 . :egg1 a :Egg ; :on :bowl1 .
:cup1 a :Cup ; :x 0.25 ; :on :table1 . :ball1 a :Ball ; :on :cup1 ; :radius 0.02 .
:cup2 a :Cup ; :x -0.25 ; :roll 180.0 ; :z 0.7905 .
:block1 a :Block ; :on :cup2 ; :length 0.05 ; :width 0.05 ; :height 0.05 .
"""


@pytest.fixture(scope="module")
def timeline() -> Timeline:
    known = scene(ON_THE_TABLE)
    log = simulate(compile_world(known), read_program(parse_term("wait(0.5)"), known))
    return recognize(log, domain=known.domain)


def test_vessels_contain_what_lies_in_them(timeline: Timeline) -> None:
    found = {(answer["C"], answer["X"]) for answer in timeline.ask("holds_at(contains(C,X), 0.8)")}
    assert found == {("bowl1", "egg1"), ("cup1", "ball1"), ("egg1", "white1"), ("egg1", "yolk1")}


def test_an_upturned_cup_supports_and_contains_nothing(timeline: Timeline) -> None:
    assert timeline.ask("holds_at(supports(cup2,block1), 0.8), holds_at(supports(table1,cup2), 0.8)")
    assert not timeline.ask("holds(contains(cup2,_), _)")


def test_lying_in_a_bowl_breaks_no_egg(timeline: Timeline) -> None:
    assert not timeline.ask("occurs(breaking(_), _)")
    assert timeline.ask("holds_at(supports(bowl1,egg1), 0.8)")

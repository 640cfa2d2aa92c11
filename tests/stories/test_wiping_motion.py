"""Section 4.2 of the paper names a wiping by what wipes and what is wiped."""

from __future__ import annotations

from tests.scenes import scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.fluents import recognize
from prolepsis.programs import read_program
from prolepsis.terms.reader import parse_term

SPONGE_IN_HAND = """:floor a :Floor . :table1 a :Table . :sponge1 a :Sponge ; :on :table1 .
:hand1 a :Gripper ; :pitch 90.0 ; :z 0.727 ; :opening 0.072 .
"""
PLAN = "sequence([grasp(hand1, sponge1, 10, 0.012), wipe(hand1, sponge1, table1, [0.1, 0, 0])])"


def test_wiping_is_an_event_of_the_sponge_and_the_table() -> None:
    known = scene(SPONGE_IN_HAND)
    log = simulate(compile_world(known), read_program(parse_term(PLAN), known))
    timeline = recognize(log, domain=known.domain)
    (answer,) = timeline.ask("occurs(E, T1), eventT(E, wiping), argsOf(E, [sponge1, table1])")
    assert str(answer["E"]) == "wiping(sponge1,table1)"
    assert timeline.ask("occurs(wiping(sponge1, table1), T1), holds(contacts(sponge1, table1), T2), allen(R, T1, T2)")

"""Peeling, which the paper could not do: shell is pulled off a boiled egg with the other gripper."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from prolepsis import project
from prolepsis.projection import read_scenario
from prolepsis.terms.errors import Note
from prolepsis.terms.reader import parse_term

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.laws
def test_shell_comes_off_a_boiled_egg_part_by_part_and_its_kernel_stays_whole() -> None:
    run = project(EXAMPLES / "sheet_peeled.toml")
    (peeling,) = [action for action in run.log.actions if action.term.functor == "peel"]
    # All of it does not come off.
    assert peeling.outcome == "not_reached"
    assert float(peeling.evidence["pieces_off"]) > float(peeling.evidence["pieces"]) / 3
    assert run.ask("holds(broken(egg1), T)")
    with pytest.warns(Note, match="kernel1 is not Breakable"):
        assert not run.ask("holds(broken(kernel1), T)")
    assert not run.ask("holds(spilled(_), T)")
    peeled = "occurs(peeling(rightGripper, leftGripper, egg1, _), P)"
    assert run.ask(f"{peeled}, occurs(falling(X), F), allen(during, F, P)")
    with pytest.warns(Note, match="of 30 pieces"):
        assert run.ask(f"{peeled}, occurs(moving(kernel1), M), after(M, P)") == []


def test_who_does_not_hold_the_egg_does_not_peel_it() -> None:
    scenario = read_scenario(EXAMPLES / "sheet_peeled.toml", {})
    run = project(replace(scenario, plan=parse_term("peel(rightGripper, leftGripper, egg1, 3)"), parameters={}))
    (peeling,) = run.log.actions
    assert peeling.outcome == "not_held"

"""Section 4.1 of the paper, and the wet hand of its figure 7: an egg is grasped with twelve levels of force."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.campaigns.outcome import judge_grasp
from prolepsis.projection import Projection, project

EXAMPLES = Path(__file__).parents[2] / "examples"


def query(level: str) -> str:
    return f"""occurs(E,T1), eventT(E,'ClosingGripper'),
   argsOf(E, [rightGripper, {level}]), holds(F,T2),
   after(T2,T1), fluent(F,Type), argsOf(F,Args)"""


@pytest.fixture(scope="module")
def good() -> Projection:
    return project(EXAMPLES / "grasp_egg.toml", Force="force7")


@pytest.fixture(scope="module")
def crushing() -> Projection:
    return project(EXAMPLES / "grasp_egg.toml", Force="force12")


@pytest.fixture(scope="module")
def wet() -> Projection:
    return project(EXAMPLES / "wet_hand.toml")


def test_after_a_good_grasp_the_egg_is_attached_to_the_gripper(good: Projection) -> None:
    found = {(str(a["Type"]), a["Args"]) for a in good.ask(query("force7"))}
    assert ("attached", ("rightGripper", "egg1")) in found
    assert "broken" not in {kind for kind, _ in found}


def test_the_held_egg_is_whole_and_carried_by_nothing_else(good: Projection) -> None:
    end = good.timeline.duration - 0.001
    assert good.ask(f"holds_at(attached(rightGripper,egg1), {end})")
    assert not good.ask(f"holds_at(supports(_,egg1), {end})")
    assert not good.ask("occurs(breaking(_), _)")
    assert good.ask("occurs(picking_up(rightGripper,egg1), _)")


@pytest.mark.filterwarnings("ignore:near its threshold")
def test_after_a_crushing_grasp_the_egg_is_broken(crushing: Projection) -> None:
    found = {(str(a["Type"]), a["Args"]) for a in crushing.ask(query("force12"))}
    assert ("broken", ("egg1",)) in found
    assert ("attached", ("rightGripper", "egg1")) not in found


def test_the_egg_breaks_while_the_gripper_closes(crushing: Projection) -> None:
    assert crushing.ask("occurs(closingGripper(rightGripper), C), occurs(breaking(egg1), B), allen(during, B, C)")


def test_another_level_has_no_answer(good: Projection) -> None:
    assert good.ask(query("force12")) == []


@pytest.mark.parametrize(
    ("level", "outcome"), [("force1", "slip"), ("force4", "slip"), ("force5", "hold"), ("force8", "crush")]
)
def test_levels_next_to_the_transitions(level: str, outcome: str) -> None:
    projection = project(EXAMPLES / "grasp_egg.toml", Force=level)
    assert judge_grasp(projection.timeline, projection.log).outcome == outcome


def test_held_by_a_wet_hand_the_egg_slips_falls_breaks_and_spills(wet: Projection) -> None:
    assert judge_grasp(wet.timeline, wet.log).outcome == "slip"
    order = """holds(attached(rightGripper,egg1), A), occurs(falling(egg1), F), after(F, A),
       occurs(breaking(egg1), B), after(B, F), holds(spilled(yolk1), S), after(S, F)"""
    assert wet.ask(order)
    assert wet.ask("occurs(dropping(rightGripper,egg1), _)")


def test_the_same_wet_hand_holds_the_egg_when_it_is_carried_gently() -> None:
    gentle = project(EXAMPLES / "wet_hand.toml", Acceleration=0.5)
    assert judge_grasp(gentle.timeline, gentle.log).outcome == "hold"


def test_the_same_level_in_a_dry_hand_holds_the_carried_egg() -> None:
    dry = project(EXAMPLES / "wet_hand.toml", settings={"rightGripper.wet": "false"})
    assert judge_grasp(dry.timeline, dry.log).outcome == "hold"

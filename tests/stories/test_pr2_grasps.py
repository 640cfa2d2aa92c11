"""Section 4.1 of the paper with its robot: a PR2 grasps an egg with a low, a middle and a high level of force."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.campaigns.outcome import judge_grasp
from prolepsis.projection import Projection, project

EXAMPLES = Path(__file__).parents[2] / "examples"

QUERY = """occurs(E,T1), eventT(E,'ClosingGripper'),
   argsOf(E, [rightGripper, {level}]), holds(F,T2),
   after(T2,T1), fluent(F,Type), argsOf(F,Args)"""
"""The paper's, literally."""


@pytest.fixture(scope="module")
def good() -> Projection:
    return project(EXAMPLES / "pr2_grasp.toml", Force="force7")


@pytest.fixture(scope="module")
def crushing() -> Projection:
    return project(EXAMPLES / "pr2_grasp.toml", Force="force12")


def test_after_a_good_grasp_the_egg_is_attached_to_the_gripper(good: Projection) -> None:
    found = {(str(a["Type"]), a["Args"]) for a in good.ask(QUERY.format(level="force7"))}
    assert ("attached", ("rightGripper", "egg1")) in found
    assert "broken" not in {kind for kind, _ in found}
    assert good.ask("occurs(picking_up(rightGripper,egg1), _)")


@pytest.mark.filterwarnings("ignore:near its threshold")
def test_after_a_crushing_grasp_the_egg_is_broken(crushing: Projection) -> None:
    found = {(str(a["Type"]), a["Args"]) for a in crushing.ask(QUERY.format(level="force12"))}
    assert ("broken", ("egg1",)) in found
    assert ("attached", ("rightGripper", "egg1")) not in found
    assert crushing.ask("occurs(closingGripper(rightGripper), C), occurs(breaking(egg1), B), allen(during, B, C)")


def test_the_good_level_holds_and_the_crushing_level_crushes(good: Projection, crushing: Projection) -> None:
    assert judge_grasp(good.timeline, good.log).outcome == "hold"
    assert judge_grasp(crushing.timeline, crushing.log).outcome == "crush"


def test_a_low_level_lets_the_egg_slip() -> None:
    weak = project(EXAMPLES / "pr2_grasp.toml", Force="force3")
    assert judge_grasp(weak.timeline, weak.log).outcome == "slip"
    assert not weak.ask("occurs(breaking(_), _)")


@pytest.mark.laws
@pytest.mark.parametrize(
    ("level", "outcome"), [("force4", "slip"), ("force5", "hold"), ("force7", "hold"), ("force8", "crush")]
)
def test_levels_next_to_the_transitions(level: str, outcome: str) -> None:
    grasped = project(EXAMPLES / "pr2_grasp.toml", Force=level)
    assert judge_grasp(grasped.timeline, grasped.log).outcome == outcome


@pytest.mark.laws
@pytest.mark.parametrize(("wet", "outcome"), [("true", "slip"), ("false", "hold")])
def test_a_wet_gripper_loses_the_egg_that_a_dry_one_holds(wet: str, outcome: str) -> None:
    grasped = project(EXAMPLES / "pr2_grasp_wet.toml", settings={"rightGripper.wet": wet})
    assert judge_grasp(grasped.timeline, grasped.log).outcome == outcome

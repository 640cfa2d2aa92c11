"""The margin of what breaks is how much more it would have come to bear, had it been strong enough: by other runs."""

from __future__ import annotations

import math
from functools import lru_cache

import pytest
from tests.comparing import Compare
from tests.scenes import EGG_IN_HAND, falling_egg, run

from prolepsis.fluents import recognize
from prolepsis.log.log import Log
from prolepsis.log.near import is_near
from prolepsis.log.timeline import Timeline


@lru_cache
def met(speed: float, standing: bool, substep: float, strength: float = 36.0, farther: float = 1.0) -> Log:
    height = speed**2 / (2 * 9.81)
    return run(
        falling_egg(height, standing=standing),
        values={"eggshell1.breakingForce": strength, "eggshell1.shellMembraneStretch": farther * 0.002},
        duration=math.sqrt(2 * height / 9.81) + 0.02,
        max_step=substep,
    )


def margin(timeline: Timeline, type: str) -> float:
    (fact,) = [fact for fact in timeline.select(type=type) if fact.args == ("egg1",)]
    return float(fact.evidence["margin"])


@pytest.mark.parametrize("substep", [1e-3, 5e-5])
@pytest.mark.parametrize("standing", [False, True])
@pytest.mark.parametrize("speed", [0.4, 1.0])
def test_a_blow_has_the_force_that_a_stronger_shell_would_have_borne(
    compare: Compare, speed: float, standing: bool, substep: float
) -> None:
    log = met(speed, standing, substep)
    timeline = recognize(log)
    stronger = met(speed, standing, 5e-5, 400.0)
    assert not len(stronger.detachments.tick)
    borne = float(stronger.contacts.peak.max()) / float(log.detachments.force[0])
    by = "a shell that bears it"
    compare("how far beyond its strength a blow is", margin(timeline, "broken"), borne, by=by, share=0.05)
    (breaking, *_) = timeline.select(type="breaking")
    assert breaking.evidence["margin"] == margin(timeline, "broken")


@pytest.mark.parametrize("substep", [1e-3, 5e-5])
def test_what_opens_has_the_depth_that_a_stretchier_lining_would_have_borne(substep: float) -> None:
    opened = recognize(met(1.2, False, substep))
    deeper = met(1.2, False, 5e-5, farther=10.0)
    assert not recognize(deeper).select(type="open")
    borne = 10 * float(deeper.channels["egg1.pressed_in"].max())
    assert margin(opened, "open") == pytest.approx(borne, rel=0.05)


def test_what_is_nearly_pressed_through_is_nearly_open() -> None:
    timeline = recognize(met(0.84, False, 5e-5))
    assert margin(timeline, "cracked") == margin(timeline, "broken")
    (near,) = [fact for fact in timeline.near_misses if fact.type == "open"]
    assert near.args == ("egg1",)
    assert 0.8 < float(near.evidence["margin"]) < 0.9


@pytest.mark.parametrize(("force", "near"), [(40.0, True), (80.0, False)])
def test_a_grip_has_the_force_that_was_asked_for(force: float, near: bool) -> None:
    log = run(
        EGG_IN_HAND, f"sequence([close(hand1, {force}), hold(hand1, 0.1)])", values={"eggshell1.breakingForce": 36.0}
    )
    (broken,) = [fact for fact in recognize(log).select(type="broken") if fact.args == ("egg1",)]
    assert broken.evidence["margin"] == pytest.approx(force / log.detachments.force[0], rel=0.02)
    assert is_near(broken.evidence) == near

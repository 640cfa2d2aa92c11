"""How far a blow crushes a shell: against the energy that is left when it opens, and the pieces that this reaches."""

from __future__ import annotations

import numpy as np
import pytest
from tests.comparing import Compare
from tests.matter.test_breaking import BEARS, GIRDLE, MASS, POLE, STRETCH, came_of, fallen, opening_speed
from tests.scenes import EGG_IN_HAND, falling_egg, run

from prolepsis.geometry.rotations import matrix
from prolepsis.matter.shells.breaking import Breaking
from prolepsis.matter.shells.crushing_front import across, front_growth
from prolepsis.matter.shells.cutting import ellipsoid_shell
from prolepsis.scene.running import Running

SEMI_AXES = (0.0285, 0.022, 0.022)
THICKNESS = 3.5e-4
COUNT = 30


@pytest.mark.parametrize("beyond", [1.0, 1.3, 5.0, 30.0])
def test_a_front_takes_up_just_the_energy_that_is_left(beyond: float) -> None:
    depth = np.linspace(1.0, front_growth(beyond), 100_001)
    # By the depth at which it opens, and the force there.
    assert np.trapezoid(np.sqrt(depth), depth) == pytest.approx(beyond - 1.0, abs=1e-9)


def pieces_below(depth: float, standing: bool) -> int:
    """Return of how many pieces the middle is less than a depth [m] over the lowest place of a shell."""
    centres = ellipsoid_shell(SEMI_AXES, COUNT, THICKNESS).centres
    heights = SEMI_AXES[0] - centres[:, 0] if standing else SEMI_AXES[2] + centres[:, 2]
    return max(int((heights < depth).sum()), 1)


@pytest.mark.laws
@pytest.mark.parametrize("standing", [False, True])
@pytest.mark.parametrize("speed", [1.4, 2.0, 3.0, 4.0])
def test_a_blow_crushes_a_shell_as_deep_as_its_energy_asks(compare: Compare, speed: float, standing: bool) -> None:
    opening = opening_speed(POLE if standing else GIRDLE)
    beyond = 1.0 + MASS * (speed**2 - opening**2) / 2.0 / (BEARS * STRETCH)
    depth = STRETCH * (1.0 + 1.5 * (beyond - 1.0)) ** (2.0 / 3.0)
    loose = came_of(fallen("standing" if standing else "lying", speed))[1] - 1
    expected = (pieces_below(0.95 * depth, standing), pieces_below(1.05 * depth, standing))
    what = "pieces of 30 that a hard blow crushes (5 % of the depth)"
    compare(what, loose, expected, by="energy of the blow and of a growing rim")


def test_what_comes_loose_is_not_within_what_has_pressed_it_in() -> None:
    log = fallen("lying", 2.0)
    tick = int(log.detachments.tick[-1]) + 1
    bodies: list[int] = np.unique(log.carrier[-1]).tolist()
    lowest: list[float] = []
    for i in bodies:
        thing, pose = log.things[i], log.poses[tick, i]
        if "Piece" in thing.roles:
            corners = np.array(thing.shape.geoms[0].vertices)
            lowest.append(float((corners @ matrix(pose[3:]).T + pose[:3])[:, 2].min()))
    # One was 2 mm deep. The thin edges of others may come some tenths in within a tick.
    assert min(lowest) > -5e-4


def test_what_is_behind_a_front_is_a_weight_or_what_a_motor_gives(monkeypatch: pytest.MonkeyPatch) -> None:
    driven: dict[str, float] = {}
    usual = Breaking.end_tick

    def told(breaking: Breaking, state: Running) -> None:
        usual(breaking, state)
        geom = int(state.model.geom("egg1/0").id)
        for contact, *_ in state.normal_forces():
            other, _ = across(state, geom, contact)
            driven[state.scene.things[other].name] = max(
                state.driving_force(each, contact) for each in state.touching()[contact]
            )

    monkeypatch.setattr(Breaking, "end_tick", told)
    run(falling_egg(-1e-6), duration=0.5)
    assert driven["floor"] == pytest.approx(MASS * 9.81, rel=0.01)
    run(EGG_IN_HAND, "close(hand1, 20)", duration=1.4)
    assert driven["hand1/left_finger"] == pytest.approx(20.0, rel=0.1)

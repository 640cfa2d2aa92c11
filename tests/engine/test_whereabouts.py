"""Where a thing is and how fast it goes is logged of a hand, of what has fallen apart, and of a liquid, too."""

from __future__ import annotations

import numpy as np
import pytest
from tests.scenes import EGG_IN_HAND, falling_egg, run


def test_a_hand_s_speed_and_height_are_those_of_what_is_between_its_pads() -> None:
    log = run(EGG_IN_HAND, "lift(hand1, 0.1)", monitors={"hand1": ["speed", "height"]})
    height, speed = log.channels["hand1.height"], log.channels["hand1.speed"]
    palm = log.poses[:, log.index("hand1/palm"), 2]
    assert height[0] == pytest.approx(0.722) and height[-1] == pytest.approx(0.822, abs=1e-3)
    assert height == pytest.approx(palm, abs=1e-9)
    assert speed.max() > 0.1 and speed[0] == pytest.approx(0.0, abs=1e-6)
    assert float(np.sum(speed) * log.dt) == pytest.approx(0.1, rel=0.05)


def test_a_broken_egg_is_in_the_middle_of_its_shell_and_its_content_where_it_flows() -> None:
    log = run(falling_egg(0.6), duration=0.6, monitors={"egg1": ["height", "speed"], "yolk1": ["height", "speed"]})
    assert len(log.detachments.tick)
    egg, yolk = log.channels["egg1.height"], log.channels["yolk1.height"]
    assert egg[0] == pytest.approx(0.622) and egg[-1] < 0.03
    assert yolk[0] == pytest.approx(0.622, abs=0.005) and 0.0 < yolk[-1] < 0.04
    assert np.abs(np.diff(egg)).max() < 0.01, "it does not jump when it breaks"
    before = slice(100, 300)
    assert log.channels["yolk1.speed"][before] == pytest.approx(log.channels["egg1.speed"][before], abs=0.2)

"""What lasts for about the least time that counts is near its threshold, and what lasts for less a near miss."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fluents.liquids import DT, EVERY, D, block, puddle, table, vessel, wet

from prolepsis.fluents import recognize
from prolepsis.log.near import is_near
from prolepsis.log.timeline import Timeline

FRAMES = 50


def splash(frames: int, share: float = 0.2, begins: int = 20) -> Timeline:
    """Return the timeline of a puddle of which a share is in the air for some frames."""
    lying = puddle(half=0.02, layers=2)
    path = np.tile(lying, (FRAMES, 1, 1))
    thrown = np.arange(round(share * len(lying)))
    time = np.arange(frames)
    height = 0.2 - 0.01 * np.abs(time - (frames - 1) / 2)
    path[begins : begins + frames, thrown, 2] += height[: FRAMES - begins, None]
    path[begins : begins + frames, thrown, 0] += 0.03 * time[: FRAMES - begins, None]
    path[begins + frames :, thrown, 0] += 0.03 * frames
    return recognize(wet([table()], {"liq1": path}, ticks=FRAMES * EVERY))


@pytest.mark.parametrize(("frames", "margin"), [(3, 1.2), (4, 1.6), (6, 2.4)])
def test_a_splash_has_its_time_in_the_air_as_margin(frames: int, margin: float) -> None:
    timeline = splash(frames)
    (fact,) = timeline.select(type="inFlight")
    assert fact.evidence["margin"] == pytest.approx(margin)
    assert is_near(fact.evidence) == (margin <= 1.2)


@pytest.mark.parametrize(("frames", "nearly"), [(1, False), (2, True)])
def test_a_splash_that_lands_too_soon_was_nearly_in_flight(frames: int, nearly: bool) -> None:
    timeline = splash(frames)
    assert not timeline.select(type="inFlight")
    missed = [fact.evidence["margin"] for fact in timeline.near_misses if fact.type == "inFlight"]
    assert missed == ([pytest.approx(0.8)] if nearly else [])


def test_of_a_long_one_its_share_tells_and_of_what_the_log_cuts_too() -> None:
    (fact,) = splash(12, share=0.06).select(type="inFlight")
    assert fact.evidence["margin"] == pytest.approx(fact.evidence["fraction_mean"] / 0.02, rel=0.1)  # type: ignore[operator]
    (fact,) = splash(3, share=0.06, begins=FRAMES - 3).select(type="inFlight")
    assert fact.evidence["margin"] == pytest.approx(fact.evidence["fraction"] / 0.02)  # type: ignore[operator]


@pytest.mark.parametrize("level", [0.9, 1.5])
def test_what_is_there_for_one_frame_alone_is_no_near_miss_whatever_its_share(level: float) -> None:
    """A drop passes through a cup's pool within a frame, 20 ms of the 50 that count."""
    drop = block((0.0, 0.0, 0.0), (3 * D, 3 * D, 3 * D)) + [0.0, 0.0, 0.01]
    rest = puddle(half=0.05, layers=2)
    count = max(1, round(level * 0.02 * (len(rest) + len(drop))))
    path = np.tile(np.concatenate([drop[:count], rest]), (FRAMES, 1, 1))
    outside = np.arange(FRAMES) != FRAMES // 2
    path[outside, :count, 2] += 0.3
    timeline = recognize(wet([table(), vessel()], {"liq1": path}, ticks=FRAMES * EVERY))
    assert not timeline.select(type="contains")
    assert not [fact for fact in timeline.near_misses if fact.type == "contains"]
    assert DT * EVERY < 0.05

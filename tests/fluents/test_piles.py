"""What lies on or clings to particles that lie on a surface lies there, too; what flies by does not."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fluents.liquids import HEIGHT, RADIUS, WALL, D, judged, poured, vessel

from prolepsis.fluents.kernels.locations import RESTING
from prolepsis.fluents.kernels.piles import pile_up

SPACING = 0.005
FRAME = 20
"""[ticks of 1 ms]"""


@pytest.mark.parametrize(
    ("offset", "speed", "lies"),
    [
        ((0.0, 0.9), 0.0, True),  # on top
        ((0.95, 0.1), 0.0, True),  # the flank of a heap
        ((0.95, -0.1), 0.0, True),
        ((0.95, 0.1), 0.5, False),  # a stream that comes down beside it
        ((0.0, 0.9), 0.5, False),
        ((1.5, 0.1), 0.0, False),  # a drop at the top of its flight
    ],
)
def test_a_particle_lies_with_those_that_it_touches_as_slowly(
    offset: tuple[float, float], speed: float, lies: bool
) -> None:
    position = np.zeros((3, 3, 3), dtype=np.float32)
    position[:, 1:, 0], position[:, 1:, 2] = offset[0] * SPACING, offset[1] * SPACING
    # A third one clings to the second.
    position[:, 2, 0] += SPACING
    position[:, 1:, 2] -= (np.arange(-1, 2) * FRAME * 1e-3 * speed)[:, None]
    manner, on = np.zeros((3, 3), dtype=np.uint8), np.full((3, 3), -1, dtype=np.int16)
    manner[:, 0], on[:, 0] = RESTING, 7
    look = np.ones((3, 3), dtype=np.bool_)
    tick = np.arange(3, dtype=np.int64) * FRAME
    pile_up(position, tick, 1e-3, look, np.array([0.0, 0.0, 1.0]), 1.2 * SPACING, 0.1, manner, on)
    assert manner[1].tolist() == [RESTING, *(RESTING * lies,) * 2]
    assert on[1].tolist() == [7, *(7 if lies else -1,) * 2]


@pytest.mark.parametrize(
    ("radius", "height", "speed", "spilled"),
    [
        (RADIUS - WALL / 2, HEIGHT + D / 2, 0.05, False),  # flows over the rim
        (RADIUS - WALL / 2, HEIGHT + D / 2, 0.0, True),  # lies on the rim
        (RADIUS + D / 2, HEIGHT / 2, 0.05, True),  # runs down the outer wall
    ],
)
def test_what_flows_over_a_rim_is_neither_in_the_cup_nor_spilled_yet(
    radius: float, height: float, speed: float, spilled: bool
) -> None:
    turned = np.arange(25)[:, None] * 0.02 * speed / radius + np.linspace(0, 2 * np.pi, 120, endpoint=False)
    # It goes round: what there is of it is the same in every frame.
    ring = np.stack([radius * np.cos(turned), radius * np.sin(turned), np.full_like(turned, height)], axis=2)
    inside = np.broadcast_to(poured(high=HEIGHT / 2), (25, *poured(high=HEIGHT / 2).shape))
    said = judged([vessel()], {"liq1": np.concatenate([inside, ring], axis=1)})
    assert "contains(cup1,liq1)" in said
    assert ("spilled(liq1)" in said) == spilled

"""Turning the hand about its forward axis: what it holds tilts."""

from __future__ import annotations

import math

import numpy as np

from prolepsis.log.things import Thing
from prolepsis.programs.action import HAND, ParameterSpec, action
from prolepsis.programs.moving.following import follow
from prolepsis.programs.moving.profile import course
from prolepsis.robots.commands import Behaviour, Sense
from prolepsis.scene.scene import Scene

ANGLE = ParameterSpec(name="angle", kind="angle")
RATE = ParameterSpec(name="rate", kind="rate", default=math.radians(30.0))


@action(HAND, ANGLE, RATE)
def tilt(scene: Scene, sense: Sense, *, hand: Thing, angle: float, rate: float) -> Behaviour:
    """Turn the hand about its forward axis to an angle, to its right if positive; 0 is upright again."""
    del scene
    state = sense.hands[hand.name]
    yaw, pitch, start = state.rotation
    angles = course(start, angle, rate)
    rotations = np.stack([np.full(len(angles), yaw), np.full(len(angles), pitch), angles], axis=1)
    return (yield from follow(hand, sense, np.tile(state.offset, (len(angles), 1)), rotations))

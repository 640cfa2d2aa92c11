"""``closingGripper(g)`` and ``openingGripper(g)``: the fingers of g are being brought together, or apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.agents.actions import argument_of
from prolepsis.fluents.intervals import debounce, ticks_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.log.timeline import Argument, Fact

FINGER_SPEED = 0.002
"""Speed of the gap between two fingers [m/s] above which a gripper without a logged state opens or closes."""
FINGER_WINDOW = 0.02
"""Time over which that speed is taken [s]."""
STUTTER = 0.02
"""Pause of the fingers that is not noticed [s]."""
FORCE_ACTIONS = ("grasp", "close")
"""Actions whose force is the commanded level."""


@event("closingGripper", "g")
def closing_gripper(observation: Observation) -> Iterator[Fact]:
    """The robot closes the gripper: its fingers come together or press; evidence level is the commanded force."""
    yield from _working(observation, "closingGripper", -1.0)


@event("openingGripper", "g")
def opening_gripper(observation: Observation) -> Iterator[Fact]:
    """The robot opens the gripper: its fingers are driven apart."""
    yield from _working(observation, "openingGripper", 1.0)


def _working(observation: Observation, type: str, sign: float) -> Iterator[Fact]:
    for gripper, state in observation.of(gripper_states).items():
        for start, end in debounce(state == sign, observation.dt, gap=STUTTER):
            evidence = _evidence(observation, gripper, int(start), int(end), closing=sign < 0)
            yield observation.fact("event", type, (gripper,), (start, end), evidence)


def gripper_states(observation: Observation) -> dict[str, FloatArray]:
    """Return what each gripper does, by name: 1 opening, -1 closing, 0 neither, shape (T,).

    The controller's own state is taken if the log has it, else the gap between the two fingers.
    """
    found = {
        name.removesuffix(".gripper"): series
        for name, series in observation.log.channels.items()
        if name.endswith(".gripper")
    }
    for unit in observation.units:
        name = observation.unit_names[unit]
        fingers = _fingers(observation, unit) if observation.has_role(unit, "Gripper") else []
        if name not in found and len(fingers) == 2:
            found[name] = _from_gap(observation, fingers)
    return found


def _fingers(observation: Observation, unit: int) -> list[int]:
    """Return the parts of a gripper that are told to be of class Finger; if none is, the bodies in which it ends."""
    parts = [i for i in np.flatnonzero(observation.unit == unit).tolist() if i != unit]
    return [i for i in parts if observation.has_role(i, "Finger")] or _ends(observation, unit)


def _ends(observation: Observation, unit: int) -> list[int]:
    """Return the rigid bodies of a unit, but itself, that have no other one as a part."""
    things, bodies = observation.log.things, observation.bodies(unit)
    whole = {thing.name: thing.whole for thing in things}
    bearing: set[str | None] = set()
    for body in bodies:
        above = things[body].whole
        while above is not None and above not in bearing:
            bearing.add(above)
            above = whole.get(above)
    return [body for body in bodies if body != unit and things[body].name not in bearing]


def _from_gap(observation: Observation, fingers: list[int]) -> FloatArray:
    first, second = (observation.log.poses[:, finger, :3] for finger in fingers)
    gap = np.linalg.norm(first - second, axis=1)
    half = ticks_of(FINGER_WINDOW / 2, observation.dt)
    now = np.arange(len(gap))
    before, after = np.maximum(now - half, 0), np.minimum(now + half, len(gap) - 1)
    speed = (gap[after] - gap[before]) / (np.maximum(after - before, 1) * observation.dt)
    moving: BoolArray = np.abs(speed) > FINGER_SPEED
    return np.where(moving, np.sign(speed), 0.0)


def _evidence(observation: Observation, gripper: str, start: int, end: int, *, closing: bool) -> dict[str, float | str]:
    evidence: dict[str, float | str] = {}
    level = commanded_level(observation, gripper, start, end) if closing else None
    if level is not None:
        evidence["level"] = level if isinstance(level, str) else float(level)
    for name, channel in (("force", "pad_force"), ("command", "command")):
        series = observation.log.channels.get(f"{gripper}.{channel}")
        if series is not None:
            evidence[name] = float(series[start:end].max())
    opening = observation.log.channels.get(f"{gripper}.opening")
    if opening is not None:
        # Between pads that press on each other there is no gap.
        evidence["opening_before"] = max(float(opening[start]), 0.0)
        evidence["opening_after"] = max(float(opening[min(end, len(opening) - 1)]), 0.0)
    return evidence


def commanded_level(observation: Observation, gripper: str, start: int, end: int) -> Argument | None:
    """Return the force that the action running over the ticks commands of a gripper: a name, or a number [N]."""
    best: tuple[int, Argument] | None = None
    for action in observation.log.actions:
        force = action.arguments.get("force")
        if action.term.functor not in FORCE_ACTIONS or action.arguments.get("hand") != gripper or force is None:
            continue
        common = min(action.end, end) - max(action.start, start)
        if common > 0 and (best is None or common > best[0]):
            best = common, argument_of(force)
    return None if best is None else best[1]

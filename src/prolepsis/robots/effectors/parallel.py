"""A parallel gripper: two fingers that move alike on a palm, each with a pad, and one motor for both."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from pydantic.dataclasses import dataclass

from prolepsis.geometry.shape import FloatArray
from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.effectors.gripper_control import GripperControl
from prolepsis.robots.effectors.kind import EffectorKind, effector
from prolepsis.robots.effectors.pinching import (
    add_drive,
    half_open,
    moved_bodies,
    open_by_growing,
    pad_distance,
    pinching,
    pinching_drive,
    refuse_bare_pads,
    tabulated,
    tool_pose,
)
from prolepsis.robots.parts import follow_couplings, pad_geoms
from prolepsis.scenario.own_robot import STRICT, Name, OwnGripper
from prolepsis.scene.robot import Effector
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError

ALIKE = 1.0e-3
"""Ranges of two fingers may differ by this share."""
COUPLING_SOLREF, COUPLING_SOLIMP = (0.004, 1.0), (0.99, 0.9999, 0.001, 0.5, 2.0)
"""Of what couples fingers: as stiff as a linkage, or a tenth of the pad force is lost."""


@dataclass(frozen=True, kw_only=True, slots=True, config=STRICT)
class ParallelTable:
    """The keys of a parallel gripper."""

    fingers: tuple[Name, Name]
    """The joints of its fingers."""
    pads: tuple[Name, Name] | None = None
    """Bodies that carry the pads, or geoms that are them; the bodies of the fingers' joints if None."""

    def surfaces(self, model: Any) -> tuple[str, str]:
        """Return the names of the pads."""
        if self.pads is not None:
            return self.pads
        first, second = (model.body(int(model.jnt_bodyid[model.joint(each).id])).name for each in self.fingers)
        return first, second


@effector
class Parallel(EffectorKind[ParallelTable]):
    """Two fingers whose pads stay parallel: what is between is held in the middle, at any width."""

    name = "parallel"
    table = ParallelTable

    def fit(self, spec: Any, model: Any, table: ParallelTable, given: OwnGripper, where: str) -> tuple[str, ...]:
        """Let both fingers open when their joints grow, by the same amount."""
        moved = moved_bodies(model, given.palm, table.fingers, table.pads or (), "fingers", "finger", where)
        if moved[0] == moved[1]:
            raise ScenarioError(
                f"{where}: fingers: two joints of two fingers are needed, {table.fingers} move one body"
            )
        pads = table.surfaces(model)
        refuse_bare_pads(model, pads, where)
        ranges = [open_by_growing(spec, model, finger, pads, "finger", where) for finger in table.fingers]
        (low, high), (other_low, other_high) = ranges
        if max(abs(low - other_low), abs(high - other_high)) > ALIKE * (high - low):
            raise ScenarioError(
                f"{where}: its fingers do not move alike: {table.fingers[0]} by {low:g} to {high:g}, "
                f"{table.fingers[1]} by {other_low:g} to {other_high:g} when opening; allowed: the same range"
            )
        for each in list(spec.equalities):
            if each.type == mujoco.mjtEq.mjEQ_JOINT:
                each.solref, each.solimp = list(COUPLING_SOLREF), list(COUPLING_SOLIMP)
                coupled = {each.name1, each.name2} == {*table.fingers}
                if coupled and list(each.data[:5]) != [0.0, 1.0, 0.0, 0.0, 0.0]:
                    raise ScenarioError(f"{where}: the model couples its fingers otherwise than by opening alike")
        return table.fingers

    def read(
        self, spec: Any, model: Any, joints: tuple[str, ...], table: ParallelTable, given: OwnGripper, where: str
    ) -> Effector:
        """Return the gripper; the y axis of its frame goes from the second pad to the first."""
        data = mujoco.MjData(model)
        for finger in joints:
            data.joint(finger).qpos[0] = model.joint(finger).range[1]
        follow_couplings(model, data)
        mujoco.mj_kinematics(model, data)
        pads, palm = table.surfaces(model), model.body(given.palm).id
        middles = [np.mean([data.geom_xpos[g] for g in pad_geoms(model, pad)], axis=0) for pad in pads]
        across: FloatArray = data.xmat[palm].reshape(3, 3).T @ (middles[0] - middles[1])
        return pinching(self.name, model, joints, pads, across, given, where)

    def gap(self, spec: Any, model: Any, effector: Effector, where: str) -> Gap:
        """Return the gap between the geoms of the pads; half open, the pads' middles are at the frame's origin."""
        pads = [pad_geoms(model, pad) for pad in effector.surfaces or effector.pads]
        data = half_open(model, effector, where)
        tool, forward, _ = tool_pose(model, data, effector)
        between = [(pad, data.body(pad).xmat.reshape(3, 3).T @ (tool - data.body(pad).xpos)) for pad in effector.pads]

        def measure(data: Any) -> tuple[float, float, float]:
            moved = [data.body(pad).xpos + data.body(pad).xmat.reshape(3, 3) @ point for pad, point in between]
            return pad_distance(model, data, *pads), float(forward @ (np.mean(moved, axis=0) - tool)), 0.0

        return tabulated(model, effector, measure, where)

    def edit(self, spec: Any, effector: Effector, robot: str, name: str) -> None:
        """Add the motor, and couple the fingers unless the model does."""
        fingers = [f"{robot}/{finger}" for finger in effector.joints]
        drive_coupled(spec, name, fingers)

    def control(self, state: Running, effector: Effector, gap: Gap, robot: str, name: str) -> GripperControl:
        """Return the controller of both fingers."""
        return GripperControl(state, pinching_drive(effector, gap, robot, name))


def drive_coupled(spec: Any, name: str, fingers: Sequence[str]) -> None:
    """Give the two finger joints of the gripper called ``name`` one motor, and couple them unless they are."""
    add_drive(spec, name, fingers)
    if not any({each.name1, each.name2} == {*fingers} for each in spec.equalities):
        spec.add_equality(
            name=f"{name}/coupling",
            type=mujoco.mjtEq.mjEQ_JOINT,
            name1=fingers[0],
            name2=fingers[1],
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            data=[0, 1, *[0] * 10],
            solref=list(COUPLING_SOLREF),
            solimp=list(COUPLING_SOLIMP),
        )

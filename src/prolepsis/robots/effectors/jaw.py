"""A jaw: one pad stands still on the palm, the other one turns on a hinge towards it, as that of the SO-101."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic.dataclasses import dataclass

from prolepsis.geometry.rotations import rotated
from prolepsis.geometry.shape import FloatArray, Triple, quaternion, triple
from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.effectors.gripper_control import Drive, GripperControl
from prolepsis.robots.effectors.kind import EffectorKind, effector
from prolepsis.robots.effectors.pinching import (
    FARTHEST,
    TABLE,
    add_drive,
    moved_bodies,
    open_by_growing,
    pad_distance,
    pinching,
    pinching_drive,
    refuse_bare_pads,
    tabulated,
)
from prolepsis.robots.parts import pad_body, pad_geoms
from prolepsis.scenario.own_robot import STRICT, Name, OwnGripper
from prolepsis.scene.robot import Effector
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError

SPARE = 2.0e-3
"""Room that the pad which stands still leaves to what is about to be held [m]: the other one pushes it there."""
LEAST_RISE = 0.5
"""Where the gap grows with the angle by less than this share of the most [1], at some 60 degrees, a jaw turns away
rather than open."""
ASIDE = 0.7
"""Cosine of the angle between the hinge and what is across forward and pads, below which the jaw turns aside."""
FELT, MOST_FELT = 0.02, 0.4
"""Share by which the lever follows at each tick where the pad is touched [1], and how far from that at the tool [1]."""
PROBE, POINT = "prolepsis_probe", 1.0e-6
"""A point from which distances to pads are measured, and its radius [m]."""


@dataclass(frozen=True, kw_only=True, slots=True, config=STRICT)
class JawTable:
    """The keys of a jaw."""

    jaw: Name
    """The joint that turns it."""
    pads: tuple[Name, Name] | None = None
    """Bodies that carry the pad that stands still and the one that moves, or geoms that are them; those of palm and jaw
    if None."""

    def surfaces(self, model: Any, palm: str) -> tuple[str, str]:
        """Return the names of the pads, the one that stands still first."""
        return self.pads or (palm, model.body(int(model.jnt_bodyid[model.joint(self.jaw).id])).name)


@effector
class Jaw(EffectorKind[JawTable]):
    """A fixed jaw and a moving one, whose pads are not parallel: what is between is pinched at the fixed one.

    The gap is how far the moving pad is from the point on the fixed one where things are held. How fast it grows with
    the angle is the lever by which the hinge's torque becomes a pad's force there.
    """

    name = "jaw"
    table = JawTable

    def fit(self, spec: Any, model: Any, table: JawTable, given: OwnGripper, where: str) -> tuple[str, ...]:
        """Let the jaw open when its joint grows."""
        moved = moved_bodies(model, given.palm, (table.jaw,), table.pads or (), "jaw", "jaw", where)
        if int(model.jnt_type[model.joint(table.jaw).id]) != int(mujoco.mjtJoint.mjJNT_HINGE):
            raise ScenarioError(f"{where}: the jaw {table.jaw} slides; allowed: a joint that turns")
        pads = table.surfaces(model, given.palm)
        refuse_bare_pads(model, pads, where)
        bodies = [int(model.body(pad_body(model, pad)).id) for pad in pads]
        if int(model.body_weldid[bodies[0]]) != int(model.body_weldid[model.body(given.palm).id]):
            raise ScenarioError(f"{where}: pads: the first stands still on the palm, {pads[0]} moves")
        if int(model.body_weldid[bodies[1]]) != moved[0]:
            raise ScenarioError(f"{where}: pads: the second moves with the jaw {table.jaw}, {pads[1]} does not")
        low, high = open_by_growing(spec, model, table.jaw, pads, "jaw", where)
        # The damping in the controller is enough; with the joint's own, a guarded closing takes twice the time.
        spec.joint(table.jaw).damping = [0.0, 0.0, 0.0]
        foot = _foot(spec, given.palm, pads[0], given.tool, where)
        spec.joint(table.jaw).range = _range(_with_probe(spec, given.palm, foot), table.jaw, pads, low, high, where)
        return (table.jaw,)

    def read(
        self, spec: Any, model: Any, joints: tuple[str, ...], table: JawTable, given: OwnGripper, where: str
    ) -> Effector:
        """Return the jaw; the y axis of its frame goes from the fixed pad to where it holds."""
        pads = table.surfaces(model, given.palm)
        across = np.array(given.tool) - _foot(spec, given.palm, pads[0], given.tool, where)
        made = pinching(self.name, model, joints, pads, across, given, where)
        hinge = model.joint(table.jaw)
        axis = rotated(quaternion(model.body_quat[model.jnt_bodyid[hinge.id]]), triple(hinge.axis))
        if abs(float(axis @ rotated(made.tool_orientation, (0.0, 0.0, 1.0)))) < ASIDE:
            raise ScenarioError(
                f"{where}: the jaw {table.jaw} turns aside: its axis {[round(float(each), 3) for each in axis]} "
                f"must be across both forward and the way from pad to pad"
            )
        return made

    def gap(self, spec: Any, model: Any, effector: Effector, where: str) -> Gap:
        """Return how far the moving pad is from the point on the fixed one where things are held."""
        fixed, moving = effector.surfaces or effector.pads
        foot = _foot(spec, effector.palm, fixed, effector.tool, where)
        half = float(np.linalg.norm(np.array(effector.tool) - foot))
        probed = _with_probe(spec, effector.palm, foot)

        def measure(data: Any) -> tuple[float, float, float]:
            gap = _gap(probed, data, moving)
            return gap, 0.0, gap / 2 + SPARE - half

        return tabulated(probed, effector, measure, where)

    def edit(self, spec: Any, effector: Effector, robot: str, name: str) -> None:
        """Add the hinge's motor."""
        add_drive(spec, name, [f"{robot}/{joint}" for joint in effector.joints])

    def control(self, state: Running, effector: Effector, gap: Gap, robot: str, name: str) -> JawControl:
        """Return the controller of the moving jaw."""
        return JawControl(state, pinching_drive(effector, gap, robot, name), f"{robot}/{effector.joints[0]}")


class JawControl(GripperControl):
    """The controller of a jaw: its lever is that of the point where the moving pad is touched, as it is felt."""

    def __init__(self, state: Running, drive: Drive, hinge: str) -> None:
        """Take over a jaw as it is."""
        self._hinge = hinge
        super().__init__(state, drive)

    def measure(self, forces: list[tuple[int, int, int, float]]) -> None:
        """Read the pressure of the pads, and about the hinge the moment of what touches the moving one."""
        super().measure(forces)
        data, joint = self._data, self._model.joint(self._hinge).id
        normal, moment, wrench = 0.0, 0.0, np.zeros(6)
        for number, first, second, force in forces:
            if self._pads[1] in (first, second):
                contact = data.contact[number]
                mujoco.mj_contactForce(self._model, data, number, wrench)
                on_pad = contact.frame.reshape(3, 3).T @ wrench[:3] * (1.0 if second == self._pads[1] else -1.0)
                moment += float(data.xaxis[joint] @ np.cross(contact.pos - data.xanchor[joint], on_pad))
                normal += force
        if normal > 0.0:
            felt = moment / (normal * self._drive.gap.lever(self.length))
            felt = min(max(felt, 1.0 - MOST_FELT), 1.0 + MOST_FELT)
            self.share += FELT * (felt - self.share)


def _range(probed: Any, jaw: str, pads: tuple[str, str], low: float, high: float, where: str) -> tuple[float, float]:
    """Return the range of a jaw in which it opens [rad]: from where its pads meet, since a robot does not touch itself,
    to where it turns away rather than apart.

    Raises:
        ScenarioError: If there is none.
    """
    data, geoms = mujoco.MjData(probed), [pad_geoms(probed, pad) for pad in pads]
    angles = np.linspace(low, high, TABLE)
    distances, gaps = np.zeros(TABLE), np.zeros(TABLE)
    for k, angle in enumerate(angles.tolist()):
        data.joint(jaw).qpos[0] = angle
        mujoco.mj_kinematics(probed, data)
        distances[k], gaps[k] = pad_distance(probed, data, *geoms), _gap(probed, data, pads[1])
    first = int(np.flatnonzero(distances <= 0.0).max(initial=-1)) + 1
    rises = np.diff(gaps[first:])
    slow = np.flatnonzero(rises < LEAST_RISE * np.maximum.accumulate(rises))
    last = first + (int(slow[0]) if len(slow) else len(rises))
    if last <= first:
        raise ScenarioError(f"{where}: its pads {pads[0]} and {pads[1]} do not part where the jaw {jaw} opens")
    return float(angles[first]), float(angles[last])


def _gap(probed: Any, data: Any, pad: str) -> float:
    """Return how far the point of a model is from a pad [m]."""
    return pad_distance(probed, data, [probed.geom(PROBE).id], pad_geoms(probed, pad)) + POINT


def _foot(spec: Any, palm: str, pad: str, tool: Triple, where: str) -> FloatArray:
    """Return the point on the fixed pad that is nearest to where things are held, in the palm's frame [m], shape (3,).

    Raises:
        ScenarioError: If things would be held inside the pad.
    """
    probed = _with_probe(spec, palm, tool)
    data = mujoco.MjData(probed)
    mujoco.mj_kinematics(probed, data)
    segments = [np.zeros(6) for _ in pad_geoms(probed, pad)]
    distances = [
        mujoco.mj_geomDistance(probed, data, probed.geom(PROBE).id, geom, FARTHEST, segment)
        for geom, segment in zip(pad_geoms(probed, pad), segments, strict=True)
    ]
    if min(distances) <= 0.0:
        raise ScenarioError(f"{where}: tool must lie between the pads, {list(tool)} is inside {pad}")
    body = data.body(palm)
    return body.xmat.reshape(3, 3).T @ (segments[int(np.argmin(distances))][3:] - body.xpos)


def _with_probe(spec: Any, palm: str, position: Triple | FloatArray) -> Any:
    """Return the model of a robot with a point at a position on its palm [m]."""
    probed = spec.copy()
    probe = probed.body(palm).add_geom(name=PROBE, type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=list(position), mass=0.0)
    probe.size, probe.contype, probe.conaffinity = [POINT, 0.0, 0.0], 0, 0
    return probed.compile()

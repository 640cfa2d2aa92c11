"""Paths of one arm: along given poses, or to a pose by any path on which nothing is touched."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

import numpy as np

from prolepsis.geometry.rotations import angles_of, compose_pose, inverse, relative_pose, rotated, turned
from prolepsis.geometry.shape import FloatArray, IntArray, Quaternion, Triple
from prolepsis.robots.commands import JointPath
from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.inverse import ArmKinematics, Found
from prolepsis.scene.robot import Arm
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco
from prolepsis.system.seeds import scattered

FINEST = 0.03
"""Two postures that are looked at for collisions differ by at most this much in each joint [rad]."""
VIA_HEIGHTS = (0.1, 0.2, 0.3)
"""If the straight way is blocked, the arm goes through a position this far above the goal [m]."""
SEARCHES = 6
"""Searches for a posture start where the arm is, at home, and at so many others between home and the ranges' ends."""
REACH = 0.6
"""These lie up to this share of the way from home to the ends."""
FULL_FREEDOM = 6
"""Joints with which an arm can turn its hand as it likes where it gets to."""
MARGIN, AT_THE_END = 0.1, 3.0
"""A joint nearer to the end of its range [rad] adds this to how uneasy a posture is [rad^2]: no hand goes on evenly."""


class ArmPaths:
    """What a program may ask of one arm."""

    def __init__(
        self, kinematics: ArmKinematics, arm: Arm, gap: Gap, first: Triple, reference: Quaternion, mount: str, palm: str
    ) -> None:
        """Answer for an arm whose gripper was at ``first`` [m] at the start."""
        self.joints: FloatArray = kinematics.home.copy()
        """Commanded coordinates [rad], shape (n,)."""
        self.speeds = kinematics.speeds
        self.accelerations = np.array([joint.acceleration for joint in arm.joints])
        self.turns_freely = len(arm.joints) >= FULL_FREEDOM
        """Whether it can turn the hand as it likes."""
        self._kinematics = kinematics
        self._gap, self._opening_joints = gap, max(len(arm.gripper.joints), 1)
        self._first = first
        self._reference = reference
        self._mount_name, self._palm = mount, palm
        self._starts = _starts(kinematics)
        self._state: Running | None = None
        self._scratch: Any = None
        self._held: tuple[int, int, int, FloatArray] | None = None

    def bind(self, state: Running, addresses: IntArray, links: Collection[int], fingers: Collection[int]) -> None:
        """Look at a model that is new: ``addresses`` of the joints in qpos, bodies up to the palm, and those on it."""
        self._state = state
        self._addresses = addresses
        self._bodies, self._fingers = frozenset((*links, *fingers)), frozenset(fingers)
        joints = [j for j in range(state.model.njnt) if int(state.model.jnt_bodyid[j]) in self._fingers]
        # A palm that is a pad itself is moved by a joint of the arm.
        opening = [int(state.model.jnt_qposadr[j]) for j in joints if int(state.model.jnt_qposadr[j]) not in addresses]
        self._finger_addresses: IntArray = np.array(opening, dtype=np.int64)
        self._mount = int(state.model.body(self._mount_name).id)
        self._scratch = mujoco.MjData(state.model)

    def bearing(self, position: Triple) -> float:
        """Return the yaw from the first orientation in which a position in the world lies from the shoulder [rad]."""
        assert self._state is not None
        shoulder = compose_pose(self._mount_pose(), self._kinematics.shoulder)
        displacement = [a - float(b) for a, b in zip(position, shoulder[:3], strict=True)]
        x, y, _ = rotated(inverse(self._reference), (displacement[0], displacement[1], displacement[2]))
        return float(np.arctan2(y, x))

    def held_at(self, width: float) -> tuple[float, float]:
        """Return where what is ``width`` [m] wide has its middle when it is held, along the hand's x and y [m]."""
        return self._gap.held_at(width)

    def feasible(self, offset: Triple, rotation: Triple) -> Triple:
        """Return the nearest rotation that is possible at an offset: an arm of five joints cannot have all."""
        if self.turns_freely:
            return rotation
        pose, starts = self._seen(np.asarray(offset), np.asarray(rotation)), (self.joints, self._kinematics.home)
        if any(self._kinematics.solve(pose, start).is_there for start in starts):
            return rotation
        yawed = (self._kinematics.solve(pose, start, any_yaw=True) for start in starts)
        return next((self.pose(found.joints)[1] for found in yawed if found.is_there), rotation)

    def pose(self, joints: FloatArray) -> tuple[Triple, Triple]:
        """Return offset and rotation of the hand with the given coordinates [rad], shape (n,)."""
        pose = [float(v) for v in compose_pose(self._mount_pose(), self._kinematics.pose(joints))]
        x, y, z = self._first
        return (pose[0] - x, pose[1] - y, pose[2] - z), angles_of(self._reference, (pose[3], pose[4], pose[5], pose[6]))

    def path(self, offsets: FloatArray, rotations: FloatArray, *, loose: bool = False) -> JointPath:
        """Return the joints along offsets and rotations, each shape (k, 3); ``loose`` ones may be off about the
        vertical where an arm of five joints cannot have them."""
        joints: list[FloatArray] = []
        now = self.joints
        for offset, rotation in zip(offsets, rotations, strict=True):
            pose = self._seen(offset, rotation)
            found = self._kinematics.solve(pose, now, near=now)
            if loose and not found.is_there and not self.turns_freely:
                found = self._kinematics.solve(pose, now, near=now, any_yaw=True)
            if not found.is_there:
                return JointPath(joints=np.array(joints), problem="unreachable", detail=_short_by(found))
            now = found.joints
            joints.append(now)
        return JointPath(joints=np.array(joints))

    def path_to(
        self,
        offset: Triple,
        rotation: Triple,
        ignoring: Collection[str],
        opening: float | None = None,
        held: str | None = None,
    ) -> JointPath:
        """Return how the hand gets to a pose by any path on which nothing is touched, but by its fingers what is
        ignored, with its parts; with its pads ``opening`` [m] apart, or as they are, and with what it holds."""
        assert self._state is not None
        self._scratch.qpos[:] = self._state.data.qpos
        self._hold(held)
        if opening is not None:
            self._scratch.qpos[self._finger_addresses] = self._gap.length(opening) / self._opening_joints
        nearest: Found | None = None
        blocked = ""
        chosen: list[tuple[float, FloatArray]] = []
        for found in self._postures(np.asarray(offset), np.asarray(rotation)):
            if not found.is_there:
                nearest = found if nearest is None or found.distance < nearest.distance else nearest
                continue
            hit = self._touched(found.joints, ignoring)
            blocked = blocked or hit
            if not hit:
                chosen.append((self._strain(found.joints), found.joints))
        for _, joints in sorted(chosen, key=lambda each: each[0]):
            for postures in self._courses(joints, np.asarray(offset), np.asarray(rotation)):
                hit = self._touched_on(postures, ignoring)
                if not hit:
                    return JointPath(joints=np.array(postures))
                blocked = hit
        nowhere = np.zeros((0, len(self.joints)))
        if blocked:
            return JointPath(joints=nowhere, problem="in_collision", detail=blocked)
        assert nearest is not None
        return JointPath(joints=nowhere, problem="unreachable", detail=_short_by(nearest))

    def _hold(self, name: str | None) -> None:
        """Take the thing called ``name``, if it is a body, along in the search."""
        self._held = None
        assert self._state is not None
        state = self._state
        if name is None or state.carrier[state.scene.index(name)] != state.scene.index(name):
            return
        palm = state.model.body(self._palm).id
        hand = np.array([*state.data.xpos[palm], *state.data.xquat[palm]])
        joint = int(state.model.joint(name).qposadr[0])
        self._held = (joint, int(state.model.body(name).id), palm, relative_pose(hand, state.pose(name)))

    def _strain(self, joints: FloatArray) -> float:
        """Return how uneasy a posture is [rad^2]: far from home, near the ends of ranges."""
        away = joints - self._kinematics.home
        margin = np.minimum(joints - self._kinematics.low, self._kinematics.high - joints)
        return float(away @ away) + AT_THE_END * int((margin < MARGIN).sum())

    def _postures(self, offset: FloatArray, rotation: FloatArray) -> Iterator[Found]:
        """Yield solutions from several starts."""
        pose = self._seen(offset, rotation)
        for start in (self.joints, *self._starts):
            yield self._kinematics.solve(pose, start)

    def _courses(self, goal: FloatArray, offset: FloatArray, rotation: FloatArray) -> Iterator[list[FloatArray]]:
        """Yield postures to go through: straight to the goal, or through a position above it."""
        yield [self.joints, goal]
        for height in VIA_HEIGHTS:
            above = self._kinematics.solve(self._seen(offset + (0.0, 0.0, height), rotation), goal)
            if above.is_there:
                yield [self.joints, above.joints, goal]

    def _touched_on(self, postures: list[FloatArray], ignoring: Collection[str]) -> str:
        for start, end in zip(postures[:-1], postures[1:], strict=True):
            count = max(int(np.abs(end - start).max() / FINEST), 1)
            for k in range(1, count + 1):
                hit = self._touched(start + (end - start) * k / count, ignoring)
                if hit:
                    return hit
        return ""

    def _touched(self, joints: FloatArray, ignoring: Collection[str]) -> str:
        """Return what the arm would be inside of with the given joints, or nothing."""
        assert self._state is not None
        model, data = self._state.model, self._scratch
        data.qpos[self._addresses] = joints
        mujoco.mj_kinematics(model, data)
        own_bodies = self._bodies
        if self._held is not None:
            joint, body, palm, seen = self._held
            hand = np.array([*data.xpos[palm], *data.xquat[palm]])
            data.qpos[joint : joint + 7] = compose_pose(hand, seen)
            own_bodies = own_bodies | {body}
            mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_collision(model, data)
        for k in range(data.ncon):
            if data.contact.dist[k] > 0.0:
                continue
            bodies = [int(model.geom_bodyid[g]) for g in data.contact.geom[k]]
            if (bodies[0] in own_bodies) == (bodies[1] in own_bodies):
                continue
            own, other = bodies if bodies[0] in own_bodies else reversed(bodies)
            if own not in self._fingers or not is_of(self._state, other, ignoring):
                return name_of(self._state, other)
        return ""

    def _mount_pose(self) -> FloatArray:
        assert self._state is not None
        data = self._state.data
        return np.array([*data.xpos[self._mount], *data.xquat[self._mount]])

    def _seen(self, offset: FloatArray, rotation: FloatArray) -> FloatArray:
        """Return an offset and a rotation of the hand as a pose seen from the mount, shape (7,)."""
        yaw, pitch, roll = (float(a) for a in rotation)
        position = [f + float(o) for f, o in zip(self._first, offset, strict=True)]
        return relative_pose(self._mount_pose(), np.array([*position, *turned(self._reference, (yaw, pitch, roll))]))


def name_of(state: Running, body: int) -> str:
    """Return what a plan would call a body: of a robot's links, the gripper or the robot that they are parts of."""
    number = int(state.body_thing[body])
    if number < 0:
        return str(state.model.body(body).name)
    thing = state.scene.things[number]
    return thing.whole if thing.kind == "Part" and thing.whole is not None else thing.name


def is_of(state: Running, body: int, wholes: Collection[str]) -> bool:
    """Return whether a body is one of some things, or of what they are made of: a piece of an egg is of the egg."""
    number = int(state.body_thing[body])
    thing = state.scene.things[number] if number >= 0 else None
    while thing is not None and thing.name not in wholes:
        thing = state.scene.thing(thing.whole) if thing.whole is not None else None
    return thing is not None


def _starts(kinematics: ArmKinematics) -> list[FloatArray]:
    """Return postures from which a search may start: home, and others all over the ranges, always the same."""
    home = kinematics.home
    low, high = np.maximum(kinematics.low, home - np.pi), np.minimum(kinematics.high, home + np.pi)
    shares = scattered(SEARCHES, len(home), REACH)
    return [home, *(home + np.where(s > 0, s * (high - home), s * (home - low)) for s in shares)]


def _short_by(found: Found) -> str:
    millimetres, degrees = found.distance * 1000, float(np.degrees(found.angle))
    value, unit = (millimetres, "mm") if found.distance > found.angle else (degrees, "degrees")
    return f"stays {value:.{0 if value >= 1.0 else 1}f} {unit} away"

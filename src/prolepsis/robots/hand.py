"""A free-flying parallel gripper: a palm on six servo joints and two fingers with the PR2's flat pads.

The hand's frame lies between the pads: x points from the palm to the fingertips, y from the right pad to
the left one. Finger masses and the force recipe are the PR2's; the fingers slide instead of turning, so
that the pads stay parallel and the pad force equals the motor force at any opening.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from prolepsis.geometry.rotations import inverse, rotated
from prolepsis.geometry.shape import Geom, Quaternion, Shape, Triple, triple
from prolepsis.log.things import WITHIN, Thing, jointed
from prolepsis.robots.effectors.parallel import drive_coupled
from prolepsis.system.mujoco import mujoco

PART_KIND = "Part"
"""Class of the parts of hands and robots."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Hand:
    """Dimensions, masses and servo gains of a parallel hand.

    Source: PR2 URDF (masses, pads, opening); gains chosen for a 15 Hz bandwidth of the free-flying base.
    """

    palm_mass: float = 0.58
    """[kg]"""
    finger_mass: float = 0.215
    """Finger and fingertip [kg]."""
    pad_half_size: Triple = (0.018, 0.004, 0.011)
    """Half extents of a pad along x, y, z [m]."""
    finger_half_size: Triple = (0.045, 0.005, 0.009)
    """Half extents of the link behind a pad [m]."""
    palm_half_size: Triple = (0.035, 0.065, 0.03)
    """Half extents of the palm [m]."""
    palm_offset: float = -0.135
    """Centre of the palm along x [m]."""
    max_opening: float = 0.09
    """Greatest gap between the pads [m]."""
    max_force: float = 100.0
    """Greatest force of a pad [N]."""
    workspace: float = 1.5
    """Distance from its first position that the hand can reach along each axis [m]."""
    base_force: float = 150.0
    """Greatest force of the base along each axis [N]: what it meets is pushed, not crushed."""
    max_acceleration: float = 30.0
    """Greatest acceleration that is commanded [m/s^2]: with 2 kg held, two thirds of the base's force."""
    max_angular_speed: float = 6.0
    """Greatest rate of turning that is commanded [rad/s]; a human wrist reaches about twice that."""
    position_gain: float = 2.0e4
    """Servo stiffness of the base [N/m]."""
    velocity_gain: float = 400.0
    """Servo damping of the base [N s/m]."""
    rotation_gain: float = 200.0
    """Servo stiffness of the base's rotations [N m/rad]."""
    rotation_damping: float = 4.0
    """Servo damping of the base's rotations [N m s/rad]."""
    opening_gain: float = 4.0e3
    """Servo stiffness of the opening [N/m]."""
    opening_damping: float = 80.0
    """Servo damping of the opening [N s/m]."""

    def things(
        self, name: str, *, position: Triple, orientation: Quaternion, opening: float, friction: float
    ) -> tuple[Thing, ...]:
        """Return the hand and its parts as things.

        Args:
            name: Name of the hand.
            position: Position of the hand's frame [m].
            orientation: Unit quaternion of the hand's frame (w, x, y, z).
            opening: Initial gap between the pads [m].
            friction: Sliding friction of the pads [1].
        """
        total = self.palm_mass + 2 * self.finger_mass
        grey, dark = (0.62, 0.64, 0.68, 1.0), (0.2, 0.21, 0.24, 1.0)
        palm = Shape(
            geoms=(Geom(type="box", size=self.palm_half_size, position=(self.palm_offset, 0, 0)),), colour=grey
        )
        whole = Thing(
            name=name,
            kind="Gripper",
            position=position,
            orientation=orientation,
            mass=total,
            roles=frozenset({"Gripper"}),
            mount=WITHIN,
            quantities={
                "opening": opening,
                "maxOpening": self.max_opening,
                "maxForce": self.max_force,
                "maxPush": self.base_force,
                "maxAcceleration": self.max_acceleration,
                "friction": friction,
            },
        )
        parts = [("palm", palm, 0.0, self.palm_mass)]
        for side, sign in (("left_finger", 1.0), ("right_finger", -1.0)):
            pad, link = self.pad_half_size, self.finger_half_size
            shape = Shape(
                geoms=(
                    Geom(type="box", size=pad, position=(0, sign * pad[1], 0)),
                    Geom(
                        type="box",
                        size=link,
                        position=(-pad[0] - link[0], sign * (pad[1] + link[1]), 0),
                    ),
                ),
                colour=dark,
            )
            parts.append((side, shape, sign * opening / 2, self.finger_mass))
        made = [whole]
        for part, shape, offset, mass in parts:
            aside = rotated(orientation, (0.0, offset, 0.0))
            made.append(
                Thing(
                    name=f"{name}/{part}",
                    kind=PART_KIND,
                    shape=shape,
                    position=triple(np.asarray(position) + aside),
                    orientation=orientation,
                    mass=mass,
                    whole=name,
                    mount=jointed(f"{name}/palm" if part != "palm" else None),
                    quantities={"friction": friction},
                )
            )
        return tuple(made)

    def add_joints(self, spec: Any, name: str, orientation: Quaternion) -> None:
        """Give the bodies of the hand called ``name`` in ``spec`` their joints, coupling and motors."""
        palm = spec.body(f"{name}/palm")
        palm.gravcomp = 1
        for k, axis in enumerate("xyz"):
            world_axis = rotated(inverse(orientation), triple(np.eye(3)[k]))
            joint = palm.add_joint(name=f"{name}/{axis}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=world_axis)
            joint.armature = 0.05
            servo = self._servo(spec, f"{name}/{axis}", self.position_gain, self.velocity_gain)
            servo.forcelimited = True
            servo.forcerange = [-self.base_force, self.base_force]
        for k, axis in enumerate(("yaw", "pitch", "roll")):
            joint = palm.add_joint(name=f"{name}/{axis}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=np.eye(3)[2 - k])
            joint.armature = 0.005
            self._servo(spec, f"{name}/{axis}", self.rotation_gain, self.rotation_damping)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            finger = spec.body(f"{name}/{side}_finger")
            finger.gravcomp = 1
            finger.add_joint(
                name=f"{name}/{side}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=(0.0, sign, 0.0), armature=0.01
            )
        drive_coupled(spec, name, [f"{name}/left", f"{name}/right"])

    def _servo(self, spec: Any, joint: str, gain: float, damping: float) -> Any:
        servo = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.gaintype = mujoco.mjtGain.mjGAIN_FIXED
        servo.biastype = mujoco.mjtBias.mjBIAS_AFFINE
        servo.gainprm[0] = gain
        servo.biasprm[1] = -gain
        servo.biasprm[2] = -damping
        return servo


HAND = Hand()
"""The hand with the PR2's pads."""

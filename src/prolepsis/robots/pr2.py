"""The PR2: an omnidirectional base, a lifting torso, a pan-tilt head and two seven-joint arms with parallel grippers.

Source: the joints' ranges, efforts and speeds are those of its URDF; servo gains and accelerations are ours: the
stiffest that the efforts carry, and what the efforts can accelerate with the arm stretched out.
"""

from __future__ import annotations

from pathlib import Path

from prolepsis.scene.robot import Arm, Effector, Joint, Robot

_ARM = (
    # name, speed [rad/s], acceleration [rad/s^2], stiffness [N m/rad], damping [N m s/rad], home of the left arm [rad]
    ("shoulder_pan", 2.088, 10.0, 4000.0, 160.0, 0.6),
    ("shoulder_lift", 2.082, 10.0, 4000.0, 160.0, 0.4),
    ("upper_arm_roll", 3.27, 15.0, 1500.0, 40.0, 1.2),
    ("elbow_flex", 3.3, 15.0, 1500.0, 40.0, -1.6),
    ("forearm_roll", 3.6, 30.0, 400.0, 6.0, 0.0),
    ("wrist_flex", 3.078, 30.0, 400.0, 6.0, -0.9),
    ("wrist_roll", 3.6, 30.0, 200.0, 3.0, 0.0),
)
MIRRORED = frozenset({"shoulder_pan", "upper_arm_roll"})
"""Joints whose home has the other sign on the right."""


def _arm(side: str, name: str) -> Arm:
    joints = tuple(
        Joint(
            name=f"{side}_{joint}_joint",
            speed=speed,
            acceleration=acceleration,
            stiffness=stiffness,
            damping=damping,
            home=-home if side == "r" and joint in MIRRORED else home,
        )
        for joint, speed, acceleration, stiffness, damping, home in _ARM
    )
    gripper = Effector(
        kind="parallel",
        palm=f"{side}_gripper_palm_link",
        joints=(f"{side}_gripper_l_finger_joint", f"{side}_gripper_r_finger_joint"),
        pads=(f"{side}_gripper_l_finger_tip_link", f"{side}_gripper_r_finger_tip_link"),
        tool=(0.18, 0.0, 0.0),
        max_force=100.0,
    )
    # Two thirds of a metre from the shoulder: 30 N m push 45 N there, and 2.1 rad/s are 1.4 m/s.
    return Arm(name=name, joints=joints, gripper=gripper, max_push=45.0, max_speed=1.4, max_acceleration=8.0)


PR2 = Robot(
    kind="PR2",
    file=Path(__file__).with_name("pr2.xml"),
    arms=(_arm("r", "rightGripper"), _arm("l", "leftGripper")),
    base=(
        Joint(name="base_x", speed=1.0, acceleration=0.5, stiffness=2.0e5, damping=1.2e4),
        Joint(name="base_y", speed=1.0, acceleration=0.5, stiffness=2.0e5, damping=1.2e4),
        Joint(name="base_yaw", speed=1.0, acceleration=1.0, stiffness=5.0e4, damping=3.0e3),
    ),
    torso=(Joint(name="torso_lift_joint", speed=0.013, acceleration=0.1, stiffness=2.0e5, damping=5.0e3, home=0.2),),
    head=(
        Joint(name="head_pan_joint", speed=6.0, acceleration=10.0, stiffness=100.0, damping=4.0),
        Joint(name="head_tilt_joint", speed=5.0, acceleration=10.0, stiffness=100.0, damping=4.0, home=0.6),
    ),
    camera="head_camera",
)
"""The PR2 of the paper's experiments."""

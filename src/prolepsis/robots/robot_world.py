"""Robots in a world: the model is attached under the robot's name, its joints get servos, its geoms contact rules."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

from prolepsis.log.things import Thing
from prolepsis.robots.effectors.kind import KINDS
from prolepsis.robots.model import robot_model
from prolepsis.robots.model_fitting import OTHERS, OWN
from prolepsis.robots.model_shapes import touches
from prolepsis.scene.kind import Building
from prolepsis.scene.robot import Arm, Joint, Robot
from prolepsis.scene.scene import Scene
from prolepsis.system.mujoco import mujoco

FIRST_ARM, MOST_ARMS = 4, 29
"""Contact bit of the first arm, and how many arms have one of their own: MuJoCo has 31 bits."""


def add_robot(spec: Any, robot: Robot, thing: Thing, arms: Sequence[str]) -> None:
    """Attach a robot to a world at the pose of ``thing``, with servos for its joints and motors for its grippers.

    Args:
        spec: The ``mujoco.MjSpec`` of the world.
        robot: What it is.
        thing: The robot in the scene.
        arms: Names of all arms in the world: each touches the others, but neither itself nor its trunk.
    """
    read = robot_model(robot)
    child = read.spec()
    for part in (*child.actuators, *child.keys, *child.sensors):
        child.delete(part)
    frame = spec.worldbody.add_frame(pos=list(thing.position), quat=list(thing.orientation))
    spec.attach(child, prefix=f"{thing.name}/", frame=frame)
    for joint in robot.joints:
        _add_servo(spec, f"{thing.name}/{joint.name}", joint)
    for arm in robot.arms:
        _add_gripper(spec, thing.name, arm)
    _name_geoms(spec, read.model, thing.name)
    _let_arms_touch(spec, robot, thing.name, arms)


def rule_contacts(building: Building, name: str, robot: Robot) -> None:
    """Give the geoms of a robot called ``name`` and of its grippers friction and softness."""
    for body in robot_model(robot).owner:
        thing = building.scene.thing(f"{name}/{body}")
        for k in range(len(thing.shape.geoms)):
            building.rule_contact(building.spec.geom(f"{thing.name}/{k}"), thing, rolls=False)


def posture(robot: Robot, name: str, scene: Scene) -> dict[str, float]:
    """Return the coordinates of a robot's joints at the start, by their names in the world."""
    openings = {arm.name: scene.thing(arm.name).quantities["opening"] for arm in robot.arms}
    _, coordinates = robot_model(robot).at_home(openings)
    return {f"{name}/{joint}": value for joint, value in coordinates.items()}


def _let_arms_touch(spec: Any, robot: Robot, name: str, arms: Sequence[str]) -> None:
    """Give the geoms of each arm, from its first link to the pads, contact bits that the other arms meet."""
    bits = {arm: FIRST_ARM << (number % MOST_ARMS) for number, arm in enumerate(arms)}
    every = sum({*bits.values()})
    firsts: dict[str, str] = {}
    for body, arm in _arms_of_bodies(robot).items():
        firsts.setdefault(arm, f"{name}/{body}")
        for geom in spec.body(f"{name}/{body}").geoms:
            if geom.contype or geom.conaffinity:
                geom.contype, geom.conaffinity = OWN | bits[arm], OTHERS | (every & ~bits[arm])
    # Where arms begin side by side, their models may overlap.
    for a, b in combinations(firsts.values(), 2):
        spec.add_exclude(bodyname1=a, bodyname2=b)


def _arms_of_bodies(robot: Robot) -> dict[str, str]:
    """Return the arm that moves a body, by body, from the trunk outwards; what two of them move is the trunk's."""
    model = robot_model(robot).model
    tops = [(int(model.jnt_bodyid[model.joint(arm.joints[0].name).id]), arm.name) for arm in robot.arms]
    moved_by: list[list[str]] = [[]]
    for body in range(1, model.nbody):
        moved_by.append(moved_by[int(model.body_parentid[body])] + [arm for top, arm in tops if top == body])
    return {model.body(b).name: names[0] for b, names in enumerate(moved_by) if len(names) == 1}


def _add_servo(spec: Any, name: str, joint: Joint) -> None:
    servo = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    servo.gaintype = mujoco.mjtGain.mjGAIN_FIXED
    servo.biastype = mujoco.mjtBias.mjBIAS_AFFINE
    servo.gainprm[0] = joint.stiffness
    servo.biasprm[1] = -joint.stiffness
    servo.biasprm[2] = -joint.damping


def _add_gripper(spec: Any, robot: str, arm: Arm) -> None:
    gripper = arm.gripper
    palm = spec.body(f"{robot}/{gripper.palm}")
    palm.add_site(name=f"{arm.name}/tool", pos=list(gripper.tool), quat=list(gripper.tool_orientation))
    KINDS[gripper.kind].edit(spec, gripper, robot, arm.name)


def _name_geoms(spec: Any, model: Any, robot: str) -> None:
    """Name the geoms that can touch something after their thing and number, as all geoms of a world are."""
    for body in range(1, model.nbody):
        thing = f"{robot}/{model.body(body).name}"
        geoms = [g for g in range(model.ngeom) if int(model.geom_bodyid[g]) == body]
        count = 0
        for made, geom in zip(spec.body(thing).geoms, geoms, strict=True):
            if touches(model, geom):
                made.name = f"{thing}/{count}"
                count += 1

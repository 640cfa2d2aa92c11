"""Robots of a scene: each body of the model is a part of the robot or of one of its grippers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from prolepsis.geometry.rotations import product, rotated
from prolepsis.geometry.shape import Quaternion, Triple, quaternion, triple
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.things import WITHIN, Mount, Thing, jointed
from prolepsis.robots.model import RobotModel, robot_model
from prolepsis.robots.model_shapes import shape_of
from prolepsis.robots.pr2 import PR2
from prolepsis.scene.robot import Robot
from prolepsis.terms.errors import KnowledgeError, ScenarioError, UnknownNameError

KNOWN = {PR2.kind: PR2}
"""Robots that are here, by class."""


def robot_of(kb: KnowledgeBase, name: str, given: Robot | None) -> Robot:
    """Return what the individual ``name`` is: a known robot by its class, or the one that the scenario gives.

    Raises:
        ScenarioError: If neither is there.
    """
    for kind, robot in KNOWN.items():
        if kb.is_a(name, kind):
            return robot
    if given is None:
        raise ScenarioError(f"{name} is a Robot without a model; give the scenario a [robot] table with its file")
    return given


def robot_things(
    kb: KnowledgeBase, robot: Robot, whole: Thing, gripper_thing: Callable[[str], Thing]
) -> tuple[Thing, ...]:
    """Return a robot with its links, then each of its grippers with its own.

    Args:
        kb: The situation.
        robot: What it is.
        whole: The robot as a thing at its pose, without a body.
        gripper_thing: Makes a gripper of the situation a thing without a body.

    Raises:
        UnknownNameError: If a gripper is stated that the robot has not.
        KnowledgeError: If a gripper is missing or cannot be as wide open as stated.
    """
    read = robot_model(robot)
    known = [arm.name for arm in robot.arms]
    stated = [part for part in kb.parts(whole.name) if kb.is_a(part, "Gripper")]
    for name in stated:
        if name not in known:
            raise UnknownNameError.of("gripper", name, known, f"{whole.name} ({whole.kind})")
    for name in known:
        if name not in stated:
            raise KnowledgeError(f"{whole.name} ({whole.kind}) has no part {name}; state :{name} a :Gripper")
    openings = {name: _opening(kb, name, read.gaps[name].greatest) for name in known}
    data, _ = read.at_home(openings)
    robot_thing = replace(
        whole, mount=WITHIN, roles=whole.roles | {"Robot"}, mass=float(read.model.body_subtreemass[0])
    )
    made: dict[str | None, list[Thing]] = {None: [robot_thing]}
    for arm in robot.arms:
        palm = read.model.body(arm.gripper.palm).id
        rotation = quaternion(data.xquat[palm])
        held = _sum(triple(data.xpos[palm]), triple(rotated(rotation, arm.gripper.tool)))
        position, orientation = _world_pose(whole, held, product(rotation, arm.gripper.tool_orientation))
        found = gripper_thing(arm.name)
        limits = {
            "opening": openings[arm.name],
            "minOpening": read.gaps[arm.name].least,
            "maxOpening": read.gaps[arm.name].greatest,
            "maxForce": arm.gripper.max_force,
            "maxPush": arm.max_push,
            "maxSpeed": arm.max_speed,
            "maxAcceleration": arm.max_acceleration,
        }
        gripper = replace(
            found,
            mount=WITHIN,
            position=position,
            orientation=orientation,
            mass=float(read.model.body_subtreemass[palm]),
            quantities={**found.quantities, **limits},
        )
        made[arm.name] = [gripper]
    for body in range(1, read.model.nbody):
        name = read.model.body(body).name
        owner = made[read.owner[name]]
        quantities = {k: v for k, v in owner[0].quantities.items() if k in ("friction", "frictionWhenWet")}
        position, orientation = _world_pose(whole, triple(data.xpos[body]), quaternion(data.xquat[body]))
        owner.append(
            Thing(
                name=f"{whole.name}/{name}",
                kind="Part",
                mount=_mount(read, body, whole.name),
                shape=shape_of(read.model, body),
                position=position,
                orientation=orientation,
                mass=float(read.model.body_mass[body]),
                whole=owner[0].name,
                quantities=quantities,
            )
        )
    return tuple(thing for things in made.values() for thing in things)


def _mount(read: RobotModel, body: int, robot: str) -> Mount:
    parent = int(read.model.body_parentid[body])
    return jointed(f"{robot}/{read.model.body(parent).name}" if parent else None)


def _opening(kb: KnowledgeBase, name: str, greatest: float) -> float:
    """Return how far a gripper is open at the start [m]: as stated, or as usual if it opens so far."""
    opening = kb.quantity(name, "opening")
    if kb.value(name, "opening").origin == "class default":
        return min(opening, greatest)
    if opening > greatest:
        raise KnowledgeError(f"{name}: opening {opening:g} m, allowed up to {greatest:.3g} m")
    return opening


def _world_pose(whole: Thing, position: Triple, orientation: Quaternion) -> tuple[Triple, Quaternion]:
    """Return a pose seen from the robot's root as a pose in the world."""
    return _sum(whole.position, triple(rotated(whole.orientation, position))), product(whole.orientation, orientation)


def _sum(first: Triple, second: Triple) -> Triple:
    return (first[0] + second[0], first[1] + second[1], first[2] + second[2])

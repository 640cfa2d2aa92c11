"""Hands that fly and robots, as kinds: what they add to a scene and to the world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.things import Thing
from prolepsis.robots.hand import HAND
from prolepsis.robots.robot_things import robot_of, robot_things
from prolepsis.robots.robot_world import add_robot, posture, rule_contacts
from prolepsis.scene.kind import Building, Channel, Individuals, Kind, Made
from prolepsis.scene.robot import Robot, RobotPart
from prolepsis.terms.errors import KnowledgeError

CHANNELS = tuple(
    Channel(name=name, doc=doc, role="Gripper", default=True, needed=True)
    for name, doc in (
        ("opening", "the gap between the pads [m]"),
        ("gripper", "1 while the gripper opens, -1 while it closes, 0 when idle"),
        ("pad_force", "the smaller of the two pads' normal forces [N]"),
        ("command", "the commanded pad force [N]"),
    )
)
"""What is logged of a gripper."""


@dataclass(frozen=True, kw_only=True, slots=True)
class FreeHand:
    """A hand that flies."""

    name: str


class FreeHands(Kind):
    """The kind of hands that fly."""

    claims = "Gripper"
    shapes = ("parallelGripper",)
    roles = frozenset({"Gripper"})
    channels = CHANNELS

    def refuse(self, kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
        """Refuse hands that are told to stand on something: they hang in the air."""
        for relation, name, host in kb.relations():
            if relation == "on" and kb.whole(name) is None and kb.is_a(name, "Gripper"):
                raise KnowledgeError(
                    f"{name} is on {host}, but a {kb.kind(name)} does not rest on anything; state its z"
                )

    def parts(self, individuals: Individuals, whole: Thing) -> Made:
        """Return it with its parts."""
        kb, name, q = individuals.kb, whole.name, whole.quantities
        opening = kb.quantity(name, "opening")
        if opening > HAND.max_opening:
            raise KnowledgeError(f"{name}: opening {opening:g} m, allowed up to {HAND.max_opening:g} m")
        made = HAND.things(
            name,
            position=whole.position,
            orientation=whole.orientation,
            opening=opening,
            friction=kb.quantity(name, "friction"),
        )
        hand = replace(made[0], roles=whole.roles, kind=whole.kind, quantities={**q, **made[0].quantities})
        known = {"frictionWhenWet": q["frictionWhenWet"]} if "frictionWhenWet" in q else {}
        parts = [replace(part, quantities={**part.quantities, **known}) for part in made[1:]]
        return Made(things=(hand, *parts), parts=(FreeHand(name=name),))

    def edit(self, building: Building) -> None:
        """Give the bodies of its things what rigid bodies alone have not."""
        for hand in building.scene.each(FreeHand):
            HAND.add_joints(building.spec, hand.name, building.scene.thing(hand.name).orientation)


class Robots(Kind):
    """The kind of robots that have a model."""

    claims = "Robot"
    shapes = ("articulated",)
    rests = False
    roles = frozenset({"Gripper"})
    channels = CHANNELS

    def __init__(self, given: Robot | None = None) -> None:
        """Take ``given`` for an individual of class Robot whose class says no more."""
        self._given = given

    def parts(self, individuals: Individuals, whole: Thing) -> Made:
        """Return it with its parts."""
        robot = robot_of(individuals.kb, whole.name, self._given)
        things = robot_things(individuals.kb, robot, whole, individuals.bodiless)
        return Made(things=things, parts=(RobotPart(name=whole.name, robot=robot),))

    def attach(self, building: Building) -> Mapping[str, float]:
        """Add the models of its things, and return where their joints are at the start."""
        scene = building.scene
        known = scene.each(RobotPart)
        arms = [arm.name for each in known for arm in each.robot.arms]
        start: dict[str, float] = {}
        for each in known:
            add_robot(building.spec, each.robot, scene.thing(each.name), arms)
            rule_contacts(building, each.name, each.robot)
            start |= posture(each.robot, each.name, scene)
        return start

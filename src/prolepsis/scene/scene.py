"""A scene: the things of one situation as frozen values, before any physics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from prolepsis.geometry.shape import FloatArray, Quaternion, Triple
from prolepsis.log.domain import Domain
from prolepsis.log.things import Thing
from prolepsis.scene.robot import Robot, RobotPart
from prolepsis.terms.errors import UnknownNameError, brief_list

Part = TypeVar("Part")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Pool:
    """Where the particles of one liquid are at the start."""

    stuff: str
    """Name of the liquid individual, ``liq1``."""
    position: FloatArray
    """World frame [m], shape (n, 3)."""
    spacing: float
    """Distance of neighbours at rest [m]; all pools of a scene have the same."""
    holder: str | None = None
    """Name of the thing that has absorbed it, if any."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Pool({self.stuff}, {len(self.position)} particles)"


@dataclass(frozen=True, kw_only=True, slots=True)
class Scene:
    """What there is at the start."""

    things: tuple[Thing, ...]
    """Wholes, parts, pieces and blobs."""
    pools: tuple[Pool, ...] = ()
    """The liquids that flow."""
    parts_known: tuple[object, ...] = field(default=(), compare=False)
    """What parts are, as values of a type of their own: a shard, a panel, a membrane."""
    kinds: tuple[Any, ...] = field(default=(), compare=False)
    """Each a ``Kind``: those that it was composed of, and that go on in the world and the run, in their order."""
    domain: Domain = Domain()
    """What is known of the individuals."""
    gravity: Triple = (0.0, 0.0, -9.81)
    """[m/s^2]"""
    folder: Path = Path()
    """Where the paths of files start that a plan names, while it is read."""
    _numbers: Mapping[str, int] = field(init=False, repr=False, compare=False)
    """Position of each thing by its name."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Scene({len(self.things)} things: {brief_list(thing.name for thing in self.things)})"

    def __post_init__(self) -> None:
        """Number the things."""
        object.__setattr__(self, "_numbers", {thing.name: i for i, thing in enumerate(self.things)})

    @property
    def robots(self) -> Mapping[str, Robot]:
        """What each robot is that has a model, by name; free hands are none of these."""
        return {part.name: part.robot for part in self.each(RobotPart)}

    def thing(self, name: str) -> Thing:
        """Return the thing called ``name``.

        Raises:
            UnknownNameError: If there is none.
        """
        return self.things[self.index(name)]

    def index(self, name: str) -> int:
        """Return the position of the thing called ``name`` among ``things``.

        Raises:
            UnknownNameError: If there is none.
        """
        number = self._numbers.get(name)
        if number is None:
            raise UnknownNameError.of("object", name, (t.name for t in self.things if t.whole is None))
        return number

    def each(self, type: type[Part]) -> tuple[Part, ...]:
        """Return all parts that are of a type."""
        return tuple(part for part in self.parts_known if isinstance(part, type))

    def parts(self, name: str) -> tuple[Thing, ...]:
        """Return the direct parts of a thing."""
        return tuple(thing for thing in self.things if thing.whole == name)

    def number(self, individual: str, prop: str) -> float | None:
        """Return a number that is known of an individual, in SI units, or None."""
        for subject, name, value in self.domain.values:
            if subject == individual and name == prop and not isinstance(value, str):
                return float(value)
        return None


def robot_of_gripper(scene: Scene, gripper: Thing) -> str | None:
    """Return the robot that a gripper is on, or None if it flies."""
    owners = (part.name for part in scene.each(RobotPart) if any(arm.name == gripper.name for arm in part.robot.arms))
    return next(owners, None)


def reference_of(scene: Scene, gripper: Thing) -> Quaternion:
    """Return the orientation from which a gripper's turns count: its robot's at the start, or its own if it flies."""
    robot = robot_of_gripper(scene, gripper)
    return gripper.orientation if robot is None else scene.thing(robot).orientation

"""All controllers of a running simulation: who takes which command, and what programs sense."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from prolepsis.robots.arm_control import ArmHand
from prolepsis.robots.commands import Command, HandSense, JointTarget, RobotSense
from prolepsis.robots.flying_control import FlyingHand
from prolepsis.robots.hand import HAND
from prolepsis.robots.trunk_control import Trunk
from prolepsis.scene.running import Running
from prolepsis.scene.scene import reference_of, robot_of_gripper

S = TypeVar("S")


class Asked(Mapping[str, S]):
    """What is sensed, by name, found out when it is first asked for: most of it never is."""

    __slots__ = ("_known", "_senses")

    def __init__(self, senses: Mapping[str, Callable[[], S]]) -> None:
        """Ask ``senses`` when needed."""
        self._senses = senses
        self._known: dict[str, S] = {}

    def __getitem__(self, name: str) -> S:
        """Return what the one called ``name`` senses."""
        if name not in self._known:
            self._known[name] = self._senses[name]()
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        """Yield all names."""
        return iter(self._senses)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._senses)


@dataclass(frozen=True, kw_only=True, slots=True)
class Controls:
    """The controllers of hands and of robots' trunks."""

    hands: Mapping[str, FlyingHand | ArmHand]
    """By the gripper's name."""
    trunks: Mapping[str, Trunk]
    """By the robot's name."""
    senses: tuple[Mapping[str, Callable[[], HandSense]], Mapping[str, Callable[[], RobotSense]]]
    """What asks hands and robots what they sense."""

    @classmethod
    def of(cls, state: Running) -> Controls:
        """Return the controllers of all that can be controlled in a scene."""
        scene = state.scene
        hands: dict[str, FlyingHand | ArmHand] = {}
        for thing in scene.things:
            if "Gripper" not in thing.roles:
                continue
            robot = robot_of_gripper(scene, thing)
            if robot is None:
                hands[thing.name] = FlyingHand(state, thing, HAND)
            else:
                hands[thing.name] = ArmHand(state, thing, scene.robots[robot], robot, reference_of(scene, thing))
        trunks = {name: Trunk(state, name, robot) for name, robot in scene.robots.items()}
        senses = {name: hand.sense for name, hand in hands.items()}, {name: t.sense for name, t in trunks.items()}
        return cls(hands=hands, trunks=trunks, senses=senses)

    def accept(self, command: Command) -> None:
        """Pass a command on to whom it is for."""
        if isinstance(command, JointTarget):
            self.trunks[command.robot].accept(command)
            return
        hand = getattr(command, "hand", None)
        if hand is not None:
            self.hands[hand].accept(command)

    def act(self, state: Running, dt: float) -> None:
        """Set all motors for the coming tick of ``dt`` [s]."""
        for trunk in self.trunks.values():
            trunk.act(state)
        for hand in self.hands.values():
            hand.act(state, dt)

    def publish(self, state: Running) -> None:
        """Tell what the grippers do and feel."""
        for name, hand in self.hands.items():
            gripper = hand.gripper
            state.set_attribute(name, "opening", gripper.opening)
            state.set_attribute(name, "gripper", float(gripper.motion))
            state.set_attribute(name, "pad_force", gripper.pad_force)
            state.set_attribute(name, "command", gripper.command)

    def bind(self, state: Running) -> None:
        """Look everything up in a model that is new."""
        for each in self._all():
            each.bind(state)

    def measure(self, state: Running) -> None:
        """Read the forces of the last substep."""
        if self.hands:
            forces = state.normal_forces()
            for hand in self.hands.values():
                hand.measure(forces)

    def sense(self) -> tuple[Mapping[str, HandSense], Mapping[str, RobotSense]]:
        """Return what hands and robots know of themselves; each is asked when a program does, in the same tick."""
        return Asked(self.senses[0]), Asked(self.senses[1])

    def _all(self) -> Iterator[FlyingHand | ArmHand | Trunk]:
        yield from self.trunks.values()
        yield from self.hands.values()

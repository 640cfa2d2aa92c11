"""What a control program says to the robot and what it senses: values only, so programs run without physics."""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

from prolepsis.geometry.shape import IDENTITY, FloatArray, Quaternion, Triple
from prolepsis.log.outcomes import Outcome
from prolepsis.terms.terms import Term, Value


@dataclass(frozen=True, kw_only=True, slots=True)
class HandTarget:
    """Where a hand should be, seen from where it was at the start; the first orientation of a hand on an arm is level
    and ahead."""

    hand: str
    offset: Triple
    """Displacement from the first position, world axes [m]."""
    velocity: Triple = (0.0, 0.0, 0.0)
    """Its rate of change [m/s]."""
    rotation: Triple = (0.0, 0.0, 0.0)
    """Yaw, pitch and roll from the first orientation, about the hand's own axes [rad]."""
    angular_velocity: Triple = (0.0, 0.0, 0.0)
    """Its rate of change [rad/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ArmTarget:
    """Where the joints of the arm that carries a hand should be."""

    hand: str
    joints: tuple[float, ...]
    """Coordinates, from the trunk outwards [rad]."""
    speeds: tuple[float, ...]
    """Their rates of change [rad/s]."""
    offset: Triple
    """Where that puts the hand, as in ``HandTarget`` [m]."""
    rotation: Triple
    """How that turns the hand, as in ``HandTarget`` [rad]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class JointTarget:
    """Where some joints of a robot should be that belong to none of its arms: base, torso, head."""

    robot: str
    joints: Mapping[str, float]
    """Coordinates by joint [rad or m]."""
    speeds: Mapping[str, float]
    """Their rates of change [rad/s or m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CloseGripper:
    """Close quickly to a gap, slowly from there until contact, then raise the force; if the hand grips already,
    change the force from what it is."""

    hand: str
    force: float
    """Force of each pad [N]."""
    width: float
    """Gap down to which nothing is expected between the pads [m]."""
    speed: float
    """Speed of each finger before contact [m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class OpenGripper:
    """Move the pads to a gap."""

    hand: str
    width: float
    """Gap [m]."""
    speed: float
    """Speed of the gap [m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Begin:
    """An action begins."""

    term: Term
    arguments: Mapping[str, Value] = field(default_factory=dict[str, Value])
    """By the names of its parameters."""


@dataclass(frozen=True, kw_only=True, slots=True)
class End:
    """An action ends."""

    term: Term
    outcome: Outcome = "done"
    evidence: Mapping[str, float | str] = field(default_factory=dict[str, "float | str"])


@dataclass(frozen=True, kw_only=True, slots=True)
class Measured:
    """What an action has measured, for its event."""

    evidence: Mapping[str, float | str]
    outcome: Outcome | None = None
    """How it ends if it goes on to its end, where that is not ``done``."""


Command = HandTarget | ArmTarget | JointTarget | CloseGripper | OpenGripper | Begin | Measured | End


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class JointPath:
    """How an arm gets somewhere, or why it does not."""

    joints: FloatArray
    """Coordinates one after the other [rad], shape (k, n); as far as it gets if there is a problem."""
    problem: Literal["", "unreachable", "in_collision"] = ""
    """Why it does not."""
    detail: str = ""
    """How far it stays away, or what is in the way."""


def no_joint_path(first: JointPath | None, what: str, otherwise: str) -> ActionFailedError:
    """Return why ``what`` cannot be done: what stood in the first path that was looked at, or ``otherwise`` if none."""
    if first is None or not first.problem:
        return ActionFailedError("unreachable", f"{what}: {otherwise}")
    return ActionFailedError(first.problem, f"{what}: {first.detail}")


class ArmSense(Protocol):
    """The arm that carries a hand, as a program may ask it. Offsets and rotations are those of ``HandTarget``."""

    @property
    def joints(self) -> FloatArray:
        """Commanded coordinates [rad], shape (n,)."""
        ...

    @property
    def speeds(self) -> FloatArray:
        """Greatest speeds of the joints [rad/s], shape (n,)."""
        ...

    @property
    def accelerations(self) -> FloatArray:
        """Greatest accelerations of the joints that are commanded [rad/s^2], shape (n,)."""
        ...

    def bearing(self, position: Triple) -> float:
        """Return the yaw in which a position in the world lies from the shoulder [rad]."""
        ...

    def held_at(self, width: float) -> tuple[float, float]:
        """Return where what is ``width`` [m] wide has its middle when it is held, along the hand's x and y [m]."""
        ...

    def feasible(self, offset: Triple, rotation: Triple) -> Triple:
        """Return the nearest rotation that is possible at an offset: an arm of five joints cannot have all."""
        ...

    def pose(self, joints: FloatArray) -> tuple[Triple, Triple]:
        """Return offset and rotation of the hand with the given coordinates [rad], shape (n,)."""
        ...

    def path(self, offsets: FloatArray, rotations: FloatArray, *, loose: bool = False) -> JointPath:
        """Return the joints along offsets and rotations one after the other, each shape (k, 3), from where they are;
        ``loose`` ones may be off about the vertical where an arm of five joints cannot have them."""
        ...

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
        ...


class ActionFailedError(Exception):
    """An action cannot be carried on: the rest of its sequence is not done. No error of the user's: an outcome."""

    def __init__(self, outcome: Outcome, detail: str) -> None:
        """Say the outcome, such as ``unreachable``, and why."""
        super().__init__(f"{outcome}: {detail}")
        self.outcome: Outcome = outcome
        self.detail = detail


def nothing() -> tuple[str, ...]:
    """Return that the pads hold nothing."""
    return ()


def untouched() -> Mapping[str, float]:
    """Return that nothing presses on the fingers."""
    return {}


def on_target() -> tuple[float, float]:
    """Return that a hand is where it should be."""
    return (0.0, 0.0)


def standing_still() -> Triple:
    """Return no velocity."""
    return (0.0, 0.0, 0.0)


# What is sensed is made anew each tick, and a frozen dataclass takes three times as long to make.
@dataclass(kw_only=True, slots=True)
class HandSense:
    """What a hand knows of itself."""

    position: Triple
    """Place of the hand's frame in the world [m]."""
    orientation: Quaternion = IDENTITY
    """Its commanded orientation in the world."""
    offset: Triple
    """Its commanded displacement from the first position [m]."""
    rotation: Triple
    """Its commanded yaw, pitch and roll from the first orientation [rad]."""
    opening: float
    """Gap between the pads [m]."""
    grip: float
    """Commanded force of each pad [N], 0 when it does not close."""
    load: Callable[[], Triple]
    """Force with which the servos hold against what pulls or pushes the hand, world axes [N]; computed when asked."""
    velocity: Callable[[], Triple] = standing_still
    """Measured velocity of the hand's frame in the world [m/s]; computed when asked."""
    pad_force: float
    """The smaller of the two pads' normal forces [N], also of pads that press each other."""
    between: Callable[[], tuple[str, ...]] = nothing
    """Wholes that lie between two pads that both feel something; computed when asked."""
    held: Callable[[], tuple[str, ...]] = nothing
    """Those of them that it holds: they have not slipped since the pads closed on them; computed when asked."""
    away: Callable[[], tuple[float, float]] = on_target
    """How far it is from where it is commanded to be [m], and how far it is turned from that [rad]; computed when
    asked."""
    fingers: Callable[[], Mapping[str, float]] = untouched
    """Force with which each other thing presses on the fingers [N]; computed when asked."""
    motion: int
    """1 opening, -1 closing, 0 idle."""
    stiffness: float
    """Force with which it resists for each metre that it is pushed away from its target [N/m]: the least."""
    lag: float = 0.0
    """How far the commanded joints are from putting the hand on its target [m]."""
    bump: str = ""
    """What the hand's palm, or the arm that carries it, is pressed against, if anything."""
    arm: ArmSense | None = None
    """The arm that carries it; None for a hand that flies."""


@dataclass(kw_only=True, slots=True)
class RobotSense:
    """What a robot knows of its joints that belong to none of its arms."""

    joints: Mapping[str, float]
    """Commanded coordinates by joint [rad or m]."""
    measured: Callable[[], Mapping[str, float]]
    """Coordinates by joint as they are [rad or m]; computed when asked."""
    speeds: Mapping[str, float]
    """Greatest speeds by joint [rad/s or m/s]."""
    accelerations: Mapping[str, float]
    """Greatest accelerations by joint [rad/s^2 or m/s^2]."""
    ranges: Mapping[str, tuple[float, float]]
    """Least and greatest coordinate by joint."""
    base: tuple[str, ...]
    """Joints of the base: along x, along y, about z, seen from where it was at the start."""
    head: tuple[str, ...]
    """Pan and tilt."""
    neck: Triple
    """Where the head's axes meet in the world [m]."""
    yaw: float
    """Direction in which the trunk faces, from the world's x axis [rad]."""


def no_force(first: str, second: str) -> float:
    """Return that two things do not touch."""
    del first, second
    return 0.0


def no_attribute(name: str, attribute: str) -> float:
    """Return that a thing is as it was made."""
    del name, attribute
    return 0.0


@dataclass(kw_only=True, slots=True)
class Sense:
    """What a program may know at a tick."""

    time: float
    """[s]"""
    hands: Mapping[str, HandSense]
    """Each hand's own sense."""
    position: Callable[[str], Triple]
    """Position of a thing in the world [m], as a perfect camera would see it."""
    orientation: Callable[[str], Quaternion]
    """Unit quaternion (w, x, y, z) of a thing in the world, seen likewise."""
    pressing: Callable[[str, str], float] = no_force
    """Normal force between two things [N], as the skin or what is held tells it."""
    attribute: Callable[[str, str], float] = no_attribute
    """An attribute of a thing, of those that kinds of matter change: as it is seen, heard or felt."""
    robots: Mapping[str, RobotSense] = field(default_factory=dict[str, RobotSense])
    """Each robot's sense of its other joints."""


Behaviour = Generator[tuple[Command, ...], Sense, Sense]
"""A program: at each tick it yields commands and receives what is sensed at the next; it returns its last sense. That
actions begin or end, or what they have measured, it yields apart: this takes no time, and it receives what is sensed at
the same tick."""


def is_instant(commands: tuple[Command, ...]) -> bool:
    """Return whether commands take no time: they only say that actions begin or end, or what they have
    measured."""
    return bool(commands) and not [each for each in commands if not isinstance(each, (Begin, Measured, End))]

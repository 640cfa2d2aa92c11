"""What a control program says to the robot and what it senses: values only, so programs run without physics."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field

from prolepsis.terms import Term
from prolepsis.things import Quaternion, Triple


@dataclass(frozen=True, kw_only=True, slots=True)
class BaseTarget:
    """Where a hand should be, seen from where it was at the start."""

    hand: str
    offset: Triple
    """Displacement from the first position, world axes [m]."""
    velocity: Triple = (0.0, 0.0, 0.0)
    """Its rate of change [m/s]."""
    turn: Triple = (0.0, 0.0, 0.0)
    """Yaw, pitch and roll from the first orientation, about the hand's own axes [rad]."""
    spin: Triple = (0.0, 0.0, 0.0)
    """Its rate of change [rad/s]."""


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


@dataclass(frozen=True, kw_only=True, slots=True)
class End:
    """An action ends."""

    term: Term
    outcome: str = "done"
    evidence: Mapping[str, float | str] = field(default_factory=dict[str, "float | str"])


Command = BaseTarget | CloseGripper | OpenGripper | Begin | End


@dataclass(frozen=True, kw_only=True, slots=True)
class HandSense:
    """What a hand knows of itself."""

    position: Triple
    """Place of the hand's frame in the world [m]."""
    offset: Triple
    """Its commanded displacement from the first position [m]."""
    turn: Triple
    """Its commanded yaw, pitch and roll from the first orientation [rad]."""
    opening: float
    """Gap between the pads [m]."""
    grip: float
    """Commanded force of each pad [N], 0 when it does not close."""
    load: Triple
    """Force with which the base holds against what pulls or pushes the hand, world axes [N]."""
    pad_force: float
    """The smaller of the two pads' normal forces [N]."""
    motion: int
    """1 opening, -1 closing, 0 idle."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Sense:
    """What a program may know at a tick."""

    time: float
    """[s]"""
    hands: Mapping[str, HandSense]
    """Each hand's own sense."""
    place: Callable[[str], Triple]
    """Position of a thing in the world [m], as a perfect camera would see it."""
    orientation: Callable[[str], Quaternion]
    """Unit quaternion (w, x, y, z) of a thing in the world, seen likewise."""


Behaviour = Generator[tuple[Command, ...], Sense, Sense]
"""A program: at each tick it yields commands and receives what is sensed at the next; it returns its last sense."""

"""A robot of the user's own, as a scenario's ``[robot]`` table tells it: a model file and what its joints are for."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Annotated, Any

from pydantic import ConfigDict, Field
from pydantic.dataclasses import dataclass

from prolepsis.terms.errors import ScenarioError

STRICT = ConfigDict(extra="forbid", defer_build=True)
"""Most runs are of no such robot, and to build what checks it takes as long as to read a scenario."""
_NAME = re.compile(r"[a-z]\w*", re.ASCII)
_Number = Annotated[float, Field(ge=-1.0e4, le=1.0e4)]
"""A coordinate or a direction [m, rad or 1]."""
_Near = Annotated[float, Field(ge=-10.0, le=10.0)]
"""A position seen from the palm [m]."""
_Positive = Annotated[float, Field(gt=0.0, le=1.0e9)]
Name = Annotated[str, Field(max_length=200)]
"""What the model calls a body or a joint."""
_Names = Annotated[tuple[Name, ...], Field(max_length=100)]
_Vector = tuple[_Number, _Number, _Number]


@dataclass(frozen=True, kw_only=True, slots=True, config=STRICT)
class OwnGripper:
    """An effector, and the arm that carries it. What is None is taken from the model."""

    palm: Name
    """Body that carries it."""
    tool: tuple[_Near, _Near, _Near]
    """Where objects are held: between the pads, in the palm's frame [m]."""
    forward: _Vector = (1.0, 0.0, 0.0)
    """Direction from the palm to the fingertips, in the palm's frame."""
    joints: _Names | None = None
    """The arm's joints from the trunk outwards; all on the way from the root to the palm if None."""
    home: tuple[_Number, ...] | None = None
    """Coordinates of these joints at the start [rad or m]."""
    speed: _Positive | tuple[_Positive, ...] | None = None
    """Greatest speed of all or each of these joints [rad/s or m/s]."""
    stiffness: _Positive | tuple[_Positive, ...] | None = None
    """Servo stiffness of all or each of these joints [N m/rad or N/m]."""
    max_force: _Positive | None = None
    """Greatest force of a pad [N]."""
    kind: Name | None = None
    """Its kind of effector; None if its keys tell it."""
    effector: Annotated[Mapping[Name, Any], Field(max_length=100)] = field(default_factory=dict[str, Any])
    """The keys of its kind, which beside the others are in the gripper's table; the kind reads them."""


@dataclass(frozen=True, kw_only=True, slots=True, config=STRICT)
class OwnRobot:
    """A model file, and what of it is a gripper, an arm, a base, a torso and a head."""

    file: str
    """The model, MJCF or URDF."""
    folder: str | None = None
    """Where all files that the model names must be; the model's own folder, or the nearest above it with a
    ``package.xml``, if None."""
    name: Annotated[str, Field(max_length=60)] = "robot1"
    """Name of the robot in the situation."""
    grippers: Annotated[Mapping[str, OwnGripper], Field(min_length=1, max_length=16)]
    """By the name that plans and facts give them."""
    base: _Names = ()
    """Joints that drive it over the floor: along x, along y, about z."""
    torso: _Names = ()
    """Joints between base and arms that hold still, as do all that are not named."""
    head: _Names = ()
    """Pan and tilt."""

    def statements(self, where: Path) -> str:
        """Return in Turtle that there is a robot with these grippers.

        Raises:
            ScenarioError: If a name cannot be used in plans and facts.
        """
        for name in (self.name, *self.grippers):
            if not _NAME.fullmatch(name):
                raise ScenarioError(
                    f"{where}: robot: {name!r} is no name; allowed: a lower-case letter, then letters, digits and _"
                )
        grippers = " ".join(f":{self.name} :hasPart :{name} . :{name} a :Gripper ." for name in self.grippers)
        return f"@prefix : <https://w3id.org/prolepsis#> .\n:{self.name} a :Robot . {grippers}\n"

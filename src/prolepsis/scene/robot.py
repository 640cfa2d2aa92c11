"""What a robot is: one frozen value that says which joints of a model are its base, torso, head, arms and grippers."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from prolepsis.geometry.shape import IDENTITY, Quaternion, Triple


@dataclass(frozen=True, kw_only=True, slots=True)
class Joint:
    """One driven joint. Its range and greatest effort are the model's."""

    name: str
    """As the model calls it."""
    speed: float
    """Greatest speed [rad/s or m/s]."""
    acceleration: float
    """Greatest acceleration that is commanded [rad/s^2 or m/s^2]."""
    stiffness: float
    """Servo stiffness [N m/rad or N/m]."""
    damping: float
    """Servo damping [N m s/rad or N s/m]."""
    home: float = 0.0
    """Coordinate at the start [rad or m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Effector:
    """What an arm holds things with; ``robots/effectors/`` says what each kind does. Its frame lies where it holds:
    x points from the palm to the fingertips, y from one pad to the other."""

    kind: str
    """Name of its kind."""
    palm: str
    """Body that carries it."""
    joints: tuple[str, ...]
    """Joints that open it when they grow, all alike."""
    pads: tuple[str, ...]
    """Bodies with which it touches what it holds."""
    surfaces: tuple[str, ...] = ()
    """Geoms of these that are the pads, one each; all that can touch if none are named."""
    tool: Triple
    """Origin of its frame in the palm's frame [m]."""
    tool_orientation: Quaternion = IDENTITY
    """Its frame in the palm's, a unit quaternion (w, x, y, z)."""
    max_force: float
    """Greatest force of a pad [N]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Arm:
    """A chain of joints that carries an effector."""

    name: str
    """Name of the gripper in plans and facts."""
    joints: tuple[Joint, ...]
    """From the trunk outwards."""
    gripper: Effector
    max_push: float
    """Greatest force of the gripper on what is in front of it that a plan may ask for [N]."""
    max_speed: float
    """Greatest speed of the gripper that a plan may ask for [m/s]."""
    max_acceleration: float
    """Greatest acceleration of the gripper that a plan may ask for [m/s^2]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Robot:
    """A robot: a model file and what its joints are for."""

    kind: str
    """Class in the ontology."""
    file: Path
    """The model: MJCF, or anything else from which ``model`` was made."""
    model: str = field(default="", repr=False)
    """The model itself (MJCF) if the file had to be changed to fit into a world."""
    arms: tuple[Arm, ...]
    base: tuple[Joint, ...] = ()
    """Joints that drive it over the floor: along x, along y, about z; none if it stands where it is."""
    torso: tuple[Joint, ...] = ()
    """Joints between base and arms that hold still."""
    head: tuple[Joint, ...] = ()
    """Pan and tilt of what carries the camera; none if it has no head."""
    camera: str | None = None
    """Body whose x axis is the camera's line of sight."""

    @property
    def joints(self) -> tuple[Joint, ...]:
        """All driven joints but the effectors'."""
        return (*self.base, *self.torso, *self.head, *(joint for arm in self.arms for joint in arm.joints))

    def arm(self, name: str) -> Arm:
        """Return the arm whose gripper is called ``name``; it must exist."""
        return next(arm for arm in self.arms if arm.name == name)


@dataclass(frozen=True, kw_only=True, slots=True)
class RobotPart:
    """What a thing of a scene is that is a robot."""

    name: str
    """The thing."""
    robot: Robot

"""A running scene, as those see it who act in it: robots and kinds of matter. The engine has it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray, Quaternion, Triple
from prolepsis.log.happenings import Happening
from prolepsis.scene.particles import ParticleState
from prolepsis.scene.scene import Scene

TICK = 1.0e-3
"""The clock of a run and its log [s]."""
MAX_STEP = TICK
"""Longest substep [s]: with nothing going on."""


@dataclass(kw_only=True, slots=True)
class ContactForces:
    """Active contacts of the last substep; c contacts."""

    numbers: IntArray
    """Their numbers, shape (c,)."""
    geoms: IntArray
    """The two geoms, shape (c, 2)."""
    bodies: IntArray
    """Their bodies, shape (c, 2)."""
    normal_force: FloatArray
    """[N], shape (c,)."""
    force: FloatArray
    """Force on the second geom's body, world frame [N], shape (c, 3)."""
    points: FloatArray
    """World frame [m], shape (c, 3)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PointJoint:
    """Two bodies that are held together at a point."""

    first: str
    second: str
    point_on_first: FloatArray
    """The point in the frame of the first body [m], shape (3,)."""
    point_on_second: FloatArray
    """The point in the frame of the second body [m], shape (3,)."""


class Running(Protocol):
    """The one mutable thing of a run: its model and data, who carries whom, and what has changed of things."""

    spec: Any
    """The ``mujoco.MjSpec`` of the world as it is now."""
    model: Any
    """The ``mujoco.MjModel``; another one after each rebuild."""
    data: Any
    """The ``mujoco.MjData``."""
    version: int
    """Counts the rebuilt models."""
    carrier: IntArray
    """Index of the thing that carries each thing, -1 for none, shape (n,)."""
    offsets: FloatArray
    """Pose of each thing in its carrier's frame, shape (n, 7)."""
    body_thing: IntArray
    """Index of the thing that each MuJoCo body is, -1 for none, shape (nbody,)."""
    particles: ParticleState | None
    """All particles, if there are any."""

    @property
    def scene(self) -> Scene:
        """What the run began with."""
        ...

    def report(self, happening: Happening) -> None:
        """Tell the log that something has happened in this tick, which a kind of the scene has declared."""
        ...

    def attribute(self, name: str, attribute: str) -> float:
        """Return an attribute of a thing: as changed in this run, as known at the start, or 0."""
        ...

    def set_attribute(self, name: str, attribute: str, value: float) -> None:
        """Change an attribute of a thing, which is a channel that a kind of the scene has declared."""
        ...

    def set_friction(self, index: int, friction: float) -> None:
        """Give a thing's surface another sliding friction, 0 to 10 [1], until it is given another one."""
        ...

    def push(self, source: object, bodies: IntArray, wrenches: FloatArray, *, passes_on: bool = False) -> None:
        """Push bodies from now on, in place of what the same source pushed; what different sources push is summed.

        Args:
            source: Who pushes: a controller.
            bodies: Numbers of MuJoCo bodies, as ``model.body(name).id``, each once, shape (k,).
            wrenches: Force [N] and torque about the centre of mass [N m], in the world's axes, shape (k, 6).
            passes_on: Whether it only passes energy on, as a liquid does, so that what it pushes must not gain any;
                what others push may have any energy, as what a hand moves.
        """
        ...

    def generator(self, name: str) -> np.random.Generator:
        """Return the source of randomness for what is called ``name``, a child of the scenario's seed."""
        ...

    def pose(self, name: str) -> FloatArray:
        """Return where a thing is and how it is turned, shape (7,); one that is no body any more is as at the start."""
        ...

    def position(self, name: str) -> Triple:
        """Return where a thing is in the world [m]."""
        ...

    def orientation(self, name: str) -> Quaternion:
        """Return how a thing is turned in the world, a unit quaternion (w, x, y, z)."""
        ...

    def renew_poses(self, centres: bool = False) -> None:
        """Bring poses, and centres of mass if wanted, up to the present: after a step they are those before it."""
        ...

    def renew_forces(self) -> None:
        """Make contacts and forces those of the coming substep: after a substep they are its own."""
        ...

    def velocity(self, name: str) -> FloatArray:
        """Return the velocity of a thing's carrier [m/s], shape (3,); zeros if it has none."""
        ...

    def velocity_at(self, body: str, point: FloatArray) -> FloatArray:
        """Return the velocity of points of a MuJoCo body in the world [m/s], shape (..., 3)."""
        ...

    def normal_forces(self) -> list[tuple[int, int, int, float]]:
        """Return contact number, both bodies and normal force [N] of each active contact of the last substep."""
        ...

    def touching(self) -> list[list[int]]:
        """Return both geoms of each contact of the last substep, active or not."""
        ...

    def driving_force(self, geom: int, contact: int) -> float:
        """Return the force with which what touches a geom at a contact is driven on to it [N]."""
        ...

    def pressing(self, first: str, second: str) -> float:
        """Return the normal force between two wholes, their parts included, at the last substep [N]."""
        ...

    def contact_forces(self) -> ContactForces:
        """Return the active contacts of the last substep."""
        ...

    def split(self, body_name: str, fragments: Sequence[Sequence[int]]) -> None:
        """Replace one rigid body by several that move on as its parts did."""
        ...

    @property
    def joints(self) -> frozenset[tuple[int, int]]:
        """What sticks to what now: indices of the holding and the held thing."""
        ...

    def stick(self, source: object, pairs: Iterable[tuple[int, int]]) -> None:
        """Tell the log what sticks to what from now on as a source holds it: indices of the holding and the held."""
        ...

    def join(self, source: object, joints: Sequence[PointJoint]) -> list[int]:
        """Hold bodies together at points, in place of what the same source held; return the numbers of the joints."""
        ...

    def joint_numbers(self, source: object) -> list[int]:
        """Return the numbers of the joints of a source: others than before, once the model is rebuilt."""
        ...

    def move_joint(self, number: int, point_on_first: FloatArray, point_on_second: FloatArray) -> None:
        """Let a joint hold other points of its bodies together [m]."""
        ...

    def joint_forces(self) -> dict[int, FloatArray]:
        """Return the force of each active joint at a point on its first body, world frame [N], by its number."""
        ...

"""A tank: the particle liquid among walls whose motion a test prescribes, without MuJoCo."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from prolepsis.geometry.faces import Solids
from prolepsis.geometry.shape import BoolArray, FloatArray, Geom, Hole, Shape, Triple
from prolepsis.geometry.signed_distance import union_of
from prolepsis.log.log import FREE, PARKED
from prolepsis.matter.liquids.holes import walls_of
from prolepsis.matter.liquids.solver import COURANT, Liquid
from prolepsis.matter.liquids.walls import Bodies, Walls
from prolepsis.scene.particles import ParticleState

GRAVITY = 9.81
"""[m/s^2]"""
DOWN: Triple = (0.0, 0.0, -GRAVITY)
"""Gravitational acceleration [m/s^2]."""
NONE: Triple = (0.0, 0.0, 0.0)
"""No gravity."""

AT_HOME = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
"""Pose of what is where its body is."""

Pose = tuple[FloatArray, FloatArray]
"""Position [m], shape (3,), and rotation to the world, shape (3, 3)."""
Motion = Callable[[float], Pose]
"""Where a wall is at a time [s]."""


def still(_: float) -> Pose:
    """Return the pose of a wall that never moves."""
    return np.zeros(3), np.eye(3)


def turned(axis: str, angle: float) -> FloatArray:
    """Return the rotation by an angle [rad] about an axis of the world, shape (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    k = "xyz".index(axis)
    a, b = (k + 1) % 3, (k + 2) % 3
    made = np.eye(3)
    made[a, a] = made[b, b] = c
    made[a, b], made[b, a] = -s, s
    return made


class Tank:
    """A running liquid, and the time."""

    def __init__(
        self,
        walls: Sequence[tuple[Shape | Solids, Motion]],
        position: FloatArray,
        spacing: float,
        *,
        density: float = 998.0,
        viscosity: float = 0.001,
        tension: float = 0.0728,
        contact_angle: float = math.radians(50.0),
        receding_angle: float = math.radians(15.0),
        gravity: Triple = DOWN,
    ) -> None:
        """Put particles of water, or of what the keywords say, among walls.

        Args:
            walls: Shapes, and how each moves.
            position: [m], shape (n, 3).
            spacing: [m].
            density: [kg/m^3].
            viscosity: [Pa s].
            tension: [N/m].
            contact_angle: [rad].
            receding_angle: [rad].
            gravity: [m/s^2].
        """
        count, receding = len(position), min(receding_angle, contact_angle)
        self.particles = ParticleState(
            position=position.copy(),
            velocity=np.zeros((count, 3)),
            home=np.zeros((count, 3)),
            holder=np.full(count, FREE, dtype=np.int16),
            stuff=np.zeros(count, dtype=np.int64),
            mass=np.full(count, density * spacing**3),
            volume=np.full(count, spacing**3),
            viscosity=np.full(count, viscosity),
            tension=np.full(count, tension),
            wetting=np.full(count, math.cos(contact_angle)),
            pinning=np.full(count, math.cos(receding) - math.cos(contact_angle)),
            spacing=spacing,
        )
        self.liquid = Liquid(self.particles, gravity)
        self.time = 0.0
        """[s]"""
        self._motions: list[Motion] = [motion for _, motion in walls]
        self._frozen: float | None = None
        made = [
            walls_of([[(shape, AT_HOME)]], spacing) if isinstance(shape, Shape) else Walls(faces=shape, surfaces=shape)
            for shape, _ in walls
        ]
        self._walls = Walls(
            faces=union_of([each.faces for each in made]), surfaces=union_of([each.surfaces for each in made])
        )
        self._first = np.cumsum([0, *(len(each.faces.kind) for each in made)]).astype(np.int64)

    @property
    def position(self) -> FloatArray:
        """Positions [m], shape (n, 3)."""
        return self.particles.position

    @property
    def velocity(self) -> FloatArray:
        """Velocities [m/s], shape (n, 3)."""
        return self.particles.velocity

    @property
    def weight(self) -> float:
        """Weight of the liquid on earth [N]."""
        return GRAVITY * float(self.particles.mass.sum())

    def under(self, gravity: Triple) -> None:
        """Let another gravity act from now on [m/s^2]."""
        self.liquid = Liquid(self.particles, gravity)

    def settle(self, duration: float = 0.4, viscosity: float = 2.0) -> None:
        """Let the liquid come to rest where the walls are now, with at least this viscosity [Pa s]."""
        own, began = self.particles.viscosity, self.time
        self.particles.viscosity = np.maximum(own, viscosity)
        self._frozen = began
        while self.time - began < duration:
            self.step()
        self._frozen = None
        self.time = began
        self.particles.viscosity = own
        self.velocity[:] = 0.0

    def park(self, gone: BoolArray) -> None:
        """Take particles out of the run, shape (n,): a long fall makes for short steps."""
        self.particles.holder[gone] = PARKED
        self.velocity[gone] = 0.0

    def step(self, longest: float = math.inf) -> FloatArray:
        """Move on by a step of at most ``longest`` [s] and return impulse and moment on each wall, shape (B, 6)."""
        dt = min(self.liquid.next_step(), longest)
        begun = self._poses(self.time)
        # As in a full simulation, no wall may go further in a step than a particle may.
        while self._way(begun, self._poses(self.time + dt)) > COURANT * self.particles.spacing:
            dt /= 2
        ended = self._poses(self.time + dt)
        (p0, r0), (p1, r1) = begun, ended
        turn = np.einsum("bij,bkj->bik", r1, r0)
        spin = np.stack(
            [turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], axis=1
        )
        velocity, spin = (p1 - p0) / dt, spin / (2 * dt)
        push = self.liquid.step(
            dt, self._walls, self._bodies(begun, velocity, spin), self._bodies(ended, velocity, spin)
        )
        self.time += dt
        return push

    def run(
        self, duration: float, each: Callable[[float, FloatArray], None] | None = None, *, longest: float = math.inf
    ) -> FloatArray:
        """Move on for ``duration`` [s] and return the mean force and moment on each wall, shape (B, 6).

        Args:
            duration: [s].
            each: Is given the length of each step [s] and the impulses on the walls.
            longest: Longest step [s].
        """
        total = np.zeros((len(self._motions), 6))
        end = self.time + duration
        while self.time < end - 1e-9:
            then = self.time
            # Equal steps to the end: a last one that is tiny would be a bad first guess for the next.
            left = end - self.time
            push = self.step(left / math.ceil(left / min(self.liquid.next_step(), longest) - 1e-9))
            total += push
            if each is not None:
                each(self.time - then, push)
        return total / duration

    def _poses(self, time: float) -> tuple[FloatArray, FloatArray]:
        if self._frozen is not None:
            time = self._frozen
        poses = [motion(time) for motion in self._motions]
        return (
            np.array([position for position, _ in poses]).reshape(-1, 3),
            np.array([rotation for _, rotation in poses]).reshape(-1, 3, 3),
        )

    def _way(self, begun: tuple[FloatArray, FloatArray], ended: tuple[FloatArray, FloatArray]) -> float:
        """Return how far walls go where there are particles [m]."""
        far = 0.0
        for p0, r0, p1, r1 in zip(*begun, *ended, strict=True):
            local = (self.position - p0) @ r0
            moved = local @ r1.T + p1 - self.position
            far = max(far, float(np.linalg.norm(moved, axis=1).max(initial=0.0)))
        return far

    def _bodies(self, poses: tuple[FloatArray, FloatArray], velocity: FloatArray, spin: FloatArray) -> Bodies:
        position, rotation = poses
        count = len(position)
        return Bodies(
            first=self._first,
            thing=np.arange(count),
            rotation=np.ascontiguousarray(rotation.reshape(-1, 9)),
            position=np.ascontiguousarray(position),
            velocity=np.ascontiguousarray(velocity),
            spin=np.ascontiguousarray(spin),
            centre=np.ascontiguousarray(position),
            # What is moved by a test does not yield.
            mobility=np.zeros((count, 10)),
            inertia=np.zeros((count, 10)),
        )


def cup(radius: float, height: float, *, wall: float = 0.005, hole: float = 0.0, lid: float = 0.0) -> Shape:
    """Return a cup that stands on z = 0, turned round the z axis.

    Args:
        radius: Inner radius [m].
        height: Inner height [m].
        wall: Thickness of wall and bottom [m].
        hole: Radius of a hole in the bottom [m].
        lid: Thickness of a lid [m]; 0 for none.
    """
    r, top = radius, wall + height
    drilled = (Hole(position=(0.0, 0.0, (wall + top) / 2), direction=(0.0, 0.0, -1.0), radius=hole),) if hole else ()
    if lid:
        outer = ((0.0, 0.0), (r + wall, 0.0), (r + wall, top + lid), (0.0, top + lid))
        return Shape(profile=(*outer, (0.0, top), (r, top), (r, wall), (0.0, wall)))
    outline = ((0.0, 0.0), (r + wall, 0.0), (r + wall, top), (r, top), (r, wall), (0.0, wall))
    return Shape(profile=outline, holes=drilled)


def box(half: Triple, centre: Triple = (0.0, 0.0, 0.0)) -> Geom:
    """Return a box with half edges and centre [m]."""
    return Geom(type="box", size=half, position=centre)


def trough(length: float, width: float, height: float, wall: float = 0.01) -> Shape:
    """Return an open box with inner measures [m] whose floor is at z = 0, its middle at x = y = 0."""
    half = wall / 2
    x, y, z = length / 2, width / 2, height / 2
    return Shape(
        geoms=(
            box((x + wall, y + wall, half), (0.0, 0.0, -half)),
            box((half, y + wall, z), (x + half, 0.0, z)),
            box((half, y + wall, z), (-x - half, 0.0, z)),
            box((x, half, z), (0.0, y + half, z)),
            box((x, half, z), (0.0, -y - half, z)),
        )
    )


GROUND = Shape(geoms=(Geom(type="plane"),))
"""The plane z = 0."""


def lattice(low: Triple, high: Triple, spacing: float) -> FloatArray:
    """Return the points of a cubic lattice in the middle of a box, shape (n, 3)."""
    axes: list[FloatArray] = []
    for a, b in zip(low, high, strict=True):
        count = max(round((b - a) / spacing), 1)
        half = (count - 1) / 2 * spacing
        axes.append(np.linspace((a + b) / 2 - half, (a + b) / 2 + half, count))
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    return grid.reshape(-1, 3)


def filled_cup(
    radius: float, depth: float, spacing: float, *, wall: float = 0.005, height: float = 0.0, pose: Pose | None = None
) -> FloatArray:
    """Return the particles of a liquid in a cup of ``cup``, the lowest places first, shape (n, 3).

    Args:
        radius: Inner radius of the cup [m].
        depth: Depth of the liquid in the upright cup [m].
        spacing: [m].
        wall: Thickness of the bottom [m].
        height: Inner height [m]; unlimited if it is 0.
        pose: Of the cup; at home without.
    """
    position, rotation = pose or still(0.0)
    top = height or 2 * depth
    reach = math.hypot(radius, top + wall)
    points = lattice((-reach, -reach, -reach), (reach, reach, reach), spacing) + position
    if pose is None:
        points[:, 2] += wall + spacing / 2 - points[points[:, 2] > wall, 2].min()
    local = (points - position) @ rotation
    room = np.minimum(radius - np.hypot(local[:, 0], local[:, 1]), local[:, 2] - wall)
    points = points[(room > 0.49 * spacing) & (local[:, 2] < wall + top)]
    count = round(math.pi * radius**2 * depth / spacing**3)
    if len(points) < count:
        raise ValueError(f"{count} particles do not fit among {len(points)} places")
    return points[np.argsort(points[:, 2], kind="stable")[:count]]

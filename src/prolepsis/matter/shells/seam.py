"""A seam: the crack that an edge makes in a thin shell, and when it runs all round as the ends are bent or drawn apart.

It lies in the plane of the edge and of what it presses in. What the blow leaves of it is where the stress round a load
no longer opens it; it runs on once the force and the moment across its plane do.

Source:
    E. S. Folias, A finite line crack in a pressurized spherical shell, Int. J. Fracture Mech. 1:20 (1965), for what a
    shell's curvature adds; Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells (1959), chapter 14, for the
    stress round a load; Tada, Paris and Irwin, The Stress Analysis of Cracks Handbook, for a crack under any stress.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.rotations import cross, matrix
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.log.things import Thing
from prolepsis.matter.shells.bond_graph import BondGraph, bending_length
from prolepsis.matter.shells.cascade import Pressing
from prolepsis.matter.shells.crushing_front import across
from prolepsis.scene.nearby import distance_to
from prolepsis.scene.running import Running

BULGE = 1.93
"""Of a crack of half length a in a sphere of radius R and thickness t: its stress is as of one in a plate, times the
root of 1 + this a^2 / R t [1]."""
BESIDE = 2.0
"""What presses nearer to a seam, over the length in which a shell bends, presses on it [1]."""
FOOT = 3.0e-4
"""What is so much farther from a shell than the nearest of it presses on it, too, once that gives way [m]."""
SLENDER = 0.5
"""Breadth over length of what an edge presses on, at most [1]."""
PATCH, STEPS = 0.008, 17
"""Half width [m] of the patch of a shell that is looked at, and points along each side."""
CLOSED = 2.047
"""Under a load the shell is pressed together to this distance, over the length in which it bends: zero of
``1 / x^2 - ker''(x)`` [1]."""
DIRECTIONS = 72
"""In which the radius of a section is measured."""
ARCS = np.radians(np.arange(1.0, 91.0))
"""Half lengths of cracks that are tried [rad]: what is known of plates goes no farther."""


@dataclass(kw_only=True, slots=True)
class Seam:
    """A crack along a plane section of an ellipsoidal shell; all in the frame of the whole shell."""

    normal: FloatArray
    """Unit normal of the plane, shape (3,)."""
    middle: FloatArray
    """Middle of the section [m], shape (3,)."""
    towards: FloatArray
    """Unit vector from there to where the crack began, shape (3,)."""
    radius: float
    """Mean radius of the section [m]."""
    arc: float
    """The crack reaches so far to either side of where it began [rad]."""

    def across(self, graph: BondGraph) -> BoolArray:
        """Return which bonds of a graph join what is on both sides, shape (m,)."""
        side = (graph.centres - self.middle) @ self.normal > 0
        return side[graph.bonds[:, 0]] != side[graph.bonds[:, 1]]

    def cracked(self, graph: BondGraph, weakening: float) -> BondGraph:
        """Return a graph whose bonds it has come to have cracked, weaker by a factor at the tips of cracks [1]."""
        arms = graph.centres[graph.bonds].mean(axis=1) - self.middle
        arc = np.arctan2(np.abs(arms @ np.cross(self.normal, self.towards)), arms @ self.towards)
        return graph.after_breaking(self.across(graph) & (arc <= self.arc) & ~graph.cracked, weakening)

    def opens(self, graph: BondGraph, points: FloatArray, forces: FloatArray, toughness: float) -> float:
        """Return stress intensity over toughness [1]: at 1 the crack runs, and as it grows with its length, all round.

        Args:
            graph: The shell.
            points: Where it is pressed [m], shape (c, 3).
            forces: With what [N], shape (c, 3).
            toughness: Fracture toughness [Pa m^0.5].
        """
        force, moment = self._resultants(graph, points, forces)
        wall = math.pi * self.radius * graph.thickness
        stress = force / (2 * wall) + moment / (wall * self.radius)
        half = self.radius * self.arc
        bulge = math.sqrt(1 + BULGE * half**2 / (self.radius * graph.thickness))
        return stress * math.sqrt(math.pi * half) * bulge / toughness

    def _resultants(self, graph: BondGraph, points: FloatArray, forces: FloatArray) -> tuple[float, float]:
        """Return the pull across the plane [N] and the moment that opens it where the crack began [N m]."""
        mass, centres = graph.masses, graph.centres
        middle = mass @ centres / mass.sum()
        arms = centres - middle
        tensor = float(mass @ (arms**2).sum(axis=1)) * np.eye(3) - (mass[:, None] * arms).T @ arms
        shift = forces.sum(axis=0) / mass.sum()
        torque: FloatArray = cross(points - middle, forces).sum(axis=0)
        spin = np.asarray(np.linalg.solve(tensor, torque), dtype=np.float64)
        inertial = -mass[:, None] * (shift + cross(spin[None], arms))
        # What presses on the seam itself presses on both sides.
        share = np.clip(0.5 + (points - self.middle) @ self.normal / (2 * BESIDE * graph.bent), 0.0, 1.0)
        beyond = (centres - self.middle) @ self.normal > 0
        levers = np.concatenate([points, centres[beyond]]) - self.middle
        acting = np.concatenate([share[:, None] * forces, inertial[beyond]])
        moment = cross(levers, acting).sum(axis=0)
        return float(acting.sum(axis=0) @ self.normal), float(moment @ np.cross(self.towards, self.normal))


def begun_seam(
    state: Running, thing: Thing, pressing: Pressing, forces: FloatArray, graph: BondGraph, toughness: float
) -> Seam | None:
    """Return the seam that what presses most on a shell begins, if that is an edge.

    Args:
        state: The running scene.
        thing: The whole that has the shell, an ellipsoid.
        pressing: The contacts.
        forces: With which each of them presses while the crack runs [N], shape (c,).
        graph: The shell.
        toughness: Fracture toughness [Pa m^0.5].
    """
    most = int(forces.argmax())
    axes, pose = np.array(thing.shape.geoms[0].size), state.pose(thing.name)
    point = pressing.points[most] / np.linalg.norm(pressing.points[most] / axes)
    patch = patch_round(axes, point)
    geom = int(state.model.geom(f"{thing.name}/0").id)
    other = across(state, geom, int(pressing.numbers[most]))[0]
    edge = edge_along(patch, distance_to(state, other, patch @ matrix(pose[3:]).T + pose[:3]))
    if edge is None:
        return None
    seam = seam_along(axes, point, edge)
    seam.arc = arc_after(float(forces[most]), seam.radius, graph.thickness, graph.poisson_ratio, toughness)
    return seam


def patch_round(semi_axes: FloatArray, point: FloatArray) -> FloatArray:
    """Return points all over a shell round a point of it, shape (STEPS^2, 3) [m]."""
    normal = point / semi_axes**2
    normal /= np.linalg.norm(normal)
    along = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    along /= np.linalg.norm(along)
    steps = np.linspace(-PATCH, PATCH, STEPS)
    u, v = (grid.ravel()[:, None] for grid in np.meshgrid(steps, steps))
    flat = point + u * along + v * np.cross(normal, along)
    return flat / np.linalg.norm(flat / semi_axes, axis=1)[:, None]


def edge_along(points: FloatArray, distances: FloatArray) -> FloatArray | None:
    """Return the direction of an edge at which points, shape (n, 3), have some distances [m], shape (3,), else None."""
    pressed = points[distances < distances.min() + FOOT]
    if len(pressed) < 3:
        return None
    arms = pressed - pressed.mean(axis=0)
    size, axes = np.linalg.eigh(arms.T @ arms)
    return axes[:, 2] if size[1] < SLENDER**2 * size[2] else None


def seam_along(semi_axes: FloatArray, point: FloatArray, edge: FloatArray) -> Seam:
    """Return the seam, of no length yet, that an edge in some direction, shape (3,), begins at a point, shape (3,)."""
    inward = -point / semi_axes**2
    normal = np.cross(edge, inward)
    normal /= np.linalg.norm(normal)
    turned = semi_axes**2 * normal
    middle = float(point @ normal) / float(normal @ turned) * turned
    towards = (point - middle) / np.linalg.norm(point - middle)
    angles = np.linspace(0, 2 * np.pi, DIRECTIONS, endpoint=False)[:, None]
    rays = np.cos(angles) * towards + np.sin(angles) * np.cross(normal, towards)
    # |(middle + r ray) / semi_axes| = 1
    a = ((rays / semi_axes) ** 2).sum(axis=1)
    b = (rays * middle / semi_axes**2).sum(axis=1)
    c = float(((middle / semi_axes) ** 2).sum()) - 1
    radius = float(((np.sqrt(b**2 - a * c) - b) / a).mean())
    return Seam(normal=normal, middle=middle, towards=towards, radius=radius, arc=0.0)


def arc_after(force: float, radius: float, thickness: float, poisson_ratio: float, toughness: float) -> float:
    """Return how far a crack runs to either side of where a force presses a shell [rad].

    Under the load the shell is pressed together, and the faces of a crack stay closed; farther out it is drawn apart by
    a stress that falls with the square of the distance.

    Args:
        force: With which it does [N].
        radius: Of the shell [m].
        thickness: Of the shell [m].
        poisson_ratio: Of the shell [1].
        toughness: Fracture toughness [Pa m^0.5].
    """
    closed, far = CLOSED * bending_length(radius, thickness, poisson_ratio), radius * ARCS
    drawn = force * radius / (2 * math.pi * thickness)
    ends = far[far > closed]
    intensity = drawn * np.sqrt(math.pi * (ends - closed) / 2) / (ends * np.sqrt(ends * closed))
    runs = ends[intensity >= toughness]
    return float(runs[-1] if len(runs) else closed) / radius

"""A crushing front: how far what has pressed a shell through goes on into it, and which pieces it takes along.

What crushes a thin closed shell meets a rim that grows as the root of the depth, so the force does, and the energy that
is taken up grows with the depth to the power of 3/2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.scene.nearby import distance_to
from prolepsis.scene.running import Running

FURTHEST = 100.0
"""How deep what already touches the yolk goes, over how deep that lies [1]."""


@dataclass(kw_only=True, slots=True)
class Crushed:
    """How far a thing has crushed a shell."""

    by: int
    """The thing's index."""
    blow: float
    """So near to it all is crushed that does not give way in a blow [m]."""
    all: float
    """So near to it all of the shell is crushed, be it by what presses on [m]."""


@dataclass(kw_only=True, slots=True)
class CrushingFront:
    """How far a shell has been crushed, by what."""

    crushed: list[Crushed] = field(default_factory=list[Crushed])
    """By each thing that has pressed it through."""
    force: float = 0.0
    """With which it presses where it comes to rest [N]."""

    def go_in(
        self, state: Running, geom: int, contacts: Sequence[int], force: float, depth: tuple[float, float]
    ) -> None:
        """Come to rest in what is touched at some contacts.

        Args:
            state: The running scene.
            geom: Number of the shell's geom.
            contacts: Numbers of the contacts at which it is pressed through.
            force: Under which it is [N].
            depth: Of the dents by then [m], and how deep they would have become under that force, over that [1].
        """
        blow = front_growth(depth[1])
        for contact in contacts:
            # It comes to rest where the energy is spent, and not before it bears what is behind it.
            growth = max(blow, (_driven(state, contact) / force) ** 2)
            self.force = max(self.force, force * growth**0.5)
            # How deep what touches it is in the shell by now is the zero from which the front is deep.
            other, by_now = across(state, geom, contact)[0], float(state.data.contact.dist[contact])
            self.crushed.append(Crushed(by=other, blow=depth[0] * blow + by_now, all=depth[0] * growth + by_now))

    def loosens(self, state: Running, centres: FloatArray) -> BoolArray:
        """Return which pieces come loose, given their centres, world frame [m], shape (n, 3), shape (n,)."""
        found = np.zeros(len(centres), dtype=np.bool_)
        for each in self.crushed:
            found |= distance_to(state, each.by, centres) < each.all
        return found

    def pierces(self, state: Running, middle: FloatArray, radius: float) -> float:
        """Return how deep edges are driven in, over how deep a floating ball lies, of a radius [m] about a world point.

        From 1 on they pierce it. What presses slowly pushes it aside.
        """
        share = 0.0
        for each in self.crushed:
            if each.blow >= each.all > 0.0:
                deep = float(distance_to(state, each.by, middle[None])[0]) - radius
                share = max(share, each.blow / max(deep, each.blow / FURTHEST))
        return share


def front_growth(beyond: float) -> float:
    """Return how much deeper than when it opens a shell is crushed [1].

    Args:
        beyond: How deep a dent would have become under the force that it bears, over the depth at which it opens [1].
    """
    return float((1 + 1.5 * (beyond - 1)) ** (2 / 3))


def across(state: Running, geom: int, contact: int) -> tuple[int, FloatArray]:
    """Return the index of the thing that touches a geom at a contact, and the direction into the geom, shape (3,)."""
    name = state.model.geom(_other(state, geom, contact)).name.rpartition("/")[0]
    sign = 1.0 if state.touching()[contact][1] == geom else -1.0
    return state.scene.index(name), sign * state.data.contact.frame[contact, :3]


def _driven(state: Running, contact: int) -> float:
    """Return the force with which two bodies that touch are driven together [N]."""
    return max(state.driving_force(each, contact) for each in state.touching()[contact])


def _other(state: Running, geom: int, contact: int) -> int:
    first, second = state.touching()[contact]
    return second if first == geom else first


def stop(state: Running, body: str, geom: int, contact: int) -> None:
    """Let a body come no closer to what touches its geom at a contact: that has spent its energy on crushing it."""
    _, inward = across(state, geom, contact)
    point = state.data.contact.pos[contact]
    beside = state.velocity_at(state.model.body(state.model.geom_bodyid[_other(state, geom, contact)]).name, point)
    approach = float((beside - state.velocity_at(body, point)) @ inward)
    state.data.joint(body).qvel[:3] += max(approach, 0.0) * inward


def come_out(state: Running, bodies: Sequence[Sequence[int]], pressing: Sequence[tuple[int, FloatArray]]) -> None:
    """Move bodies, each given by its pieces, out of what has pressed a dent, as that has moved them in the shell.

    Args:
        state: The running scene.
        bodies: The pieces of each, by their indices; the first gives it its name.
        pressing: What presses, and in which direction, world frame, shape (3,).
    """
    things, moved = state.scene.things, [np.zeros(3) for _ in bodies]
    for number, pieces in enumerate(bodies):
        corners: list[FloatArray] = []
        for i in pieces:
            pose = state.pose(things[i].name)
            corners += [np.asarray(geom.vertices) @ matrix(pose[3:]).T + pose[:3] for geom in things[i].shape.geoms]
        for other, inward in pressing:
            deep = -float(distance_to(state, other, np.concatenate(corners)).min())
            moved[number] += max(deep, 0.0) * inward
    for pieces, shift in zip(bodies, moved, strict=True):
        state.data.joint(things[pieces[0]].name).qpos[:3] += shift
    state.renew_poses(centres=True)

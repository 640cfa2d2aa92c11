"""Sticking: a cracked shell sticks to the kernel inside it, and pieces of shell that are wet stick to what they touch.

A film of liquid between a piece of radius R and a flat surface draws it on with ``4 pi gamma R cos(theta)``. The film
runs out: down to a thickness h it takes ``eta L / (rho g h^2)`` along a piece of length L that hangs upright.

Source:
    Israelachvili, Intermolecular and Surface Forces, for the force; Jeffreys, Proc. Camb. Phil. Soc. 26 (1930), for the
    draining of a film.
"""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.films.adhesion import Adhesion, AdhesiveJoint
from prolepsis.scene.parts import Kernel, Shard
from prolepsis.scene.running import Running

LOOK_TICKS = 20
"""What touches is looked at every so many ticks; what did so twice sticks."""
SLOW = 0.02
"""Speed relative to each other below which two things stick [m/s]."""
GENTLE = 0.1
"""What is pressed harder in one contact [N] does not begin to stick: shards that are jammed in a grip shake."""
BELOW = 0.5
"""What lies under a piece, its normal within 60 degrees of up, carries it: nothing need stick [1]."""


class Sticking(Adhesion):
    """The controller of all pieces of shells."""

    def __init__(self, state: Running) -> None:
        """Attach to a simulation."""
        super().__init__()
        self._things = state.scene.things
        self._index = {thing.name: i for i, thing in enumerate(self._things)}
        self._shards = {self._index[shard.name]: shard for shard in state.scene.each(Shard)}
        self._kernels = {self._index[kernel.name]: kernel for kernel in state.scene.each(Kernel) if kernel.adhesion}
        self._candidates: dict[tuple[int, int], tuple[FloatArray, FloatArray]] = {}
        self._ticks = 0
        self._due = False

    def end_tick(self, state: Running) -> None:
        """Let it be looked at what has come to stick together."""
        del state
        self._ticks += 1
        self._due = True

    def act(self, state: Running) -> None:
        """Find what has come to stick together, and take apart what is pulled too hard."""
        if self._due:
            self._due = False
            new = self._opened(state)
            if self._ticks % LOOK_TICKS == 0 and state.particles is not None and state.particles.free.any():
                new += self._wetted(state)
            if new:
                self.stick(state, new)
                return
        super().act(state)

    def _opened(self, state: Running) -> list[AdhesiveJoint]:
        """Return what holds the pieces of shells that have just opened to their kernels."""
        found: list[AdhesiveJoint] = []
        for kernel in [k for k in self._kernels if state.carrier[k] == k]:
            known, thing = self._kernels.pop(kernel), self._things[kernel]
            for piece, shard in sorted(self._shards.items()):
                if shard.whole != known.whole:
                    continue
                part = self._things[piece]
                # The pieces are where they were in the whole, so their places say which way is out.
                out = (np.array(part.position) - np.array(thing.position)) @ matrix(np.array(thing.orientation))
                out = out / np.asarray(thing.shape.geoms[0].size) ** 2
                found.append(
                    AdhesiveJoint(
                        holder=kernel,
                        held=piece,
                        point=np.zeros(3),
                        normal=out / np.linalg.norm(out),
                        strength=known.adhesion * shard.area,
                    )
                )
        return found

    def _wetted(self, state: Running) -> list[AdhesiveJoint]:
        """Return what holds wet pieces to what they have touched at two looks."""
        known = {(hold.holder, hold.held) for hold in self.holds}
        before, self._candidates = self._candidates, {}
        found: list[AdhesiveJoint] = []
        for (holder, piece), (point, out) in self._touching(state).items():
            if (holder, piece) in known or not state.attribute(self._things[piece].name, "wet"):
                continue
            self._candidates[holder, piece] = (point, out)
            if (holder, piece) in before:
                found += self._hold(state, holder, piece, point, out)
        return found

    def _touching(self, state: Running) -> dict[tuple[int, int], tuple[FloatArray, FloatArray]]:
        """Return where pieces touch what does not lie under them, and the normal out of that, world frame."""
        contact = state.data.contact
        found: dict[tuple[int, int], tuple[FloatArray, FloatArray]] = {}
        up = -np.asarray(state.scene.gravity)
        up = up / max(float(np.linalg.norm(up)), 1e-9)
        for row, (a, b) in enumerate(contact.geom.tolist()):
            address = int(contact.efc_address[row])
            if address < 0 or float(state.data.efc_force[address]) > GENTLE:
                continue
            first, second = (self._index.get(state.model.geom(g).name.rpartition("/")[0], -1) for g in (a, b))
            for piece, other, sign in ((second, first, 1.0), (first, second, -1.0)):
                out = sign * contact.frame[row, :3]
                if piece not in self._shards or other < 0 or other in self._shards or float(out @ up) > BELOW:
                    continue
                speeds = [state.velocity(self._things[i].name) for i in (piece, other)]
                if float(np.linalg.norm(speeds[0] - speeds[1])) < SLOW:
                    found[other, piece] = (contact.pos[row].copy(), out.copy())
        return found

    def _hold(self, state: Running, holder: int, piece: int, point: FloatArray, out: FloatArray) -> list[AdhesiveJoint]:
        particles = state.particles
        assert particles is not None
        free = np.flatnonzero(particles.free)
        nearest = free[np.argmin(np.linalg.norm(particles.position[free] - point, axis=1))]
        liquid = self._things[int(particles.stuff[nearest])].quantities
        if not {"surfaceTension", "contactAngle", "filmThickness"} <= liquid.keys():
            return []
        shard = self._shards[piece]
        length = math.sqrt(shard.area)
        gravity = float(np.linalg.norm(state.scene.gravity))
        thin = liquid["density"] * max(gravity, 1e-9) * liquid["filmThickness"] ** 2
        pose, base = state.pose(self._things[piece].name), state.pose(self._things[holder].name)
        strength = 4 * math.pi * liquid["surfaceTension"] * shard.radius * math.cos(liquid["contactAngle"])
        if strength <= 0:
            return []
        hold = AdhesiveJoint(
            holder=holder,
            held=piece,
            point=(point - pose[:3]) @ matrix(pose[3:]),
            normal=out @ matrix(base[3:]),
            strength=strength,
            slides=True,
            lasting=liquid["viscosity"] * length / thin,
            since=float(state.data.time),
        )
        return [hold]

"""Yielding: what is soft gives way to a shell, by which it stops more slowly and is pressed on over a patch."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.matter.shells.bond_graph import bending_length
from prolepsis.matter.shells.cascade import Pressing
from prolepsis.matter.shells.contact import NEAR, ShellContact, stiffen
from prolepsis.matter.shells.padding import Padding, concentration, padding_of, spread_under
from prolepsis.scene.running import Running

DAMPING_RATIO = 0.01
"""Damping of contact with padding [1]: it loses energy by a law of its own."""
SOFTEST = 1.0
"""Stiffness of such a contact before it carries anything [N/m]."""
FORCE_ROWS = np.arange(3)
"""Rows of the normal and the two tangential forces of a contact, from its first one."""
HERTZ = 0.4
"""Mean square of the distance of the pressure from its middle over the squared radius of a contact with a plate [1]."""


@dataclass(kw_only=True, slots=True)
class Padded:
    """A contact pair of a shell with something soft."""

    name: str
    """Of the pair."""
    geom: int
    """The other one's number."""
    padding: Padding
    shift: float = 0.0
    """Lowering of the surface by which the contact, as stiff as both are now, has the right force [m]."""
    depth: float = 0.0
    """By which the padding has given way [m]."""
    height: float = 1.0
    """That of the shell's middle over it, if neither were deformed [m]."""
    approach: float = 0.0
    """How fast the shell comes closer [m/s]."""
    out: FloatArray = field(default_factory=lambda: np.zeros(3))
    """Unit normal out of it, world frame, shape (3,)."""


class ShellPadding:
    """What is soft and may touch one thing with an ellipsoidal shell."""

    def __init__(self, thing: Thing, shell: Mapping[str, float], contact: ShellContact) -> None:
        """Look after ``thing``, given the quantities of its ``shell`` and its ``contact`` with what is hard."""
        self._thing, self._contact = thing, contact
        self._semi_axes = np.array(thing.shape.geoms[0].size)
        self._breaking_force = shell["breakingForce"]
        # As at one point, if nothing is known.
        self._cushioned_force = max(shell.get("cushionedBreakingForce", 0.0), self._breaking_force)
        self._thickness, self._poisson_ratio = shell["shellThickness"], shell["poissonRatio"]
        self.lifted, self.stopped = np.zeros(3), np.zeros(3)
        """How far it has come out when it fell apart [m], and what that took of its velocity [m/s]."""
        self._padded: dict[int, Padded] = {}
        self._number = -1

    def __bool__(self) -> bool:
        """Return whether there is any."""
        return bool(self._padded)

    @property
    def is_pressed(self) -> bool:
        """Whether the shell presses on something soft now."""
        return any(each.depth > 0.0 for each in self._padded.values())

    def bind(self, state: Running) -> None:
        """Look up in a model that is new which contacts are with something soft."""
        known, model = {each.name: each for each in self._padded.values()}, state.model
        self._number, self._padded = int(model.geom(f"{self._thing.name}/0").id), {}
        for p, pair in enumerate(zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True)):
            if self._number not in pair:
                continue
            other, name = pair[0] if pair[1] == self._number else pair[1], model.pair(p).name
            extent = 2.0 * float(model.geom_aabb[other, 3:].min()) or math.inf
            quantities = state.scene.thing(model.geom(other).name.rpartition("/")[0]).quantities
            found = padding_of(quantities, extent, extent / 2.0 + float(self._semi_axes.min()))
            if found is not None:
                self._padded[p] = known.get(name) or Padded(name=name, geom=other, padding=found)
                self._padded[p].geom = other
                model.pair_gap[p] = NEAR + self._padded[p].shift
                if name not in known:
                    stiffen(model, p, SOFTEST, DAMPING_RATIO)
        self._contact.padded = frozenset(self._padded)

    def shift(self, pair: int) -> float:
        """Return by how much the surface of a contact pair is lowered [m]."""
        return self._padded[pair].shift if pair in self._padded else 0.0

    def give_way(self, state: Running) -> None:
        """Let what is soft give way in the coming substep as it does to the shell: two springs in series."""
        model, data = state.model, state.data
        frame = data.body(self._thing.name).xmat.reshape(3, 3)
        pairs = {each.geom: p for p, each in self._padded.items()}
        for k, (a, b) in enumerate(state.touching()):
            other = a if b == self._number else b
            if self._number not in (a, b) or other not in pairs:
                continue
            p, point = pairs[other], data.contact.pos[k]
            padded = self._padded[p]
            away = data.contact.frame[k, :3] if a == self._number else -data.contact.frame[k, :3]
            here, there = (
                state.velocity_at(model.body(model.geom_bodyid[geom]).name, point) for geom in (self._number, other)
            )
            approach = float((here - there) @ away)
            # Contacts are those from before the substep.
            dent = -float(model.pair_margin[p]) - padded.shift
            deep = approach * float(model.opt.timestep) - float(data.contact.dist[k]) - dent
            height = float(np.linalg.norm(self._semi_axes * (away @ frame)))
            stiffness, padded.shift, padded.depth = SOFTEST, 0.0, 0.0
            if deep > 0.0:
                padded.depth, force, rising = padded.padding.gives(
                    deep, self._contact.stiffness, self._radius(height), height, padded.padding.share(approach)
                )
                # No softer than from the surface on, or it would be felt from afar.
                stiffness = max(rising, force / deep, SOFTEST)
                padded.shift = max(deep - force / stiffness, 0.0)
            padded.height, padded.approach, padded.out = height, approach, -away
            # Where margin and gap add up to less than 0, MuJoCo tells another distance.
            model.pair_margin[p], model.pair_gap[p] = -dent - padded.shift, NEAR + padded.shift
            stiffen(model, p, stiffness, DAMPING_RATIO)

    def come_out(self, state: Running) -> None:
        """Lift the shell out of what is soft, which has stopped it: what falls apart within would not find the way."""
        pressed = [each for each in self._padded.values() if each.depth > 0.0]
        if not pressed:
            return
        for each in pressed:
            self.lifted += each.depth * each.out
            self.stopped += max(each.approach, 0.0) * each.out
        joint = state.data.joint(self._thing.name)
        joint.qpos[:3] += self.lifted
        joint.qvel[:3] += self.stopped
        state.renew_forces()

    def points(self, state: Running, contacts: IntArray) -> FloatArray:
        """Return where contacts, by number, press on the shell, world frame [m], shape (c, 3).

        What is pressed into something soft is touched at its surface, not half-way between both surfaces.
        """
        soft = {each.geom: each.out for each in self._padded.values() if each.depth > 0.0}
        points = state.data.contact.pos[contacts]
        for row, number in enumerate(contacts.tolist() if soft else ()):
            for geom in state.touching()[number]:
                if geom in soft:
                    points[row] += state.data.contact.dist[number] / 2.0 * soft[geom]
        return points

    def shares(self, state: Running, contacts: IntArray) -> FloatArray:
        """Return what part of the force of contacts, by number, would load the shell as much between plates [1].

        What gives way presses on a patch. The shell is bent less under its middle; the rest of it is loaded as between
        cushions.
        """
        soft = {each.geom: self._share(each) for each in self._padded.values() if each.depth > 0.0}
        numbers: list[int] = contacts.tolist()
        return np.array([min(soft.get(geom, 1.0) for geom in state.touching()[number]) for number in numbers])

    def _share(self, padded: Padded) -> float:
        radius = self._radius(padded.height)
        length = bending_length(radius, self._thickness, self._poisson_ratio)
        plate = HERTZ * radius * self._breaking_force / self._contact.stiffness
        patch = plate + spread_under(padded.padding, radius, padded.height, padded.depth)
        bent = concentration(patch, length) / concentration(plate, length)
        return bent + (1.0 - bent) * self._breaking_force / self._cushioned_force

    def _radius(self, height: float) -> float:
        """Return the mean radius of the shell where its middle is at a height over what it touches [m]."""
        return float(np.prod(self._semi_axes)) / height**2


def pressing_on(state: Running, body: int, origin: FloatArray, padding: ShellPadding | None) -> Pressing:
    """Return what presses on a part of a shell.

    Args:
        state: The running scene.
        body: Number of its body.
        origin: Place of the body's frame in the shell's frame [m], shape (3,).
        padding: What is soft there, if it is the whole.
    """
    contact = state.data.contact
    found = [
        (k, 1.0 if second == body else -1.0) for k, first, second, _ in state.normal_forces() if body in (first, second)
    ]
    numbers = np.array([number for number, _ in found])
    sign = np.array([sign for _, sign in found])
    local = state.data.efc_force[contact.efc_address[numbers][:, None] + FORCE_ROWS]
    force = np.einsum("cij,ci->cj", contact.frame[numbers].reshape(-1, 3, 3), local)
    rotation = state.data.xmat[body].reshape(3, 3)
    share = padding.shares(state, numbers) if padding is not None else 1.0
    points = padding.points(state, numbers) if padding is not None else contact.pos[numbers]
    return Pressing(
        numbers=numbers,
        points=(points - state.data.xpos[body]) @ rotation + origin,
        forces=(share * sign)[:, None] * force @ rotation,
        normal=local[:, 0],
    )

"""What holds two things together where they stick: a joint at a point that gives way when it is pulled too hard.

Pressing them together is left to contact. A pull out of the holder's surface or along it that is stronger than the hold
takes them apart, unless it is but a jolt.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray
from prolepsis.scene.kind import Controller
from prolepsis.scene.running import PointJoint, Running

JOLT = 0.005
"""A pull counts as its mean over this time [s]: what sticks takes some milliseconds to come off."""

MOST_PRESSED = 2.0
"""What slides does so while it is pressed together harder than it holds by this factor [1]."""


@dataclass(kw_only=True, slots=True)
class AdhesiveJoint:
    """One thing that sticks to another."""

    holder: int
    """Index of the thing that holds."""
    held: int
    """Index of the thing that is held."""
    point: FloatArray
    """Point where it sticks, in the frame of the held [m], shape (3,)."""
    normal: FloatArray
    """Unit vector out of the holder's surface there, in the holder's frame, shape (3,)."""
    strength: float
    """Pull at which it comes off at the start [N]."""
    slides: bool = False
    """Whether it bears nothing while the two are pressed together hard, and holds on where they are then, as a film."""
    lasting: float = math.inf
    """Time in which it loses all but a third of its strength [s]."""
    since: float = 0.0
    """When it began [s]."""
    pull: float = 0.0
    """Mean pull of late [N]."""
    loose: bool = False
    """Whether it slides now, so that no joint holds."""
    point_on_holder: FloatArray | None = None
    """The same point in the frame of the holder [m], shape (3,); None until they have been joined."""

    def strength_at(self, time: float) -> float:
        """Return the pull that it bears at a time [N]."""
        return self.strength * math.exp(-(time - self.since) / self.lasting)


class Adhesion(Controller):
    """The controller of what sticks together, whatever makes it stick."""

    def __init__(self) -> None:
        """Begin with nothing that sticks."""
        self.holds: list[AdhesiveJoint] = []
        self._joined: list[AdhesiveJoint] = []
        self._numbers: list[int] = []
        self._bodies: dict[int, int] = {}
        self._turned: dict[int, FloatArray] = {}
        self._told: set[tuple[int, int]] = set()

    def stick(self, state: Running, holds: Sequence[AdhesiveJoint]) -> None:
        """Let things stick together where they are now."""
        if holds:
            self.holds += holds
            self._join(state)

    def rejoin(self, state: Running) -> None:
        """Make its joints anew."""
        if self.holds:
            self._join(state)

    def bind(self, state: Running) -> None:
        """Look up its joints in a model that is new."""
        self._numbers = state.joint_numbers(self)
        self._know_bodies(state)

    def _know_bodies(self, state: Running) -> None:
        self._bodies = {thing: body for body, thing in enumerate(state.body_thing.tolist()) if thing >= 0}
        self._turned = {}

    def act(self, state: Running) -> None:
        """Take apart what is pulled too hard; nothing breaks by that."""
        if not self.holds or not self._joined:
            return
        time = float(state.data.time)
        share = min(1.0, float(state.model.opt.timestep) / JOLT)
        forces = state.joint_forces()
        kept = {id(hold) for hold in self.holds}
        pressed = _pressed(state) if any(hold.slides for hold in self._joined) else {}
        for joint, hold in zip(self._numbers, self._joined, strict=True):
            if id(hold) not in kept:
                continue
            if hold.slides and pressed.get(self._pair(state, hold), 0.0) > MOST_PRESSED * hold.strength:
                state.data.eq_active[joint] = 0
                hold.pull, hold.since, hold.loose = 0.0, time, True
                continue
            if hold.loose:
                self._renew(state, hold)
                state.data.eq_active[joint] = 1
                hold.loose = False
            if joint not in forces:
                continue
            out = self._rotation(state, hold.holder) @ hold.normal
            force = forces[joint]
            along = float(force @ out)
            # What presses them together is no pull.
            pull = math.hypot(max(along, 0.0), float(np.linalg.norm(force - along * out)))
            hold.pull += share * (pull - hold.pull)
            if hold.pull > hold.strength_at(time):
                state.data.eq_active[joint] = 0
                self.holds = [kept for kept in self.holds if kept is not hold]
        self._report(state)

    def _pair(self, state: Running, hold: AdhesiveJoint) -> tuple[int, int]:
        """Return the numbers of the two bodies, the lower one first."""
        first, second = (self._bodies[int(state.carrier[thing])] for thing in (hold.holder, hold.held))
        return (first, second) if first < second else (second, first)

    def _renew(self, state: Running, hold: AdhesiveJoint) -> None:
        """Let a hold be where the two things are now, without strain."""
        hold.point_on_holder = self._seen_from_holder(state, hold)
        number = next(k for k, joined in enumerate(self._joined) if joined is hold)
        state.move_joint(self._numbers[number], *self._points(state, hold))

    def _join(self, state: Running) -> None:
        """Make the joints anew."""
        for hold in self.holds:
            if hold.point_on_holder is None:
                hold.point_on_holder = self._seen_from_holder(state, hold)
        self._joined = [hold for hold in self.holds if state.carrier[hold.holder] != state.carrier[hold.held]]
        joints: list[PointJoint] = []
        for hold in self._joined:
            first, second = (self._carrier(state, thing) for thing in (hold.holder, hold.held))
            on_first, on_second = self._points(state, hold)
            joints.append(PointJoint(first=first, second=second, point_on_first=on_first, point_on_second=on_second))
        self._numbers = state.join(self, joints)
        self._know_bodies(state)
        for number, hold in zip(self._numbers, self._joined, strict=True):
            state.data.eq_active[number] = not hold.loose
        self._report(state)

    def _report(self, state: Running) -> None:
        """Tell the log what sticks to what."""
        pairs = {(int(state.carrier[hold.holder]), int(state.carrier[hold.held])) for hold in self.holds}
        if pairs != self._told:
            self._told = pairs
            state.stick(self, ((holder, held) for holder, held in pairs if holder != held))

    def _points(self, state: Running, hold: AdhesiveJoint) -> tuple[FloatArray, FloatArray]:
        """Return the point of a hold in the frames of the two bodies [m]."""
        assert hold.point_on_holder is not None
        first, second = state.offsets[hold.holder], state.offsets[hold.held]
        return (
            first[:3] + matrix(first[3:]) @ hold.point_on_holder,
            second[:3] + matrix(second[3:]) @ hold.point,
        )

    def _carrier(self, state: Running, thing: int) -> str:
        return state.scene.things[int(state.carrier[thing])].name

    def _rotation(self, state: Running, thing: int) -> FloatArray:
        if thing not in self._turned:
            self._turned[thing] = matrix(state.offsets[thing, 3:])
        return state.data.xmat[self._bodies[int(state.carrier[thing])]].reshape(3, 3) @ self._turned[thing]

    def _seen_from_holder(self, state: Running, hold: AdhesiveJoint) -> FloatArray:
        things = state.scene.things
        held, holder = state.pose(things[hold.held].name), state.pose(things[hold.holder].name)
        world = held[:3] + matrix(held[3:]) @ hold.point
        return (world - holder[:3]) @ matrix(holder[3:])


def _pressed(state: Running) -> dict[tuple[int, int], float]:
    """Return the force with which contact presses bodies together [N], by their numbers, the lower one first."""
    found: dict[tuple[int, int], float] = {}
    for _, first, second, force in state.normal_forces():
        pair = (first, second) if first < second else (second, first)
        found[pair] = found.get(pair, 0.0) + force
    return found

"""The waist of the hourglass: what one run left behind, as immutable columns at a fixed tick.

Physics writes it, recognition reads it, and neither knows the other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import FloatArray, IntArray, Triple
from prolepsis.log.happenings import DETACHMENT, Happenings
from prolepsis.log.outcomes import Outcome
from prolepsis.log.things import Thing
from prolepsis.terms.terms import Term, Value

FREE = -1
"""Holder of a particle that flows."""
PARKED = -2
"""Holder of a particle that has left the scene and is only counted."""


def _no_rows() -> IntArray:
    return np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, kw_only=True, slots=True)
class Contacts:
    """Touching pairs of geoms: one row for each pair that carried force within a tick.

    Forces are means over the tick, so ``force * dt`` is the impulse of the tick.
    """

    tick: IntArray
    """Tick of the row, shape (C,), ascending."""
    a: IntArray
    """Index of the first thing, shape (C,): the carrier, i.e. the thing that is a rigid body at that tick."""
    b: IntArray
    """Index of the second thing, shape (C,); ``a < b``."""
    force: FloatArray
    """Force of a on b, world frame [N], shape (C, 3)."""
    normal: FloatArray
    """Unit normal from a to b, world frame, weighted by force, shape (C, 3)."""
    point: FloatArray
    """Point of contact, world frame [m], weighted by force, shape (C, 3)."""
    peak: FloatArray
    """Greatest normal force of the pair within the tick [N], shape (C,)."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Contacts({len(self.tick)} rows)"


@dataclass(frozen=True, kw_only=True, slots=True)
class Joints:
    """What holds two things together, for good or for a while (a weld, a hinge, adhesion): one row an interval."""

    a: IntArray = field(default_factory=_no_rows)
    """Index of the holding thing, shape (B,)."""
    b: IntArray = field(default_factory=_no_rows)
    """Index of the held thing, shape (B,)."""
    start: IntArray = field(default_factory=_no_rows)
    """First tick, shape (B,)."""
    end: IntArray = field(default_factory=_no_rows)
    """First tick no longer, shape (B,)."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Joints({len(self.a)} rows)"


@dataclass(frozen=True, kw_only=True, slots=True)
class Detachments:
    """Bonds of breakable things that gave way, edges between pieces of a shell: accumulated between ticks."""

    tick: IntArray = field(default_factory=_no_rows)
    """Tick within which the bond detached, shape (D,), ascending."""
    thing: IntArray = field(default_factory=_no_rows)
    """Index of the whole that is breaking (``egg1``), shape (D,)."""
    a: IntArray = field(default_factory=_no_rows)
    """Index of the first piece, shape (D,)."""
    b: IntArray = field(default_factory=_no_rows)
    """Index of the second piece, shape (D,)."""
    force: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Greatest contact force on the thing when the bond gave way [N], shape (D,)."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Detachments({len(self.tick)} rows)"

    @classmethod
    def of(cls, happenings: Happenings | None) -> Detachments:
        """Return what the happenings of the type ``detachment`` say."""
        if happenings is None:
            return cls()
        thing, a, b = (happenings.things[name] for name in ("thing", "a", "b"))
        return cls(tick=happenings.tick, thing=thing, a=a, b=b, force=happenings.numbers["force"])

    def happenings(self) -> dict[str, Happenings]:
        """Return them as happenings."""
        things = {"thing": self.thing, "a": self.a, "b": self.b}
        return {DETACHMENT.name: Happenings(tick=self.tick, things=things, numbers={"force": self.force})}


@dataclass(frozen=True, kw_only=True, slots=True)
class Particles:
    """Where the liquids were: P particles, seen in F frames. Particles are never lost: each is in every frame."""

    tick: IntArray = field(default_factory=_no_rows)
    """Tick of each frame, shape (F,), ascending; the first is 0."""
    position: npt.NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0, 3), dtype=np.float32))
    """World frame [m], shape (F, P, 3)."""
    holder: npt.NDArray[np.int16] = field(default_factory=lambda: np.zeros((0, 0), dtype=np.int16))
    """``FREE``; ``PARKED`` once it is far outside the scene; or the index of the thing that it is within and moves
    with: the sponge that has absorbed it, the egg that still encloses it. Shape (F, P)."""
    stuff: IntArray = field(default_factory=_no_rows)
    """Index of the thing (``liq1``) that each particle is of, shape (P,)."""
    mass: FloatArray = field(default_factory=lambda: np.zeros(0))
    """[kg], shape (P,)."""
    volume: FloatArray = field(default_factory=lambda: np.zeros(0))
    """[m^3], shape (P,)."""
    columns: Mapping[str, npt.NDArray[np.float32]] = field(default_factory=dict[str, "npt.NDArray[np.float32]"])
    """What kinds of matter know of them beside, by name, each of shape (F, P)."""
    spacing: float = 0.0
    """Distance of neighbours in the liquid at rest [m]: the cube root of a particle's volume. A particle that lies on a
    wall has its centre half a spacing from it."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Particles({len(self.stuff)} in {len(self.tick)} frames)"


@dataclass(frozen=True, kw_only=True, slots=True)
class Action:
    """One action of the control program, from its start to its end."""

    term: Term
    """The action as the plan says it, its variables bound: ``grasp(hand1, egg1, force7)``."""
    arguments: Mapping[str, Value] = field(default_factory=dict[str, Value])
    """Its arguments by the names that the action gives them (``hand``, ``object``, ``force``), as the plan says them;
    what it leaves out, as it was used. Empty if a log does not tell."""
    start: int
    """First tick."""
    end: int
    """First tick no longer."""
    outcome: Outcome = "done"
    """How it ended, one of ``OUTCOMES``."""
    evidence: Mapping[str, float | str] = field(default_factory=dict[str, "float | str"])
    """Measured numbers: the commanded force [N], the greatest force reached [N] ..."""


# What is in it are arrays, of which no == tells one truth.
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Log:
    """What one run left behind. T ticks, n things; tick i is the instant ``time[i] = i * dt``."""

    dt: float
    """Tick [s]."""
    things: tuple[Thing, ...]
    """Every thing that exists or may come to exist in the run (pieces and blobs included)."""
    time: FloatArray
    """``arange(T) * dt`` [s], shape (T,)."""
    poses: FloatArray
    """World position [m] and unit quaternion (w, x, y, z) of each thing, shape (T, n, 7)."""
    carrier: IntArray
    """Index of the thing whose rigid body carries thing i at a tick, shape (T, n). It is i itself for a
    free or fixed body, the whole's index for a part of an intact thing, the fragment's for a piece of a
    fragment, and -1 where the thing is no body of its own (a broken whole, a stuff in several blobs)."""
    contacts: Contacts
    """Touching pairs with forces."""
    joints: Joints = Joints()
    """Joints between things."""
    happenings: Mapping[str, Happenings] = field(default_factory=dict[str, Happenings])
    """What kinds of matter reported, by type: a ``detachment`` is one."""
    particles: Particles = Particles()
    """The liquids."""
    channels: Mapping[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    """Further monitored series, each of shape (T,), named ``thing.quantity``: ``hand1.opening`` [m],
    ``hand1.gripper`` (1 opening, -1 closing, 0 idle), ``hand1.pad_force`` [N], ``egg1.load`` [1] ..."""
    actions: tuple[Action, ...] = ()
    """What the control program did."""
    gravity: Triple = (0.0, 0.0, -9.81)
    """Gravitational acceleration, world frame [m/s^2]."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Log({self.tick_count} ticks of {self.dt:g} s, {len(self.things)} things)"

    @property
    def detachments(self) -> Detachments:
        """Bonds of breakable things that gave way."""
        return Detachments.of(self.happenings.get(DETACHMENT.name))

    @property
    def tick_count(self) -> int:
        """Number of ticks T."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """End of the last tick [s]: ``T * dt``."""
        return self.tick_count * self.dt

    def index(self, name: str) -> int:
        """Return the index of the thing called ``name``.

        Raises:
            UnknownNameError: If there is none.
        """
        from prolepsis.terms.errors import UnknownNameError

        for i, thing in enumerate(self.things):
            if thing.name == name:
                return i
        raise UnknownNameError.of("object", name, (thing.name for thing in self.things))

    @classmethod
    def from_mujoco(
        cls,
        model: Any,
        states: FloatArray,
        dt: float,
        scene: Mapping[str, Thing] | Sequence[Thing] | None = None,
        *,
        stuffs: Mapping[str, str] | None = None,
    ) -> Log:
        """Return the log of any MuJoCo rollout; see ``docs/grounding.md``.

        Args:
            model: The ``mujoco.MjModel`` that was stepped.
            states: Full integration states (``mjSTATE_INTEGRATION``), one a tick, shape (T, k).
            dt: Time between two states [s].
            scene: Things that say more of those in the model (kind, roles, ...), by name. Without it every
                named top-level body is a thing.
            stuffs: Sets of like bodies each of which is one stuff, as a liquid is: its name, and a pattern of
                theirs, ``{"beads": "bead*"}``.

        Raises:
            InputError: If ``states`` has the wrong shape, or a stuff cannot be one.
            UnknownNameError: If ``scene`` or ``stuffs`` names what the model has not.
            InvalidSimulationError: If a state is not finite or MuJoCo warns of one.
        """
        from prolepsis.engine.rollout import read_rollout

        return read_rollout(model, states, dt, scene, stuffs)

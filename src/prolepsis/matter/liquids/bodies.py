"""The rigid bodies of a running simulation as walls: their solids, where they are, and how they have moved."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.signed_distance import placed
from prolepsis.matter.liquids.holes import Part, stopped, walls_of
from prolepsis.matter.liquids.walls import Bodies, Walls
from prolepsis.matter.liquids.yielding import about, response
from prolepsis.scene.parts import Panel
from prolepsis.scene.running import Running

FREE_FREEDOMS = 6
"""Degrees of freedom of a body that moves freely."""
GREATEST_CHANGE = 20.0
"""Acceleration by others than the liquid with which a body may be taken to go on [m/s^2]."""


class WallBodies:
    """What the particles of a run may touch."""

    def __init__(self, state: Running, spacing: float, lightest: float = 0.0) -> None:
        """Take the bodies as they are now for where the first step begins, for a liquid of a spacing [m].

        Pieces of something broken that weigh less than ``lightest`` [kg] are left out.
        """
        self._spacing = spacing
        self._lightest = lightest
        self._last = np.zeros((0, 6))
        self.walls: Walls
        """The walls of all bodies."""
        self.ids: IntArray
        """Their MuJoCo bodies, shape (B,)."""
        self.take(state)

    def take(self, state: Running) -> None:
        """Look the bodies up in a model that is new."""
        things = state.scene.things
        # A wall that gives way holds liquid by the whole's own shape.
        panels = {panel.name for panel in state.scene.each(Panel)}
        ids: list[int] = []
        carriers: list[int] = []
        first = [0]
        parts: list[list[Part]] = []
        for body, carrier in enumerate([int(thing) for thing in state.body_thing]):
            if carrier < 0 or things[carrier].name in panels or self._is_shard(state, body, int(carrier)):
                continue
            # The own shape of an intact whole stands for its pieces.
            whole = things[carrier].is_body
            among: list[int] = [int(carrier)] if whole else np.flatnonzero(state.carrier == carrier).tolist()
            carried = [i for i in among if things[i].shape.geoms]
            if not carried:
                continue
            ids.append(body)
            carriers.append(carrier)
            parts.append([(things[i].shape, state.offsets[i].copy()) for i in carried])
            first.append(first[-1] + len(placed(parts[-1]).kind))
        self._parts = parts
        self.walls = walls_of(parts, self._spacing)
        self.ids = np.array(ids, dtype=np.int64)
        self._first = np.array(first, dtype=np.int64)
        self._things = np.array(carriers, dtype=np.int64)
        self._position, self._rotation = self._poses(state)
        self._last = np.zeros((0, 6))
        self._weigh(state)

    def stopped(self) -> Walls:
        """Return the walls of all bodies with the holes stopped that are drilled through them."""
        return stopped(self._parts)

    def _weigh(self, state: Running) -> None:
        """Note where the bodies' masses are, and how those that are free and in no hand's grip yield."""
        model, data = state.model, state.data
        self._centre = data.xipos[self.ids].copy()
        self._mobility = np.zeros((len(self.ids), 10))
        self._inertia = np.zeros((len(self.ids), 10))
        held = _held(state)
        for k, body in enumerate(self.ids.tolist()):
            if model.body_dofnum[body] != FREE_FREEDOMS or body in held:
                continue
            rotation = data.ximat[body].reshape(3, 3)
            mass, inertia = model.body_mass[body], model.body_inertia[body]
            self._mobility[k, 0], self._inertia[k, 0] = 1.0 / mass, mass
            self._mobility[k, 1:] = ((rotation / inertia) @ rotation.T).ravel()
            self._inertia[k, 1:] = ((rotation * inertia) @ rotation.T).ravel()

    def _is_shard(self, state: Running, body: int, carrier: int) -> bool:
        return state.scene.things[carrier].emerges and float(state.model.body_mass[body]) < self._lightest

    def _poses(self, state: Running) -> tuple[FloatArray, FloatArray]:
        state.renew_poses()
        position: FloatArray = state.data.xpos[self.ids].copy()
        rotation: FloatArray = state.data.xmat[self.ids].copy()
        return position, rotation

    def moved(
        self, state: Running, dt: float, pushed: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return position, rotation, velocity and spin in the ``dt`` [s] since the last step began, and begin the next.

        The position and rotation are those when it began. A body that yields has the velocity that it would have after
        as long again if the liquid did not push it: what the liquid does acts then.

        Args:
            state: The run.
            dt: [s].
            pushed: What the liquid did to each body meanwhile: impulse [N s] and moment about the world's origin
                [N m s], shape (B, 6).
        """
        position, rotation = self._poses(state)
        old_position, old_rotation = self._position, self._rotation
        self._position, self._rotation = position, rotation
        self._weigh(state)
        velocity = (position - old_position) / dt
        change = np.einsum("bij,bkj->bik", rotation.reshape(-1, 3, 3), old_rotation.reshape(-1, 3, 3))
        # Of the small turn between two steps the skew part is the axis times the sine of the angle.
        skew = np.stack(
            [change[:, 2, 1] - change[:, 1, 2], change[:, 0, 2] - change[:, 2, 0], change[:, 1, 0] - change[:, 0, 1]],
            axis=1,
        )
        going = np.concatenate([velocity, skew / (2 * dt)], axis=1)
        self._carry_on(state, going, dt, pushed)
        return old_position, old_rotation, going[:, :3], going[:, 3:]

    def _carry_on(self, state: Running, going: FloatArray, dt: float, pushed: FloatArray) -> None:
        """Write the velocities with which bodies that yield go on if the liquid does not push them.

        What others do to them, as gravity and contacts, goes on as it was, but for blows.
        """
        yields = np.flatnonzero(self.yields)
        now = np.zeros_like(going)
        for k in yields.tolist():
            first = state.model.body_dofadr[self.ids[k]]
            now[k, :3] = state.data.qvel[first : first + 3]
            now[k, 3:] = self._rotation[k].reshape(3, 3) @ state.data.qvel[first + 3 : first + 6]
        change = np.zeros_like(going)
        if len(self._last) == len(now):
            change = now - self._last - self.answer(pushed)
            size = np.linalg.norm(change[:, :3], axis=1, keepdims=True)
            change *= np.minimum(1.0, GREATEST_CHANGE * dt / np.maximum(size, 1e-12))
        self._last = now
        going[yields] = (now + change)[yields]

    def answer(self, impulse: FloatArray) -> FloatArray:
        """Return by how much impulses and moments about the world's origin change velocity and spin, shape (B, 6)."""
        made = response(self._mobility, about(self._centre, impulse))
        made[:, :3] -= np.cross(made[:, 3:], self._centre - self._position)
        return made

    def at(self, position: FloatArray, rotation: FloatArray, velocity: FloatArray, spin: FloatArray) -> Bodies:
        """Return the bodies at given poses and velocities."""
        return Bodies(
            first=self._first,
            thing=self._things,
            rotation=np.ascontiguousarray(rotation),
            position=np.ascontiguousarray(position),
            velocity=np.ascontiguousarray(velocity),
            spin=np.ascontiguousarray(spin),
            centre=self._centre,
            mobility=self._mobility,
            inertia=self._inertia,
        )

    @property
    def yields(self) -> BoolArray:
        """Whether each body gives way to the liquid, shape (B,)."""
        return self._mobility[:, 0] > 0.0

    def now(self) -> tuple[FloatArray, FloatArray]:
        """Return position and rotation where the last step ended."""
        return self._position, self._rotation

    def travel(self, state: Running) -> float:
        """Return how far the fastest body has gone since the last step [m]."""
        return float(np.linalg.norm(state.data.xpos[self.ids] - self._position, axis=1).max(initial=0.0))


def _held(state: Running) -> set[int]:
    """Return the bodies that touch a jointed one, as an object does the fingers of a hand."""
    jointed = (state.model.body_dofnum > 0) & (state.model.body_dofnum != FREE_FREEDOMS)
    contact = state.data.contact
    active = contact.efc_address >= 0
    pressed = state.data.efc_force[contact.efc_address[active]] > 0.0
    bodies: IntArray = state.model.geom_bodyid[contact.geom[active][pressed]].reshape(-1, 2)
    is_jointed: BoolArray = jointed[bodies]
    held: IntArray = bodies[~is_jointed & is_jointed[:, ::-1]]
    return set(held.tolist())

"""The only mutable thing: model and data of a running simulation, and which body carries which thing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from prolepsis.engine.driving import driving_force
from prolepsis.engine.joining import Joining
from prolepsis.engine.pushing import Pushes
from prolepsis.engine.reporting import check_attribute, check_happening
from prolepsis.engine.softening import Softening
from prolepsis.engine.whereabouts import carrier_of
from prolepsis.engine.world import MOST_FRICTION, World, add_geom, priority_of
from prolepsis.geometry.rotations import compose_pose, inverse, relative_pose, rotated
from prolepsis.geometry.shape import FloatArray, IntArray, Quaternion, Triple, quaternion, triple
from prolepsis.log.happenings import Happening
from prolepsis.scene.particles import ParticleState
from prolepsis.scene.running import ContactForces, PointJoint
from prolepsis.scene.scene import Scene
from prolepsis.system.mujoco import mujoco
from prolepsis.system.seeds import child_of
from prolepsis.terms.errors import InputError, brief_list

FEW_CONTACTS = 16
"""Up to so many contacts, plain lists are faster than arrays."""


@dataclass(kw_only=True)
class State:
    """A running simulation."""

    world: World
    spec: Any
    model: Any
    data: Any
    carrier: IntArray
    """Index of the thing that carries each thing, -1 for none, shape (n,)."""
    offsets: FloatArray
    """Pose of each thing in its carrier's frame, shape (n, 7)."""
    body_thing: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    """Index of the thing that each MuJoCo body is, -1 for none, shape (nbody,)."""
    version: int = 0
    """Counts the rebuilt models."""
    seed: int = 1
    """Of all that is random in the run."""
    tick: int = 0
    """The present one."""
    happenings: list[tuple[int, Happening]] = field(default_factory=list[tuple[int, Happening]])
    """What has been reported, with its tick."""
    splits: int = 0
    """Counts the bodies that have fallen apart."""
    warnings: int = 0
    """MuJoCo's warnings before the model was last rebuilt."""
    attributes: dict[tuple[str, str], float] = field(default_factory=dict[tuple[str, str], float])
    """What controllers have changed: (thing, attribute) to its value."""
    frictions: dict[int, float] = field(default_factory=dict[int, float])
    """Friction of the things that have been given another one, by index [1]."""
    particles: ParticleState | None = None
    """The particles of all liquids, if there are any."""
    joining: Joining = field(default_factory=Joining)
    """What kinds hold together."""
    pushes: Pushes = field(default_factory=Pushes)
    """What kinds push now."""
    softening: Softening = field(default_factory=Softening)
    """Which contacts are soft now."""
    _body_names: list[str] = field(default_factory=list[str])
    _body_of_geom: list[int] = field(default_factory=list[int])
    _bodies_version: int = -1
    _forces: list[tuple[int, int, int, float]] = field(default_factory=list[tuple[int, int, int, float]])
    _forces_at: tuple[int, float] = (-1, 0.0)
    _pairs: list[list[int]] = field(default_factory=list[list[int]])
    _pairs_at: tuple[int, float] = (-1, 0.0)

    @classmethod
    def of(cls, world: World, seed: int = 1) -> State:
        """Return the state at the start of a run."""
        things = world.scene.things
        index = {thing.name: i for i, thing in enumerate(things)}
        spec = world.spec.copy()
        model = spec.compile()
        carrier = np.full(len(things), -1)
        for i in range(len(things)):
            carrier[i] = carrier_of(things, index, i)
        state = cls(
            world=world,
            seed=seed,
            spec=spec,
            model=model,
            data=world.start(model),
            carrier=carrier,
            offsets=np.tile([0.0, 0, 0, 1, 0, 0, 0], (len(things), 1)),
        )
        state.refresh()
        for i, thing in enumerate(things):
            if carrier[i] >= 0 and carrier[i] != i:
                holder = things[int(carrier[i])]
                state.offsets[i] = relative_pose(
                    np.array([*holder.position, *holder.orientation]), np.array([*thing.position, *thing.orientation])
                )
        mujoco.mj_forward(model, state.data)
        return state

    @property
    def scene(self) -> Scene:
        """What the world was made from."""
        return self.world.scene

    def refresh(self) -> None:
        """Bring the map from bodies to things up to date after the model has changed."""
        index = {thing.name: i for i, thing in enumerate(self.scene.things)}
        names = [self.model.body(body).name for body in range(self.model.nbody)]
        self.body_thing = np.array([index.get(name, -1) for name in names])
        self.softening.bind(self.model, self.body_thing, self.scene.things)
        self.pushes.bind(self._body_names, names)
        self._body_names = names

    def report(self, happening: Happening) -> None:
        """Tell the log that something has happened in this tick, which a kind has declared."""
        check_happening(self.scene, happening)
        self.happenings.append((self.tick, happening))

    def attribute(self, name: str, attribute: str) -> float:
        """Return an attribute of a thing: as changed by a controller, as known at the start, or 0."""
        changed = self.attributes.get((name, attribute))
        if changed is not None:
            return changed
        return float(self.scene.thing(name).quantities.get(attribute, 0.0))

    def set_attribute(self, name: str, attribute: str, value: float) -> None:
        """Change an attribute of a thing, which a kind has declared."""
        if (name, attribute) not in self.attributes:
            check_attribute(self.scene, name, attribute)
        self.attributes[name, attribute] = value

    def set_friction(self, index: int, friction: float) -> None:
        """Give a thing's surface another sliding friction [1]."""
        thing = self.scene.things[index]
        if not 0.0 <= friction <= MOST_FRICTION:
            raise InputError(f"{thing.name}: friction {friction:g}; allowed: 0 to {MOST_FRICTION:g}")
        self.frictions[index] = friction
        for k in range(len(thing.shape.geoms)):
            name = f"{thing.name}/{k}"
            kept, now = self.spec.geom(name), self.model.geom(name)
            kept.friction = [friction, *kept.friction[1:]]
            kept.priority = priority_of(friction, self.world.grippiest)
            now.friction[0], now.priority[0] = friction, kept.priority
            for pair in self.spec.pairs:
                if name in (pair.geomname1, pair.geomname2):
                    slippery = min(float(self.spec.geom(each).friction[0]) for each in (pair.geomname1, pair.geomname2))
                    pair.friction = [slippery, slippery, *pair.friction[2:]]
                    self.model.pair(pair.name).friction[:2] = slippery

    def push(self, source: object, bodies: IntArray, wrenches: FloatArray, *, passes_on: bool = False) -> None:
        """Push bodies from now on, in place of what the same source pushed."""
        self.pushes.put(source, self.data, bodies, wrenches, passes_on=passes_on)

    def generator(self, name: str) -> np.random.Generator:
        """Return the source of randomness for what is called ``name``."""
        return child_of(self.seed, name)

    def pose(self, name: str) -> FloatArray:
        """Return where a thing is and how it is turned, shape (7,); one that is no body any more is as at the start."""
        scene = self.scene
        i = scene.index(name)
        carrier = int(self.carrier[i])
        if carrier < 0:
            return np.array([*scene.things[i].position, *scene.things[i].orientation])
        body = self.data.body(scene.things[carrier].name)
        return compose_pose(np.array([*body.xpos, *body.xquat]), self.offsets[i])

    def position(self, name: str) -> Triple:
        """Return where a thing is in the world [m]; one that is no body any more is where it was at the start."""
        return triple(self.pose(name)[:3])

    def orientation(self, name: str) -> Quaternion:
        """Return how a thing is turned in the world, a unit quaternion (w, x, y, z)."""
        return quaternion(self.pose(name)[3:])

    def renew_poses(self, centres: bool = False) -> None:
        """Bring poses, and centres of mass if wanted, up to the present: after a step they are those before it."""
        mujoco.mj_kinematics(self.model, self.data)
        if centres:
            mujoco.mj_comPos(self.model, self.data)

    def renew_forces(self) -> None:
        """Make contacts and forces those of the coming substep."""
        self.softening.forward(self.model, self.data)
        self._forces_at = self._pairs_at = (-1, 0.0)

    def velocity(self, name: str) -> FloatArray:
        """Return the velocity of a thing's carrier [m/s], shape (3,); zeros if it has none."""
        carrier = int(self.carrier[self.scene.index(name)])
        return self._twist(self.scene.things[carrier].name)[3:] if carrier >= 0 else np.zeros(3)

    def velocity_at(self, body: str, point: FloatArray) -> FloatArray:
        """Return the velocity of points of a MuJoCo body in the world [m/s], shape (..., 3)."""
        twist, arm = self._twist(body), np.asarray(point - self.data.body(body).xpos, dtype=np.float64)
        return twist[3:] + np.cross(twist[:3], arm)

    def _twist(self, body: str) -> FloatArray:
        """Return angular [rad/s] and linear velocity [m/s] of a MuJoCo body's frame, world axes, shape (6,)."""
        twist = np.zeros(6)
        number, kind = self.model.body(body).id, mujoco.mjtObj.mjOBJ_XBODY
        mujoco.mj_objectVelocity(self.model, self.data, kind, number, twist, 0)
        return twist

    def normal_forces(self) -> list[tuple[int, int, int, float]]:
        """Return contact number, both bodies and normal force [N] of each active contact of the last substep."""
        data = self.data
        if not data.ncon:
            return []
        # Several ask after each step.
        if self._forces_at != (self.version, data.time):
            self._forces_at = (self.version, data.time)
            self._forces = self._listed_forces()
        return self._forces

    def touching(self) -> list[list[int]]:
        """Return both geoms of each contact of the last substep, active or not."""
        if self._pairs_at != (self.version, self.data.time):
            self._pairs_at = (self.version, self.data.time)
            self._pairs = self.data.contact.geom.tolist()
        return self._pairs

    def driving_force(self, geom: int, contact: int) -> float:
        """Return the force with which what touches a geom at a contact is driven on to it [N]."""
        return driving_force(self.model, self.data, geom, contact)

    def _listed_forces(self) -> list[tuple[int, int, int, float]]:
        data, contact = self.data, self.data.contact
        if data.ncon > FEW_CONTACTS:
            active = np.flatnonzero(contact.efc_address >= 0)
            bodies = self.model.geom_bodyid[contact.geom[active]]
            forces = data.efc_force[contact.efc_address[active]]
            return list(
                zip(active.tolist(), bodies[:, 0].tolist(), bodies[:, 1].tolist(), forces.tolist(), strict=True)
            )
        if self._bodies_version != self.version:
            self._bodies_version = self.version
            self._body_of_geom = self.model.geom_bodyid.tolist()
        body, force = self._body_of_geom, data.efc_force
        return [
            (k, body[a], body[b], float(force[row]))
            for k, ((a, b), row) in enumerate(zip(self.touching(), contact.efc_address.tolist(), strict=True))
            if row >= 0
        ]

    def pressing(self, first: str, second: str) -> float:
        """Return the normal force between two wholes, their parts included, at the last substep [N]."""
        things = self.scene.things

        def whole(body: int) -> str:
            thing = things[int(self.body_thing[body])] if self.body_thing[body] >= 0 else None
            while thing is not None and thing.whole is not None and thing.name not in (first, second):
                thing = self.scene.thing(thing.whole)
            return thing.name if thing is not None else ""

        wanted = {first, second}
        return sum(force for _, a, b, force in self.normal_forces() if {whole(a), whole(b)} == wanted)

    def contact_forces(self) -> ContactForces:
        """Return the active contacts of the last substep."""
        contact = self.data.contact
        active = contact.efc_address >= 0
        rows = contact.efc_address[active]
        geoms = contact.geom[active]
        local = self.data.efc_force[rows[:, None] + np.arange(3)]
        return ContactForces(
            numbers=np.flatnonzero(active),
            geoms=geoms,
            bodies=self.model.geom_bodyid[geoms],
            normal_force=local[:, 0],
            force=np.einsum("cij,ci->cj", contact.frame[active].reshape(-1, 3, 3), local),
            points=contact.pos[active],
        )

    def split(self, body_name: str, fragments: Sequence[Sequence[int]]) -> None:
        """Replace one rigid body by several that move on as its parts did.

        Args:
            body_name: The body that falls apart.
            fragments: The things that each new body consists of; the first gives it its name and frame.

        Raises:
            InputError: If another body hangs on it by a joint, which would be lost.
        """
        things = self.scene.things
        hanging = [body.name for body in self.spec.body(body_name).bodies]
        if hanging:
            raise InputError(f"{body_name} cannot fall apart: {brief_list(hanging)} hangs on it by a joint")
        old = self.data.body(body_name)
        origin, before = old.xpos.copy(), np.array([*old.xpos, *old.xquat])
        velocity = self._twist(body_name)
        old_thing = int(self.body_thing[self.model.body(body_name).id])
        poses = {i: compose_pose(before, self.offsets[i]) for group in fragments for i in group}
        for pair in list(self.spec.pairs):
            if body_name in (pair.geomname1.rsplit("/", 1)[0], pair.geomname2.rsplit("/", 1)[0]):
                self.spec.delete(pair)
        self.spec.delete(self.spec.body(body_name))
        for group in fragments:
            lead, pose = things[group[0]].name, poses[group[0]]
            body = self.spec.worldbody.add_body(name=lead, pos=list(pose[:3]), quat=list(pose[3:]))
            body.add_freejoint(name=lead)
            for i in group:
                self.offsets[i] = relative_pose(pose, poses[i])
                self.carrier[i] = group[0]
                offset = self.offsets[i][:3]
                for k in range(len(things[i].shape.geoms)):
                    add_geom(
                        self.spec,
                        body,
                        things[i],
                        k,
                        self.world.grippiest,
                        mass=things[i].mass / len(things[i].shape.geoms),
                        offset=(float(offset[0]), float(offset[1]), float(offset[2])),
                    )
        if old_thing not in {i for group in fragments for i in group}:
            whole = np.flatnonzero(self.carrier == old_thing)
            self.carrier[whole] = -1
        self.splits += 1
        self._rebuild()
        self.softening.begin(self.data)
        for group in fragments:
            joint = self.data.joint(things[group[0]].name)
            pose = poses[group[0]]
            joint.qpos[:] = pose
            joint.qvel[:3] = velocity[3:] + np.cross(velocity[:3], pose[:3] - origin)
            joint.qvel[3:] = rotated(inverse(quaternion(pose[3:])), triple(velocity[:3]))
        for i in poses:
            if i in self.frictions:
                self.set_friction(i, self.frictions[i])
        self.softening.forward(self.model, self.data)

    def join(self, source: object, joints: Sequence[PointJoint]) -> list[int]:
        """Replace the joints of a source, and return their numbers."""
        self.joining.replace(source, self.spec, joints)
        self._rebuild()
        numbers = self.joint_numbers(source)
        for number, joint in zip(numbers, joints, strict=True):
            self.move_joint(number, joint.point_on_first, joint.point_on_second)
        self.softening.forward(self.model, self.data)
        return numbers

    def joint_numbers(self, source: object) -> list[int]:
        """Return the numbers of the joints of a source."""
        return self.joining.numbers(source, self.model)

    def stick(self, source: object, pairs: Iterable[tuple[int, int]]) -> None:
        """Tell what sticks to what now, as far as a source holds it."""
        self.joining.tell(source, frozenset(pairs), len(self.scene.things))

    @property
    def joints(self) -> frozenset[tuple[int, int]]:
        """What sticks to what now: indices of the holding and the held thing."""
        return self.joining.pairs

    def move_joint(self, number: int, point_on_first: FloatArray, point_on_second: FloatArray) -> None:
        """Let a joint at a point hold other points of its bodies together, each in the frame of its body [m]."""
        # Compiling puts the second point where it would be in the first posture.
        self.model.eq_data[number, :3], self.model.eq_data[number, 3:6] = point_on_first, point_on_second

    def joint_forces(self) -> dict[int, FloatArray]:
        """Return the force of each active joint at a point on its first body, world frame [N], by its number."""
        data = self.data
        rows = int(data.ne)
        numbers, forces = data.efc_id[:rows].tolist(), data.efc_force[:rows].copy()
        # A joint at a point has three rows of its own, one after the other.
        begins = [k for k in range(rows) if not k or numbers[k] != numbers[k - 1]]
        return {numbers[k]: forces[k:end] for k, end in zip(begins, [*begins, rows][1:], strict=True)}

    def _rebuild(self) -> None:
        """Compile the model anew from the spec; the rest of the state is carried over."""
        # Rebuilding starts the count of warnings again.
        self.warnings += int(self.data.warning.number.sum())
        points = self.joining.points(self.model)
        pairs = map(self.model.pair, range(self.model.npair))
        contacts = {each.name: (each.solref.copy(), each.solimp.copy(), each.margin.copy()) for each in pairs}
        self.model, self.data = self.spec.recompile(self.model, self.data)
        # Compiling puts the second point where it would be in the first posture, which may be centimetres off.
        for known in self.spec.equalities:
            if known.name in points:
                self.model.equality(known.name).data[:] = points[known.name]
        # The spec does not know what controllers have made of contacts.
        for known in self.spec.pairs:
            if known.name in contacts:
                now = self.model.pair(known.name)
                now.solref[:], now.solimp[:], now.margin[:] = contacts[known.name]
        self.version += 1
        self.refresh()

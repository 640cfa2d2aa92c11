"""A world: the scene as a MuJoCo model, with the contact rules that every body obeys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from prolepsis.engine.robot_world import add_robot, posture, rule_contacts
from prolepsis.geometry.shape import Triple
from prolepsis.geometry.solids import matter_of
from prolepsis.log.things import Thing, friction_of
from prolepsis.matter.walls.yielding_bowl import PANEL, add_panels
from prolepsis.robots.hand import HAND
from prolepsis.scene.running import MAX_STEP
from prolepsis.scene.scene import HIDDEN_ROLES, Scene, robot_of_gripper
from prolepsis.system.mujoco import mujoco
from prolepsis.system.threads import one_thread
from prolepsis.terms.errors import KnowledgeError

SMOOTH_SOLREF = (0.005, 1.0)
SMOOTH_SOLIMP = (0.0, 0.95, 0.001, 0.5, 2.0)
"""Contact of things whose stiffness does not matter: a smooth onset, or a sliding box hops; it gives by 0.3 mm."""
SMALL_SOLREF = (0.004, 1.0)
"""Contact of pieces and blobs, which weigh grams and would be passed through at the softer value."""
SMALL_SOLIMP = (0.9, 0.95, 0.001, 0.5, 2.0)
IMPEDANCE_RATIO, DEBRIS_IMPEDANCE_RATIO = 100.0, 10.0
"""Friction over normal impedance [1]. Static friction is regularized: at 1 a held egg creeps by 2 mm/s, at 100 by less
than 0.02. Once something has fallen to pieces the solver's time matters more, and shards in a grip may creep by 0.2."""
ROLLING_FRICTION = 2.0e-4
"""Resistance of a smooth shell to rolling, as a length [m]; a tenth of a millimetre is usual for hard round things."""
SPINNING_FRICTION = 1.0e-3
"""Resistance to spinning on the spot, as a length [m]."""
NEAR = 0.01
"""Contacts of breakable things are detected at this distance [m], so that the substep shrinks before the impact."""
MOST_MOVING, MOST_SOLIDS = 2000, 20_000
"""Things that move and solids of a scene: MuJoCo sets aside 1.6 kB for each pair of things, 6 GB for so many."""


@dataclass(frozen=True, kw_only=True, slots=True)
class World:
    """A compiled scene. ``spec`` is copied for each run, since breaking edits it."""

    scene: Scene
    """What it was made from."""
    spec: Any
    """The ``mujoco.MjSpec`` at the start."""
    model: Any
    """The ``mujoco.MjModel`` at the start."""
    ranks: Mapping[float, int]
    """MuJoCo priority of each friction."""
    posture: Mapping[str, float]
    """Coordinate at the start of each joint that is not at 0 there, by name [rad or m]."""

    def start(self, model: Any) -> Any:
        """Return ``mujoco.MjData`` of a freshly compiled model of this world, all robots at home."""
        data = mujoco.MjData(model)
        for name, value in self.posture.items():
            data.joint(name).qpos[0] = value
        return data

    def is_body(self, thing: Thing) -> bool:
        """Return whether a thing is a rigid body of its own at the start."""
        if thing.name.split("/", 1)[0] in self.scene.robots and thing.whole is not None:
            return True
        return bool(thing.shape.geoms) and not thing.roles & HIDDEN_ROLES

    def xml(self) -> str:
        """Return the world file (MJCF)."""
        return self.spec.to_xml()


@one_thread()
def compile_world(scene: Scene) -> World:
    """Return the world of a scene.

    Raises:
        KnowledgeError: If there are too many things, two overlap at the start, or one is too small or light to be
            simulated.
    """
    _refuse_many(scene)
    spec = mujoco.MjSpec()
    spec.modelname = "prolepsis"
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    option = spec.option
    option.timestep = MAX_STEP
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = IMPEDANCE_RATIO
    option.gravity = list(scene.gravity)
    # MuJoCo would silently start again after a divergence; the run must end as invalid instead.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    spec.worldbody.add_light(pos=[0, 0, 3], castshadow=True)
    ranks = _friction_ranks(scene)
    start: dict[str, float] = {}
    arms = [arm.name for robot in scene.robots.values() for arm in robot.arms]
    for name, robot in scene.robots.items():
        add_robot(spec, robot, scene.thing(name), arms)
        rule_contacts(spec, scene, name, lambda geom, thing: _rule_contact(geom, thing, ranks, rolls=False))
        start |= posture(robot, name, scene)
    for thing in scene.things:
        on_robot = thing.name.split("/", 1)[0] in scene.robots
        if thing.shape.geoms and not (thing.roles & (HIDDEN_ROLES | {PANEL})) and not on_robot:
            add_body(spec, thing, ranks)
    for thing in scene.things:
        if parts := tuple(part for part in scene.parts(thing.name) if PANEL in part.roles):
            add_panels(spec, thing, parts, partial(add_geom, spec, ranks=ranks), MAX_STEP)
    for thing in scene.things:
        if "Gripper" in thing.roles and robot_of_gripper(scene, thing) is None:
            HAND.add_joints(spec, thing.name, thing.orientation)
    for thing in scene.things:
        if "Breakable" in thing.roles:
            _add_pairs(spec, scene, thing)
    try:
        model = spec.compile()
    except ValueError as error:
        raise KnowledgeError(f"the world cannot be built: {' '.join(str(error).split())}") from None
    world = World(scene=scene, spec=spec, model=model, ranks=ranks, posture=start)
    _refuse_overlaps(scene, model, world.start(model))
    return world


def _refuse_many(scene: Scene) -> None:
    """Refuse a scene that is too large, before anything is built."""
    moving = sum(bool(thing.shape.geoms) and not thing.fixed for thing in scene.things)
    solids = sum(len(thing.shape.geoms) for thing in scene.things)
    for what, count, most in (("things that move", moving, MOST_MOVING), ("convex solids", solids, MOST_SOLIDS)):
        if count > most:
            raise KnowledgeError(
                f"the scene has {count} {what}; allowed: {most}, since what MuJoCo needs grows with the square"
            )


def _friction_ranks(scene: Scene) -> dict[float, int]:
    """Return a MuJoCo priority for each friction: a contact is as slippery as its more slippery surface."""
    surfaces = [thing for thing in scene.things if thing.shape.geoms]
    values = {friction_of(thing) for thing in surfaces}
    values |= {thing.quantities["frictionWhenWet"] for thing in surfaces if "frictionWhenWet" in thing.quantities}
    values = sorted(values, reverse=True)
    return {value: rank for rank, value in enumerate(values)}


def add_body(spec: Any, thing: Thing, ranks: Mapping[float, int], *, name: str | None = None) -> Any:
    """Add one thing to the spec as a body with its geoms, and return the body."""
    parent = spec.worldbody
    position, orientation = thing.position, thing.orientation
    part = HAND.part_of(thing)
    if part.endswith("_finger"):
        parent = spec.body(f"{thing.whole}/palm")
        palm_position, palm_orientation = np.asarray(parent.pos), np.asarray(parent.quat)
        inverse = np.zeros(4)
        mujoco.mju_negQuat(inverse, palm_orientation)
        local = np.zeros(3)
        mujoco.mju_rotVecQuat(local, np.asarray(thing.position) - palm_position, inverse)
        position, orientation = (float(local[0]), float(local[1]), float(local[2])), (1.0, 0.0, 0.0, 0.0)
    body = parent.add_body(name=name or thing.name, pos=list(position), quat=list(orientation))
    if not thing.fixed and not part:
        body.add_freejoint(name=name or thing.name)
    for k, mass in enumerate(_masses(thing)):
        add_geom(spec, body, thing, k, ranks, mass=mass)
    return body


def _masses(thing: Thing) -> list[float]:
    """Return the mass of each solid of a thing [kg]: of one material, so by volume."""
    geoms = thing.shape.geoms
    if len(geoms) < 2 or thing.fixed or thing.whole is not None:
        return [thing.mass / max(len(geoms), 1)] * len(geoms)
    volumes = [matter_of(geom) for geom in geoms]
    return [thing.mass * volume / sum(volumes) for volume in volumes]


def add_geom(
    spec: Any,
    body: Any,
    thing: Thing,
    number: int,
    ranks: Mapping[float, int],
    *,
    mass: float,
    offset: Triple = (0.0, 0.0, 0.0),
) -> Any:
    """Add one geom of a thing to a body and return it; ``offset`` is the thing's place in the body [m]."""
    geom = thing.shape.geoms[number]
    made = body.add_geom(name=f"{thing.name}/{number}", type=getattr(mujoco.mjtGeom, f"mjGEOM_{geom.type.upper()}"))
    if geom.type == "mesh":
        mesh_name = f"{thing.name}/{number}"
        if spec.mesh(mesh_name) is None:
            mesh = spec.add_mesh(name=mesh_name)
            mesh.uservert = np.asarray(geom.vertices).ravel()
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
        made.meshname = mesh_name
    else:
        made.size = list(geom.size)
    made.pos = [a + b for a, b in zip(geom.position, offset, strict=True)]
    made.quat = list(geom.orientation)
    if not thing.fixed:
        made.mass = mass
    rolls = "Breakable" in thing.roles or geom.type in ("sphere", "ellipsoid", "capsule", "cylinder")
    _rule_contact(made, thing, ranks, rolls=rolls)
    made.rgba = list(thing.shape.colour)
    return made


def _rule_contact(made: Any, thing: Thing, ranks: Mapping[float, int], *, rolls: bool) -> None:
    """Give a geom of a thing its friction and softness."""
    small = bool(thing.roles & HIDDEN_ROLES)
    friction = friction_of(thing)
    rolling = thing.quantities.get("rollingFriction", ROLLING_FRICTION)
    made.friction = [friction, SPINNING_FRICTION, rolling]
    made.condim = 6 if rolls else 3 if small else 4
    made.priority = ranks.get(friction, 0)
    made.solref = list(SMALL_SOLREF if small else SMOOTH_SOLREF)
    made.solimp = list(SMALL_SOLIMP if small else SMOOTH_SOLIMP)


def _add_pairs(spec: Any, scene: Scene, thing: Thing) -> None:
    """Give a breakable thing an explicit contact pair with everything else; breaking sets its stiffness."""
    for other in scene.things:
        if other is thing or not other.shape.geoms or other.roles & HIDDEN_ROLES:
            continue
        if "Breakable" in other.roles and other.name < thing.name:
            continue
        friction = min(friction_of(thing), friction_of(other))
        for i in range(len(thing.shape.geoms)):
            # Where a wall has panels, they are what is touched.
            for j in range(1 if "panelCount" in other.quantities else len(other.shape.geoms)):
                pair = spec.add_pair(
                    name=f"{thing.name}/{i}:{other.name}/{j}",
                    geomname1=f"{thing.name}/{i}",
                    geomname2=f"{other.name}/{j}",
                )
                pair.condim = 6
                pair.friction = [friction, friction, SPINNING_FRICTION, ROLLING_FRICTION, ROLLING_FRICTION]
                pair.gap = NEAR
                pair.solref = list(SMALL_SOLREF)


def _refuse_overlaps(scene: Scene, model: Any, data: Any) -> None:
    """Refuse things that are inside each other at the start."""
    mujoco.mj_forward(model, data)
    whole = {thing.name: thing.whole for thing in scene.things}
    fixed = {thing.name for thing in scene.things if thing.fixed}

    def top(name: str) -> str:
        while whole.get(name):
            name = str(whole[name])
        return name

    for contact in data.contact:
        names = [model.body(model.geom_bodyid[g]).name for g in contact.geom]
        a, b = top(names[0]), top(names[1])
        if a == b or (names[0] in fixed and names[1] in fixed):
            continue
        if contact.dist < -OVERLAP:
            raise KnowledgeError(
                f"{a} and {b} overlap by {-contact.dist * 1000:.1f} mm at the start; "
                f"move one of them apart (allowed: {OVERLAP * 1000:g} mm)"
            )


OVERLAP = 5.0e-4
"""Depth up to which things may interpenetrate at the start [m]: rounding of measured poses, no more."""

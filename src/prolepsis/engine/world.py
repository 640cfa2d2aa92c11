"""A world: the scene as a MuJoCo model, with the contact rules that every body obeys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from prolepsis.engine.softening import HARD_SOLIMP, MARGIN, SOLREF, STIFF
from prolepsis.geometry.rotations import inverse, product, rotated
from prolepsis.geometry.shape import IDENTITY, Quaternion, Triple, triple
from prolepsis.geometry.solids import matter_of
from prolepsis.log.things import Thing, falling_apart, friction_of
from prolepsis.scene.extent import extent_along
from prolepsis.scene.running import MAX_STEP
from prolepsis.scene.scene import Scene
from prolepsis.system.mujoco import mujoco
from prolepsis.system.threads import one_thread
from prolepsis.terms.errors import KnowledgeError

TOLERANCE = 1.0e-12
"""Of the solver, relative [1]. At MuJoCo's own, 1e-8, hard contacts of light things flicker: a stack shakes itself
down within a second, and each step takes longer. Where something may break it stays: how it is crushed hangs on
micrometres, and it has been measured so."""
SMALL_SOLIMP = (0.9, 0.95, 0.001, 0.5, 2.0)
"""Contact of pieces and blobs, which weigh grams."""
ROLLING_FRICTION = 2.0e-4
"""Resistance of a smooth thing to rolling, as a length [m]; a tenth of a millimetre is usual for hard round things."""
ROUND = ("sphere", "ellipsoid", "capsule", "cylinder")
"""Solids that roll."""
MOST_FRICTION = 10.0
"""Greatest friction of a surface [1], as in the ontology."""
SAME_FRICTION = 1.0e-6
"""Frictions that differ by less than this count as the same [1]."""
SPINNING_FRICTION = 1.0e-3
"""Resistance to spinning on the spot, as a length [m]."""
MOST_MOVING, MOST_SOLIDS = 2000, 20_000
"""Things that move and solids of a scene: MuJoCo sets aside 1.6 kB for each pair of things, 6 GB for so many."""

LEAST_INERTIA = 1.0e-14
"""Least moment of inertia of an ellipsoid with the mass and extents of a thing [kg m2]: MuJoCo builds none of less than
1e-15, and a wedge has a third of an ellipsoid's."""


@dataclass(frozen=True, kw_only=True, slots=True)
class World:
    """A compiled scene. ``spec`` is copied for each run, since breaking edits it."""

    scene: Scene
    """What it was made from."""
    spec: Any
    """The ``mujoco.MjSpec`` at the start."""
    model: Any
    """The ``mujoco.MjModel`` at the start."""
    grippiest: float
    """Greatest friction of a surface at the start [1]."""
    posture: Mapping[str, float]
    """Coordinate at the start of each joint that is not at 0 there, by name [rad or m]."""

    def start(self, model: Any) -> Any:
        """Return ``mujoco.MjData`` of a freshly compiled model of this world, all robots at home."""
        data = mujoco.MjData(model)
        for name, value in self.posture.items():
            data.joint(name).qpos[0] = value
        return data


@one_thread()
def compile_world(scene: Scene) -> World:
    """Return the world of a scene.

    Raises:
        KnowledgeError: If there are too many things, two overlap at the start, or one is too small or light to be
            simulated.
    """
    _refuse_many(scene)
    _refuse_slight(scene)
    spec = mujoco.MjSpec()
    spec.modelname = "prolepsis"
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    option = spec.option
    option.timestep = MAX_STEP
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = STIFF
    if not falling_apart(scene.things):
        option.tolerance = TOLERANCE
    option.gravity = list(scene.gravity)
    # MuJoCo would silently start again after a divergence; the run must end as invalid instead.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    spec.worldbody.add_light(pos=[0, 0, 3], castshadow=True)
    making = _Making(spec=spec, scene=scene, grippiest=_grippiest(scene))
    start: dict[str, float] = {}
    for kind in scene.kinds:
        start |= kind.attach(making)
    for thing in scene.things:
        if thing.is_body and spec.body(thing.name) is None:
            making.add_body(thing)
    for kind in scene.kinds:
        kind.edit(making)
    try:
        model = spec.compile()
    except ValueError as error:
        what, _, element = " ".join(str(error).split()).removeprefix("Error: ").partition(" Element name ")
        name = element.partition(",")[0].strip("'").partition("/")[0]
        of = f" of {name}" if name else ""
        raise KnowledgeError(f"the world cannot be built: MuJoCo says{of}: {what}") from None
    world = World(scene=scene, spec=spec, model=model, grippiest=making.grippiest, posture=start)
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


def _refuse_slight(scene: Scene) -> None:
    """Refuse things that are so small or light that MuJoCo builds no body of them."""
    for thing in scene.things:
        if thing.fixed or not thing.shape.geoms:
            continue
        extents = sorted(extent_along(replace(thing, orientation=IDENTITY), axis) for axis in np.eye(3))
        if 0.0 < (inertia := thing.mass * (extents[0] ** 2 + extents[1] ** 2) / 20) < LEAST_INERTIA:
            raise KnowledgeError(
                f"{thing.whole or thing.name} is too small or light: {thing.name} of {thing.mass:.3g} kg and "
                f"{' x '.join(f'{1000 * each:.3g}' for each in extents)} mm has a moment of inertia of {inertia:.2g} "
                f"kg m2; allowed: at least {LEAST_INERTIA:g}, a tenth of that of a cube of water of 1 mm"
            )


def _grippiest(scene: Scene) -> float:
    """Return the greatest friction of a surface [1]."""
    return max((friction_of(thing) for thing in scene.things if thing.shape.geoms), default=0.0)


def priority_of(friction: float, grippiest: float) -> int:
    """Return the MuJoCo priority of a surface: a contact is as slippery as its more slippery surface."""
    return round((grippiest - friction) / SAME_FRICTION)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Making:
    """A world while it is built."""

    spec: Any
    scene: Scene
    grippiest: float
    """Greatest friction of a surface at the start [1]."""

    def add_body(self, thing: Thing) -> None:
        """Add one thing as a body with its geoms, on what it is mounted on."""
        parent, position, orientation = self.spec.worldbody, thing.position, thing.orientation
        if thing.mount.by == "joints" and thing.mount.to is not None:
            parent = self.spec.body(thing.mount.to)
            position, orientation = seen_from(self.scene.thing(thing.mount.to), thing)
        body = parent.add_body(name=thing.name, pos=list(position), quat=list(orientation))
        if thing.mount.by == "nothing":
            body.add_freejoint(name=thing.name)
        for k, mass in enumerate(_masses(thing)):
            add_geom(self.spec, body, thing, k, self.grippiest, mass=mass)

    def rule_contact(self, geom: Any, thing: Thing, *, rolls: bool) -> None:
        """Give a geom of a thing its friction and softness, and resistance to rolling where it rolls."""
        _rule_contact(geom, thing, self.grippiest, rolls=rolls)

    def add_hinge(
        self, thing: str, position: Triple, axis: Triple, stiffness: float, damping: float, armature: float
    ) -> None:
        """Give the body of a thing a hinge of its name, in its own frame, with a spring [N m/rad, N m s/rad, kg m2]."""
        self.spec.body(thing).add_joint(
            name=thing,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            pos=list(position),
            axis=list(axis),
            stiffness=[stiffness, 0, 0],
            damping=[damping, 0, 0],
            armature=armature,
        )

    def add_pair(self, first: str, second: str, friction: float, gap: float) -> None:
        """Give two geoms a contact of their own, which is found from a distance of ``gap`` on [m]."""
        pair = self.spec.add_pair(name=f"{first}:{second}", geomname1=first, geomname2=second)
        pair.condim = 6
        pair.friction = [friction, friction, SPINNING_FRICTION, ROLLING_FRICTION, ROLLING_FRICTION]
        pair.gap = gap
        pair.solref = list(SOLREF)


def seen_from(holder: Thing, thing: Thing) -> tuple[Triple, Quaternion]:
    """Return the pose of a thing in the frame of what it hangs on."""
    back = inverse(holder.orientation)
    away = np.asarray(thing.position) - np.asarray(holder.position)
    same = thing.orientation == holder.orientation
    return triple(rotated(back, triple(away))), IDENTITY if same else product(back, thing.orientation)


def _masses(thing: Thing) -> list[float]:
    """Return the mass of each solid of a thing [kg]: of one material, so by volume."""
    geoms = thing.shape.geoms
    if len(geoms) < 2 or thing.fixed or (thing.whole is not None and "Blob" not in thing.roles):
        return [thing.mass / max(len(geoms), 1)] * len(geoms)
    volumes = [matter_of(geom) for geom in geoms]
    return [thing.mass * volume / sum(volumes) for volume in volumes]


def add_geom(
    spec: Any,
    body: Any,
    thing: Thing,
    number: int,
    grippiest: float,
    *,
    mass: float,
    offset: Triple = (0.0, 0.0, 0.0),
) -> Any:
    """Add one geom of a thing to a body and return it; ``offset`` is the thing's position in the body [m]."""
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
    rolls = geom.type in ROUND
    _rule_contact(made, thing, grippiest, rolls=rolls)
    made.rgba = list(thing.shape.colour)
    return made


def _rule_contact(made: Any, thing: Thing, grippiest: float, *, rolls: bool) -> None:
    """Give a geom of a thing its friction and softness."""
    small = thing.emerges
    friction = friction_of(thing)
    rolling = thing.quantities.get("rollingFriction", ROLLING_FRICTION)
    made.friction = [friction, SPINNING_FRICTION, rolling]
    made.condim = 6 if rolls else 3 if small else 4
    made.priority = priority_of(friction, grippiest)
    made.solref = list(SOLREF)
    made.solimp = list(SMALL_SOLIMP if small else HARD_SOLIMP)
    made.margin = 0.0 if small else MARGIN


def _refuse_overlaps(scene: Scene, model: Any, data: Any) -> None:
    """Refuse things that are inside each other at the start."""
    mujoco.mj_forward(model, data)
    # A body of a stuff is apart from the others.
    whole = {thing.name: None if "Blob" in thing.roles else thing.whole for thing in scene.things}
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

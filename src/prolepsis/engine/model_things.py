"""The things of a plain MuJoCo model: every top-level body, its nested bodies as parts, and fixed world geoms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from prolepsis.engine.granular_things import with_stuffs
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import IntArray, Triple, quaternion, triple
from prolepsis.log.things import FIXED, FREE, Mount, Thing, jointed
from prolepsis.robots.model_shapes import shape_of_geoms
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError, UnknownNameError, brief

# Numpy's integers do not equal MuJoCo's enumerators, so plain integers are compared.
_PLANE = int(mujoco.mjtGeom.mjGEOM_PLANE)
_FREE = int(mujoco.mjtJoint.mjJNT_FREE)
_JOINT_DRIVES = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
_SITE_DRIVES = (int(mujoco.mjtTrn.mjTRN_SITE), int(mujoco.mjtTrn.mjTRN_SLIDERCRANK))
_TENDON_DRIVE = int(mujoco.mjtTrn.mjTRN_TENDON)
_JOINT_WRAP, _SITE_WRAP = int(mujoco.mjtWrap.mjWRAP_JOINT), int(mujoco.mjtWrap.mjWRAP_SITE)
SceneThings = Mapping[str, Thing] | Sequence[Thing]


@dataclass(frozen=True, kw_only=True, slots=True)
class ModelThings:
    """The things of a model, and where each body and geom of the model went."""

    things: tuple[Thing, ...]
    """World geoms first, then bodies in the model's order, then stuffs that consist of some of these."""
    body: IntArray
    """Model body of each thing, 0 for world geoms and stuffs, shape (n,)."""
    carrier: IntArray
    """Index of the thing whose rigid body carries each thing, -1 for a stuff, shape (n,)."""
    of_geom: IntArray
    """Index of the carrying thing of each geom of the model, or -1 if it is of none, shape (ngeom,)."""
    of_body: IntArray
    """Index of the carrying thing of each body of the model, -1 for the world, shape (nbody,)."""


def model_things(
    model: Any, data: Any, scene: SceneThings | None = None, stuffs: Mapping[str, str] | None = None
) -> ModelThings:
    """Return the things of a model in the state that ``data`` holds.

    A nested body without a joint belongs to the rigid body of its parent, which is then its carrier. Roles
    are ``Floor`` (planes), ``Mounted`` (joined to the world other than freely) and ``Driven`` (moved by
    actuators or as a mocap body).

    Args:
        model: The ``mujoco.MjModel``.
        data: Its ``mujoco.MjData``, after ``mj_kinematics``.
        scene: Things that take the place of those found here, by name: their kind, roles, whole, quantities,
            colour, and their shape and mass if they have any.
        stuffs: For each set of like bodies that is one stuff its name, and the pattern of theirs.

    Raises:
        UnknownNameError: If ``scene`` or ``stuffs`` names what the model has not.
        InputError: If two things would have the same name, or a stuff cannot be one.
    """
    world_geoms = _world_geoms(model)
    bodies = list(range(1, model.nbody))
    names = _body_names(model)
    things = [_world_thing(model, name, geoms) for name, geoms in world_geoms.items()]
    driven = _driven_roots(model)
    things += [_body_thing(model, data, body, names, driven) for body in bodies]
    index = {thing.name: i for i, thing in enumerate(things)}
    if len(index) < len(things):
        double = sorted({thing.name for thing in things if [t.name for t in things].count(thing.name) > 1})
        raise InputError(f"model: several things are called {', '.join(double)}; names must differ")
    of_body = np.full(model.nbody, -1, dtype=np.int64)
    for body in bodies:
        of_body[body] = index[names[_rigid_root(model, body)]]
    of_geom = of_body[model.geom_bodyid]
    for name, geoms in world_geoms.items():
        of_geom[geoms] = index[name]
    carrier = np.array([*range(len(world_geoms)), *(of_body[body] for body in bodies)], dtype=np.int64)
    body_of = np.array([0] * len(world_geoms) + bodies, dtype=np.int64)
    found = with_stuffs(tuple(things), stuffs or {})
    more = len(found) - len(things)
    return ModelThings(
        things=_overridden(found, scene),
        body=np.append(body_of, np.zeros(more, dtype=np.int64)),
        carrier=np.append(carrier, np.full(more, -1)),
        of_geom=of_geom,
        of_body=of_body,
    )


def _overridden(things: tuple[Thing, ...], scene: SceneThings | None) -> tuple[Thing, ...]:
    if scene is None:
        return things
    given = dict(scene) if isinstance(scene, Mapping) else {getattr(thing, "name", ""): thing for thing in scene}
    for name, thing in given.items():
        if not isinstance(thing, Thing):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"scene: {brief(name)} is given {brief(repr(thing))}; needed: a Thing, as "
                "Thing(name='hand', kind='Gripper', roles=frozenset({'Gripper'}))"
            )
    known = {thing.name for thing in things}
    for name in given:
        if name not in known:
            raise UnknownNameError.of("thing", name, known, where="scene")
    return tuple(_override(thing, given[thing.name]) if thing.name in given else thing for thing in things)


def _override(found: Thing, given: Thing) -> Thing:
    # Where a thing is, and whether it can move, is the model's to say.
    return replace(
        found,
        kind=given.kind,
        roles=found.roles | given.roles,
        shape=given.shape if given.shape.geoms else found.shape,
        mass=given.mass or found.mass,
        whole=given.whole or found.whole,
        quantities=given.quantities,
    )


def _world_geoms(model: Any) -> dict[str, list[int]]:
    groups: dict[str, list[int]] = {}
    for geom in range(model.ngeom):
        if model.geom_bodyid[geom] == 0 and _collides(model, geom):
            plane = int(model.geom_type[geom]) == _PLANE
            name = model.geom(geom).name or ("floor" if plane else "world")
            groups.setdefault(name, []).append(geom)
    return groups


def _collides(model: Any, geom: int) -> bool:
    return bool(model.geom_contype[geom] or model.geom_conaffinity[geom])


def _body_names(model: Any) -> list[str]:
    names = ["world"]
    for body in range(1, model.nbody):
        own = model.body(body).name or f"body{body}"
        root = int(model.body_rootid[body])
        names.append(own if root == body else f"{names[root]}/{own}")
    return names


def _is_mocap(model: Any, body: int) -> bool:
    return bool(model.body_mocapid[body] >= 0)


def _rigid_root(model: Any, body: int) -> int:
    """Return the body that ``body`` is rigidly fixed to, at most its top-level body."""
    while model.body_jntnum[body] == 0 and model.body_rootid[body] != body:
        body = int(model.body_parentid[body])
    return body


def _driven_roots(model: Any) -> set[int]:
    roots = {int(model.body_rootid[b]) for b in range(1, model.nbody) if _is_mocap(model, b)}
    for actuator in range(model.nu):
        kind = int(model.actuator_trntype[actuator])
        target = int(model.actuator_trnid[actuator, 0])
        if kind in _JOINT_DRIVES:
            roots.add(int(model.body_rootid[model.jnt_bodyid[target]]))
        elif kind in _SITE_DRIVES:
            roots.add(int(model.body_rootid[model.site_bodyid[target]]))
        elif kind == _TENDON_DRIVE:
            roots |= _tendon_roots(model, target)
    return roots - {0}


def _tendon_roots(model: Any, tendon: int) -> set[int]:
    roots: set[int] = set()
    first = int(model.tendon_adr[tendon])
    for wrap in range(first, first + int(model.tendon_num[tendon])):
        target = int(model.wrap_objid[wrap])
        if int(model.wrap_type[wrap]) == _JOINT_WRAP:
            roots.add(int(model.body_rootid[model.jnt_bodyid[target]]))
        elif int(model.wrap_type[wrap]) == _SITE_WRAP:
            roots.add(int(model.body_rootid[model.site_bodyid[target]]))
    return roots


def _world_thing(model: Any, name: str, geoms: list[int]) -> Thing:
    planes = all(int(model.geom_type[geom]) == _PLANE for geom in geoms)
    shape = shape_of_geoms(model, geoms)
    roles = frozenset({"Floor"}) if planes else frozenset[str]()
    return Thing(name=name, kind="Floor" if planes else "Thing", shape=shape, roles=roles, mount=FIXED)


def _body_thing(model: Any, data: Any, body: int, names: list[str], driven: set[int]) -> Thing:
    root = int(model.body_rootid[body])
    rigid = _rigid_root(model, body)
    fixed = model.body_jntnum[rigid] == 0 and not _is_mocap(model, root)
    joint = int(model.body_jntadr[root])
    free = joint >= 0 and int(model.jnt_type[joint]) == _FREE
    roles: set[str] = set()
    if root in driven:
        roles.add("Driven")
    if not fixed and not free:
        roles.add("Mounted")
    geoms = [g for g in range(model.ngeom) if model.geom_bodyid[g] == body]
    return Thing(
        name=names[body],
        kind="Thing",
        shape=shape_of_geoms(model, [g for g in geoms if _collides(model, g)] or geoms),
        position=triple(data.xpos[body]),
        orientation=quaternion(data.xquat[body]),
        mass=float(model.body_subtreemass[body]),
        centre=_centre(model, data, body) if rigid == body and not fixed else None,
        whole=None if root == body else names[int(model.body_parentid[body])],
        roles=frozenset(roles),
        mount=_mount(model, root, body, names, bool(fixed)),
    )


def _centre(model: Any, data: Any, root: int) -> Triple:
    """Return the centre of mass of a body and of all that is rigidly fixed to it, in its frame [m]."""
    bodies = [body for body in range(root, model.nbody) if _rigid_root(model, body) == root]
    weights = np.maximum(model.body_mass[bodies], 1e-12)
    middle = weights @ data.xipos[bodies] / weights.sum()
    return triple(rotate_back(data.xquat[root], middle - data.xpos[root]))


def _mount(model: Any, root: int, body: int, names: list[str], fixed: bool) -> Mount:
    if fixed:
        return FIXED
    if root != body:
        return jointed(names[int(model.body_parentid[body])])
    joint = int(model.body_jntadr[root])
    return FREE if joint >= 0 and int(model.jnt_type[joint]) == _FREE else jointed()

"""From the user's own robot to a robot that can be driven: what its scenario leaves out is computed from its model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.robots.effectors.kind import EffectorKind, read_effector
from prolepsis.robots.model_file import ModelFile, read_model_file
from prolepsis.robots.parts import follow_couplings
from prolepsis.scenario.own_robot import OwnGripper, OwnRobot
from prolepsis.scene.robot import Arm, Effector, Joint, Robot
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError, UnknownNameError

FREQUENCY = 10.0
"""Natural frequency of a servo that carries the payload [Hz], critically damped: slower than the contact of what is
held, faster than what a hand does ..."""
FASTEST = 50.0
"""... or up to this [Hz], which 1 ms steps can follow, ..."""
YIELDING = 0.1
"""... so that a servo uses all its effort when it is this far off [rad or m]."""
PAYLOAD = 1.0
"""Mass that an arm is taken to hold [kg]: most of what stands on a kitchen table is lighter."""
HINGE_SPEED, SLIDE_SPEED = 2.0, 0.25
"""Greatest speeds where nothing tells them: those of a slow arm [rad/s, m/s]."""
HINGE_ACCELERATION, SLIDE_ACCELERATION = 10.0, 2.0
"""Greatest accelerations [rad/s^2, m/s^2] ..."""
ACCELERATING = 0.5
"""... unless they take more than this share of the effort: the rest holds and pushes."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Reading:
    """A robot while it is read."""

    path: Path
    file: ModelFile
    model: Any
    """The ``mujoco.MjModel``, its effectors made to open when their joints grow."""
    data: Any
    """At home."""
    inertias: FloatArray
    """Of each joint at home, with the payload [kg m^2 or kg], shape (n,)."""


def load_robot(own: OwnRobot, folder: Path, table: str = "robot") -> Robot:
    """Return the robot that a scenario's table describes.

    Args:
        own: The table.
        folder: Where its relative path starts.
        table: Where the table is, for messages.

    Raises:
        ScenarioError: If the file cannot be used, or does not suit what the table says of it.
        UnknownNameError: If the table names a joint or a body that the file lacks.
    """
    told = {name: read_effector(given, f"{table}.grippers.{name}") for name, given in own.grippers.items()}
    path = folder / own.file
    file = read_model_file(path, None if own.folder is None else folder / own.folder)
    first: Any = file.spec.compile()
    where = {name: f"{path}: gripper {name}" for name in own.grippers}
    opening = {
        name: kind.fit(file.spec, first, keys, own.grippers[name], where[name]) for name, (kind, keys) in told.items()
    }
    model: Any = file.spec.compile()
    chains = {name: _chain(model, own, name, given, where[name]) for name, given in own.grippers.items()}
    _refuse_shared(chains, path)
    _refuse_second_roles(model, own, chains, opening, path)
    homes = _homes(model, own, chains, file, where)
    data = _at_home(model, homes)
    inertias = _inertias(model, data, list(own.grippers.values()))
    reading = _Reading(path=path, file=file, model=model, data=data, inertias=inertias)
    arms: list[Arm] = []
    for name, given in own.grippers.items():
        gripper = _effector(reading, *told[name], opening[name], given, where[name])
        arms.append(_arm(reading, name, given, gripper, chains[name], homes, where[name]))
    taken = {*own.base, *own.head, *own.torso, *(joint for chain in chains.values() for joint in chain)}
    fingers = {joint for joints in opening.values() for joint in joints}
    free = [name for name in _names(model) if name not in taken | fingers and name not in _coupled(model)]
    return Robot(
        kind="Robot",
        file=path,
        model=file.spec.to_xml(),
        arms=tuple(arms),
        base=_joints(reading, own.base, homes),
        torso=_joints(reading, (*own.torso, *free), homes),
        head=_joints(reading, own.head, homes),
    )


def _names(model: Any) -> list[str]:
    return [model.joint(j).name for j in range(model.njnt)]


def _coupled(model: Any) -> frozenset[str]:
    """Return the joints that follow others."""
    joints = int(mujoco.mjtEq.mjEQ_JOINT)
    return frozenset(model.joint(int(model.eq_obj1id[e])).name for e in range(model.neq) if model.eq_type[e] == joints)


def _chain(model: Any, own: OwnRobot, name: str, given: OwnGripper, where: str) -> tuple[str, ...]:
    """Return the joints of an arm from the trunk outwards."""
    known = _names(model)
    for what, names in (("base", own.base), ("torso", own.torso), ("head", own.head), (f"{name}.joints", given.joints)):
        for joint in names or ():
            if joint not in known:
                raise UnknownNameError.of("joint", joint, known, f"{where.split(': ')[0]}: {what}")
    body = int(model.body(given.palm).id)
    above: list[str] = []
    while body:
        first = int(model.body_jntadr[body])
        above = [model.joint(first + k).name for k in range(int(model.body_jntnum[body]))] + above
        body = int(model.body_parentid[body])
    trunk = {*own.base, *own.torso}
    chain = tuple(joint for joint in above if joint not in trunk)
    if given.joints is not None:
        if [joint for joint in above if joint in given.joints] != list(given.joints):
            raise ScenarioError(
                f"{where}: joints: {', '.join(given.joints)} are not in this order on the way from the root to the "
                f"palm {given.palm}; on it are: {', '.join(above) or 'none'}"
            )
        chain = given.joints
    if not chain:
        raise ScenarioError(f"{where}: no joint moves the palm {given.palm}")
    slaves = [joint for joint in chain if joint in _coupled(model)]
    if slaves:
        raise ScenarioError(f"{where}: the joint {slaves[0]} follows another one, so no motor of the arm drives it")
    return chain


def _refuse_shared(chains: dict[str, tuple[str, ...]], path: Path) -> None:
    for name, chain in chains.items():
        for other, its in chains.items():
            shared = [joint for joint in chain if joint in its]
            if other != name and shared:
                raise ScenarioError(
                    f"{path}: the joint {shared[0]} is on the way to {name} and to {other}; list it under torso"
                )


def _refuse_second_roles(
    model: Any, own: OwnRobot, chains: dict[str, tuple[str, ...]], opening: dict[str, tuple[str, ...]], path: Path
) -> None:
    """Refuse joints that are to do two things, and a base that is none."""
    roles = {"base": own.base, "torso": own.torso, "head": own.head}
    roles |= {f"an arm of {name}": chain for name, chain in chains.items()}
    roles |= {f"fingers of {name}": joints for name, joints in opening.items()}
    seen: dict[str, str] = {}
    for role, joints in roles.items():
        for joint in joints:
            if joint in seen:
                raise ScenarioError(
                    f"{path}: the joint {joint} is in {seen[joint]} and in {role}; allowed: one of them"
                )
            seen[joint] = role
    if not own.base:
        return
    kinds = [int(model.jnt_type[model.joint(joint).id]) for joint in own.base]
    slide, hinge = int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)
    if kinds != [slide, slide, hinge]:
        raise ScenarioError(
            f"{path}: base: {', '.join(own.base)} are no base; allowed: two joints that slide, then one that turns"
        )
    for given in own.grippers.values():
        body, above = int(model.body(given.palm).id), set[int]()
        while body:
            above.add(body)
            body = int(model.body_parentid[body])
        for joint in own.base:
            if int(model.jnt_bodyid[model.joint(joint).id]) not in above:
                raise ScenarioError(f"{path}: base: the joint {joint} does not carry the palm {given.palm}")


def _homes(
    model: Any, own: OwnRobot, chains: dict[str, tuple[str, ...]], file: ModelFile, where: dict[str, str]
) -> dict[str, float]:
    """Return where each joint is at the start."""
    trunk = {*own.base}
    homes: dict[str, float] = {}
    for joint in range(model.njnt):
        name = model.joint(joint).name
        low, high = (float(value) for value in model.jnt_range[joint])
        middle = (low + high) / 2 if model.jnt_limited[joint] and name not in trunk else 0.0
        homes[name] = file.home.get(name, middle)
    for name, given in own.grippers.items():
        if given.home is None:
            continue
        _refuse_count("home", given.home, chains[name], where[name])
        for joint, position in zip(chains[name], given.home, strict=True):
            low, high = (float(value) for value in model.joint(joint).range)
            if model.jnt_limited[model.joint(joint).id] and not low <= position <= high:
                raise ScenarioError(f"{where[name]}: home of {joint} is {position:g}, allowed {low:.4g} to {high:.4g}")
            homes[joint] = position
    # Fingers are where the situation says that the gripper is open.
    return {name: position for name, position in homes.items() if name not in _coupled(model)}


def _refuse_count(what: str, given: Sequence[float], joints: Sequence[str], where: str) -> None:
    if len(given) != len(joints):
        raise ScenarioError(f"{where}: {what} has {len(given)} values for {len(joints)} joints: {', '.join(joints)}")


def _at_home(model: Any, homes: dict[str, float]) -> Any:
    data = mujoco.MjData(model)
    for name, position in homes.items():
        data.joint(name).qpos[0] = position
    follow_couplings(model, data)
    mujoco.mj_forward(model, data)
    return data


def _inertias(model: Any, data: Any, grippers: Sequence[OwnGripper]) -> FloatArray:
    """Return the inertia that each joint moves, with the payload of the grippers beyond it, shape (n,)."""
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    inertias = np.diag(full).copy()
    for given in grippers:
        inertias += PAYLOAD * (_motion(model, data, given) ** 2).sum(axis=0)
    return inertias


def _motion(model: Any, data: Any, given: OwnGripper) -> FloatArray:
    """Return how the point where a gripper holds moves with each joint [m], shape (3, n)."""
    palm = int(model.body(given.palm).id)
    point = data.xpos[palm] + data.xmat[palm].reshape(3, 3) @ np.array(given.tool)
    result = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, result, None, point, palm)
    return result


def _joints(
    reading: _Reading,
    names: Sequence[str],
    homes: dict[str, float],
    speeds: Sequence[float | None] | None = None,
    stiffnesses: Sequence[float | None] | None = None,
) -> tuple[Joint, ...]:
    """Return the driven joints of these names, with what is not given computed."""
    speeds, stiffnesses = speeds or [None] * len(names), stiffnesses or [None] * len(names)
    made: list[Joint] = []
    for name, speed, stiffness in zip(names, speeds, stiffnesses, strict=True):
        number = int(reading.model.joint(name).id)
        slides = int(reading.model.jnt_type[number]) == int(mujoco.mjtJoint.mjJNT_SLIDE)
        inertia = float(reading.inertias[int(reading.model.jnt_dofadr[number])])
        effort = reading.file.efforts.get(name, np.inf)
        least, most = (inertia * (2 * np.pi * frequency) ** 2 for frequency in (FREQUENCY, FASTEST))
        wanted = effort / YIELDING if np.isfinite(effort) else least
        chosen = stiffness or float(np.clip(wanted, least, most))
        known = reading.file.speeds.get(name, SLIDE_SPEED if slides else HINGE_SPEED)
        if speed is not None and name in reading.file.speeds and speed > known:
            raise ScenarioError(f"{reading.path}: speed of {name} is {speed:g}, the model allows {known:g}")
        quickest = SLIDE_ACCELERATION if slides else HINGE_ACCELERATION
        made.append(
            Joint(
                name=name,
                speed=speed or known,
                acceleration=float(min(quickest, ACCELERATING * effort / inertia)),
                stiffness=chosen,
                damping=float(2 * np.sqrt(chosen * inertia)),
                home=homes[name],
            )
        )
    return tuple(made)


def _effector(
    reading: _Reading, kind: EffectorKind[Any], keys: Any, joints: tuple[str, ...], given: OwnGripper, where: str
) -> Effector:
    """Return what an arm holds things with, its greatest force computed if it is not given."""
    spec = reading.file.spec
    effector = kind.read(spec, reading.model, joints, keys, given, where)
    gap = kind.gap(spec, reading.model, effector, where)
    if given.max_force is not None:
        return effector
    effort = min((reading.file.efforts.get(joint, np.inf) for joint in joints), default=np.inf)
    if not np.isfinite(effort):
        raise ScenarioError(f"{where}: nothing tells the greatest force of its pads; give max_force [N]")
    return replace(effector, max_force=effort / round(max(gap.levers), 9))


def _arm(
    reading: _Reading,
    name: str,
    given: OwnGripper,
    gripper: Effector,
    chain: tuple[str, ...],
    homes: dict[str, float],
    where: str,
) -> Arm:
    """Return an arm, with what its gripper can do computed for where it is at home."""
    each: dict[str, list[float | None]] = {}
    for what, values in (("speed", given.speed), ("stiffness", given.stiffness)):
        if isinstance(values, tuple):
            _refuse_count(what, values, chain, where)
        each[what] = list(values) if isinstance(values, tuple) else [values] * len(chain)
    joints = _joints(reading, chain, homes, each["speed"], each["stiffness"])
    dofs = [int(reading.model.joint(joint).dofadr[0]) for joint in chain]
    levers = np.linalg.norm(_motion(reading.model, reading.data, given)[:, dofs], axis=0)
    farthest = joints[int(levers.argmax())]
    efforts = [reading.file.efforts.get(joint.name, YIELDING * joint.stiffness) for joint in joints]
    pushes = [effort / lever for effort, lever in zip(efforts, levers, strict=True) if lever > 0.0]
    return Arm(
        name=name,
        joints=joints,
        gripper=gripper,
        max_push=float(min(pushes)),
        max_speed=float(farthest.speed * levers.max()),
        max_acceleration=float(farthest.acceleration * levers.max()),
    )

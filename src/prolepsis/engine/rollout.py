"""A log from any MuJoCo rollout: the states say where all is, and MuJoCo computes the contacts again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from prolepsis.engine.model_things import ModelThings, SceneThings, model_things
from prolepsis.engine.touching import ContactRows, contact_rows, merge_rows
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import Contacts, Joints, Log
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError, InvalidSimulationError

_LARGEST = 1e10
"""MuJoCo calls a coordinate beyond this unstable (``mjMAXVAL``)."""


def read_rollout(
    model: Any,
    states: FloatArray,
    dt: float,
    scene: SceneThings | None = None,
    stuffs: Mapping[str, str] | None = None,
) -> Log:
    """Return the log of a rollout.

    Each state is set and ``mj_forward`` run on it, so positions, contacts and their forces are those that
    MuJoCo computes at the state's instant.

    Args:
        model: The ``mujoco.MjModel`` that was stepped.
        states: Full integration states (``mjSTATE_INTEGRATION``), one a tick, shape (T, k).
        dt: Time between two states [s].
        scene: Things that say more of those in the model (kind, roles, ...), by name; optional.
        stuffs: For each set of like bodies that is one stuff its name, and the pattern of theirs; optional.

    Raises:
        InputError: If ``model`` is none, ``states`` has the wrong shape, ``dt`` is not positive, or a stuff cannot be.
        InvalidSimulationError: If a state is not finite or MuJoCo warns of one.
    """
    if not isinstance(model, mujoco.MjModel):
        loaded = "mujoco.MjModel.from_xml_path(file)"
        raise InputError(f"model: a mujoco.MjModel is needed, as {loaded} gives it, not {type(model).__name__}")
    if not np.issubdtype(np.asarray(dt).dtype, np.number):
        raise InputError(f"dt: a number of seconds is needed, not {type(dt).__name__}")
    try:
        states = np.asarray(states, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("states: an array of numbers is needed, one full state (mjSTATE_INTEGRATION) a row") from None
    signature = int(mujoco.mjtState.mjSTATE_INTEGRATION)
    width = mujoco.mj_stateSize(model, signature)
    if states.ndim != 2 or states.shape[1] != width or not len(states):
        raise InputError(f"states: shape {states.shape}; (T, {width}) with T > 0 is needed (mjSTATE_INTEGRATION)")
    if not (np.isfinite(dt) and dt > 0):
        raise InputError(f"dt: {dt} s; a positive time is needed")
    _refuse_unstable(states, dt)
    _refuse_other_times(states[:, 0], dt)
    data = mujoco.MjData(model)
    mujoco.mj_setState(model, data, states[0], signature)
    mujoco.mj_kinematics(model, data)
    found = model_things(model, data, scene, stuffs)
    tick_count = len(states)
    poses = np.zeros((tick_count, len(found.things), 7))
    poses[:, :, 3] = 1.0
    moved = np.flatnonzero(found.body > 0)
    body = found.body[moved]
    switched = np.zeros((tick_count, model.neq), dtype=np.bool_)
    sticking = _adhesive_bodies(model)
    stuck = np.zeros((tick_count, len(sticking)), dtype=np.bool_)
    rows: list[ContactRows] = []
    for tick, state in enumerate(states):
        mujoco.mj_setState(model, data, state, signature)
        mujoco.mj_forward(model, data)
        _refuse_warnings(data, tick * dt)
        poses[tick, moved, :3] = data.xpos[body]
        poses[tick, moved, 3:] = data.xquat[body]
        switched[tick] = data.eq_active
        for column, (actuator, _) in enumerate(sticking):
            stuck[tick, column] = data.actuator_force[actuator] > 0
        here = contact_rows(model, data, tick)
        if here is not None:
            rows.append(here)
    contacts, touching = merge_rows(rows, found.of_geom)
    carrier = np.broadcast_to(found.carrier, (tick_count, len(found.things))).copy()
    return Log(
        dt=dt,
        things=found.things,
        time=np.arange(tick_count, dtype=np.float64) * dt,
        poses=poses,
        carrier=carrier,
        contacts=contacts,
        joints=_joints(model, found, switched, sticking, stuck, contacts, touching),
        gravity=(float(model.opt.gravity[0]), float(model.opt.gravity[1]), float(model.opt.gravity[2])),
    )


def _refuse_other_times(times: FloatArray, dt: float) -> None:
    """Refuse a tick that the states' own times contradict; a recording that keeps no time has none of them."""
    apart = np.diff(times)
    if len(apart) and (apart > 0).all() and abs(float(np.median(apart)) - dt) > 0.01 * dt:
        raise InputError(f"dt: {dt:g} s, but by their own times the states are {float(np.median(apart)):g} s apart")


def _refuse_unstable(states: FloatArray, dt: float) -> None:
    bad = ~np.isfinite(states) | (np.abs(states) > _LARGEST)
    if bad.any():
        tick = int(np.flatnonzero(bad.any(axis=1))[0])
        value = states[tick][bad[tick]][0]
        raise InvalidSimulationError(f"states: {value} at {tick * dt:g} s (state {tick}); the rollout is unstable")


def _refuse_warnings(data: Any, time: float) -> None:
    for kind, warning in enumerate(data.warning):
        if warning.number:
            name = mujoco.mjtWarning(kind).name.removeprefix("mjWARN_").lower()
            raise InvalidSimulationError(f"MuJoCo warns of {name} at {time:g} s; the rollout is unstable")


def _adhesive_bodies(model: Any) -> list[tuple[int, int]]:
    body_transmission = int(mujoco.mjtTrn.mjTRN_BODY)
    return [
        (actuator, int(model.actuator_trnid[actuator, 0]))
        for actuator in range(model.nu)
        if int(model.actuator_trntype[actuator]) == body_transmission
    ]


def _joints(
    model: Any,
    found: ModelThings,
    switched: BoolArray,
    sticking: list[tuple[int, int]],
    stuck: BoolArray,
    contacts: Contacts,
    adhesive: BoolArray,
) -> Joints:
    rows: list[tuple[int, int, int, int]] = []
    for equality in range(model.neq):
        pair = _welded_pair(model, found, equality)
        if pair is not None:
            rows += [(*pair, start, end) for start, end in _stretches(switched[:, equality])]
    rows += _sticking_rows(found, sticking, stuck, contacts)
    rows += _sticky_rows(found, contacts, adhesive, len(switched))
    table = np.array(sorted(rows, key=lambda row: (row[2], row)), dtype=np.int64).reshape(-1, 4)
    return Joints(a=table[:, 0], b=table[:, 1], start=table[:, 2], end=table[:, 3])


def _welded_pair(model: Any, found: ModelThings, equality: int) -> tuple[int, int] | None:
    # Numpy's integers do not equal MuJoCo's enumerators, so plain integers are compared.
    if int(model.eq_type[equality]) not in (int(mujoco.mjtEq.mjEQ_WELD), int(mujoco.mjtEq.mjEQ_CONNECT)):
        return None
    ends = [int(model.eq_obj1id[equality]), int(model.eq_obj2id[equality])]
    if int(model.eq_objtype[equality]) == int(mujoco.mjtObj.mjOBJ_SITE):
        ends = [int(model.site_bodyid[site]) for site in ends]
    first, second = (int(found.of_body[body]) for body in ends)
    if first < 0 or second < 0 or first == second:
        return None
    return (second, first) if found.things[second].fixed and not found.things[first].fixed else (first, second)


def _sticking_rows(
    found: ModelThings, sticking: list[tuple[int, int]], stuck: BoolArray, contacts: Contacts
) -> Iterator[tuple[int, int, int, int]]:
    """Yield joints between each adhesive body and what it touches while its actuator pulls."""
    for column, (_, body) in enumerate(sticking):
        holder = int(found.of_body[body])
        for other in _partners(contacts, holder):
            if not found.things[other].fixed:
                touching = stuck[:, column] & _touching(contacts, holder, other, len(stuck))
                yield from ((holder, other, start, end) for start, end in _stretches(touching))


def _sticky_rows(
    found: ModelThings, contacts: Contacts, adhesive: BoolArray, tick_count: int
) -> Iterator[tuple[int, int, int, int]]:
    """Yield joints between things whose geoms are sticky by themselves."""
    pairs = sorted(set(zip(contacts.a[adhesive].tolist(), contacts.b[adhesive].tolist(), strict=True)))
    for a, b in pairs:
        mask = np.zeros(tick_count, dtype=np.bool_)
        mask[contacts.tick[adhesive & (contacts.a == a) & (contacts.b == b)]] = True
        other = found.things[int(b)]
        holder, held = (int(b), int(a)) if other.fixed or "Driven" in other.roles else (int(a), int(b))
        if not found.things[held].fixed:
            yield from ((holder, held, start, end) for start, end in _stretches(mask))


def _partners(contacts: Contacts, thing: int) -> list[int]:
    return sorted({*contacts.b[contacts.a == thing].tolist(), *contacts.a[contacts.b == thing].tolist()})


def _touching(contacts: Contacts, first: int, second: int, tick_count: int) -> BoolArray:
    a, b = min(first, second), max(first, second)
    mask = np.zeros(tick_count, dtype=np.bool_)
    mask[contacts.tick[(contacts.a == a) & (contacts.b == b)]] = True
    return mask


def _stretches(mask: BoolArray) -> list[tuple[int, int]]:
    edges: IntArray = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return [(int(start), int(end)) for start, end in edges.reshape(-1, 2)]

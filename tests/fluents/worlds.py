"""Ten-line worlds, stepped by plain MuJoCo and read as foreign logs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Timeline
from prolepsis.system.mujoco import mujoco

Control = Callable[[Any, Any], None]
STEP = 0.002
FLOOR = '<geom name="floor" type="plane" size="2 2 .1"/>'


def world(body: str, extra: str = "") -> str:
    """Return the MJCF of a world with these bodies, a smooth contact model and ``extra`` after the worldbody."""
    return (
        '<mujoco><option cone="elliptic" integrator="implicitfast"/>'
        '<default><geom solref=".01 1" solimp="0 .95 .002"/></default>'
        f"<worldbody>{body}</worldbody>{extra}</mujoco>"
    )


def box(name: str, where: str, size: str = ".05 .05 .05", mass: float = 1.0, more: str = "", turn: str = "") -> str:
    """Return a free box: position, half extents [m], mass [kg]; ``more`` for its geom, ``turn`` its Euler angles."""
    return free(name, where, f'<geom type="box" size="{size}" mass="{mass}" {more}/>', turn)


def ball(name: str, where: str, radius: float = 0.03, mass: float = 0.2, more: str = "") -> str:
    """Return a free ball."""
    return free(name, where, f'<geom type="sphere" size="{radius}" mass="{mass}" {more}/>')


def free(name: str, where: str, geoms: str, turn: str = "") -> str:
    """Return a free body."""
    euler = f' euler="{turn}"' if turn else ""
    return f'<body name="{name}" pos="{where}"{euler}><freejoint/>{geoms}</body>'


def cup_geoms(
    radius: float = 0.05, height: float = 0.08, wall: float = 0.004, bottom: bool = True, count: int = 16
) -> str:
    """Return the walls and the bottom of a cup that stands on the origin of its body."""
    geoms: list[str] = []
    count = 16
    for k in range(count):
        angle = 2 * np.pi * k / count
        x, y = radius * np.cos(angle), radius * np.sin(angle)
        half = np.pi * radius / count * 1.1
        geoms.append(
            f'<geom type="box" size="{wall / 2} {half} {height / 2}" pos="{x} {y} {height / 2}" '
            f'euler="0 0 {np.degrees(angle)}" mass=".02"/>'
        )
    if bottom:
        geoms.append(f'<geom type="cylinder" size="{radius} {wall / 2}" pos="0 0 {wall / 2}" mass=".05"/>')
    return "".join(geoms)


def roll(xml: str, seconds: float, control: Control | None = None, dt: float = STEP) -> tuple[Any, FloatArray]:
    """Return a model and the integration states of a rollout, one a step."""
    model = mujoco.MjModel.from_xml_string(xml)
    model.opt.timestep = dt
    data = mujoco.MjData(model)
    signature = mujoco.mjtState.mjSTATE_INTEGRATION
    states = np.zeros((round(seconds / dt), mujoco.mj_stateSize(model, signature)))
    for state in states:
        if control is not None:
            control(model, data)
        mujoco.mj_getState(model, data, state, signature)
        mujoco.mj_step(model, data)
    return model, states


def watch(
    xml: str,
    seconds: float,
    control: Control | None = None,
    scene: Mapping[str, Thing] | None = None,
    stuffs: Mapping[str, str] | None = None,
) -> Timeline:
    """Return the timeline of a rollout."""
    model, states = roll(xml, seconds, control)
    return recognize(Log.from_mujoco(model, states, STEP, scene, stuffs=stuffs))


def ramp(time: float, start: float, end: float, height: float) -> float:
    """Return a value that rises from 0 to ``height`` between two times."""
    return height * min(max((time - start) / (end - start), 0.0), 1.0)


HAND = (
    '<body name="hand" pos="0 0 .05"><joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide"/>'
    '<geom type="box" size=".02 .06 .01" pos="0 0 .08" mass=".3"/>'
    '<body name="left_finger" pos="0 .05 0"><joint name="l" type="slide" axis="0 1 0" range="-.05 .02" damping="5"/>'
    '<geom type="box" size=".015 .005 .03" mass=".1"/></body>'
    '<body name="right_finger" pos="0 -.05 0"><joint name="r" type="slide" axis="0 -1 0" range="-.05 .02" damping="5"/>'
    '<geom type="box" size=".015 .005 .03" mass=".1"/></body></body>'
)
"""A parallel gripper on two slides, open, around what stands at the origin."""
HAND_DRIVES = (
    '<actuator><position joint="x" kp="2000" kv="100"/><position joint="z" kp="2000" kv="100"/>'
    '<motor joint="l"/><motor joint="r"/></actuator>'
)


def drive(x: Callable[[float], float], z: Callable[[float], float], squeeze: Callable[[float], float]) -> Control:
    """Return the control of ``HAND``: where it goes [m] and how hard it squeezes [N] at each time [s]."""

    def control(model: Any, data: Any) -> None:
        force = squeeze(data.time)
        data.ctrl[:] = [x(data.time), z(data.time), -force, -force]

    return control


def ever(timeline: Timeline) -> set[str]:
    """Return the terms of all facts."""
    return {str(fact.term) for fact in timeline.facts}


def times(timeline: Timeline, term: str) -> list[tuple[float, float]]:
    """Return when a fact holds."""
    return [(fact.start, fact.end) for fact in timeline.facts if str(fact.term) == term]


def at_end(timeline: Timeline) -> set[str]:
    """Return the terms of the facts that hold when the log ends."""
    return {str(fact.term) for fact in timeline.facts if fact.end == timeline.duration}


def of_type(timeline: Timeline, *types: str) -> set[str]:
    """Return the terms of all facts of some types."""
    return {str(fact.term) for fact in timeline.facts if fact.type in types}

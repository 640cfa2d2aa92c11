"""Small scenes for tests, written as Turtle, and runs of them."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.log import Log
from prolepsis.programs import read_program
from prolepsis.scenario.file import DEFAULT_PARTICLES
from prolepsis.scene.kind import Controller, Kind
from prolepsis.scene.running import Running
from prolepsis.scene.scene import Scene
from prolepsis.terms.reader import parse_term

Acting = TypeVar("Acting", bound=Controller)

PREFIX = "@prefix : <https://w3id.org/prolepsis#> .\n"

EGG_IN_HAND = ":floor a :Floor . :table1 a :Table . :egg1 a :Egg ; :on :table1 .\n" + (
    ":hand1 a :Gripper ; :pitch 90.0 ; :z 0.722 ; :opening 0.05 ."
)
"""An egg on a table, the open pads of a hand on both sides of it."""


def scene(turtle: str, values: Mapping[str, float | str] | None = None, particles: int = DEFAULT_PARTICLES) -> Scene:
    """Return the scene of a situation written as Turtle (without the prefix), with some values replaced."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "situation.ttl"
        file.write_text(PREFIX + turtle, encoding="utf-8")
        knowledge = KnowledgeBase.load(file)
    return compose_scene(knowledge.with_values(values) if values else knowledge, particles=particles)


def run(
    turtle: str,
    plan: str = "wait(0.001)",
    *,
    values: Mapping[str, float | str] | None = None,
    particles: int = DEFAULT_PARTICLES,
    thrown: Mapping[str, Sequence[float]] | None = None,
    **options: Any,
) -> Log:
    """Return the log of a plan in a situation.

    ``thrown`` tells velocities at the start [m/s, rad/s], six numbers by thing; ``options`` are those of ``simulate``.
    """
    composed = scene(turtle, values, particles)
    if thrown:
        composed = replace(composed, kinds=(*composed.kinds, Throwing(thrown)))
    return simulate(compile_world(composed), read_program(parse_term(plan), composed), **options)


class Throwing(Kind):
    """Gives things a velocity at the start."""

    order = 99

    def __init__(self, velocities: Mapping[str, Sequence[float]]) -> None:
        """Give things velocities [m/s, rad/s], six numbers by thing."""
        self.velocities = velocities

    def start(self, state: Running) -> Sequence[Controller]:
        """Give them their velocities."""
        for name, velocity in self.velocities.items():
            state.data.joint(name).qvel[:] = velocity
        return ()


def started(state: State, type: type[Acting]) -> list[Acting]:
    """Start the controllers of all kinds in a state, and return those of a type."""
    going = [controller for kind in state.scene.kinds for controller in kind.start(state)]
    for each in going:
        each.bind(state)
    return [each for each in going if isinstance(each, type)]


def falling_egg(height: float, *, standing: bool = False) -> str:
    """Return the situation of an egg whose lowest point is ``height`` [m] above the floor."""
    z = height + (0.0285 if standing else 0.022)
    return f":floor a :Floor . :egg1 a :Egg ; :z {z!r} ; :pitch {90.0 if standing else 0.0} ."

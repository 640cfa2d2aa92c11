"""What is wrong with a run of a scene at rest, or of one that may not gain energy: complaints, none if all is right."""

from __future__ import annotations

import numpy as np
from tests.laws.energies import energies
from tests.scenes import scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import World, compile_world
from prolepsis.fluents import recognize
from prolepsis.log.log import Log
from prolepsis.programs import read_program
from prolepsis.terms.reader import parse_term

PARTICLES = 200
"""Particles in a full cup: coarse, since a table has many rows."""
SETTLED = 0.5
"""After this time [s] nothing moves any more; what is put down sinks in by up to a millimetre."""
DRIFT = 1.0e-3
"""Greatest way of anything after that [m]: what one sees."""
AT_NO_TIME, ONCE_SETTLED = {"falling", "colliding", "breaking"}, {"moving", "spilling", "flowingOut", "dripping"}
GAIN, LIQUID_GAIN = 0.005, 0.1
"""Share of the energy lost [1] by which it may seem to rise again. That of bodies is read from their poses a tick
apart; a liquid is seen every 20 ms only, and what moves to and fro within that time in a splash is missed."""


def moved(turtle: str) -> list[str]:
    """Return what happens in a scene in which nothing should."""
    _, log = _run(turtle, 1.2)
    timeline = recognize(log)
    wrong = [
        f"{fact.term} from {fact.start:.3f} to {fact.end:.3f} s"
        for fact in timeline.facts
        if fact.type in AT_NO_TIME or (fact.type in ONCE_SETTLED and fact.end > SETTLED)
    ]
    wrong += [str(fact.term) for fact in timeline.select(type="contains") if str(fact.args[0]).startswith("table")]
    place = log.poses[round(SETTLED / log.dt) :, :, :3]
    drift = np.linalg.norm(place - place[0], axis=2).max(axis=0)
    wrong += [f"{log.things[k].name} drifts by {drift[k]:.4f} m" for k in np.flatnonzero(drift > DRIFT).tolist()]
    return wrong


def gained(turtle: str, most: float) -> list[str]:
    """Return what is wrong with the energy of a scene in which none is added.

    Args:
        turtle: The situation; what falls is ``b``, ``b0``, or else ``c``.
        most: Greatest height of its rebound over that of its drop [1], both above where it ends.
    """
    world, log = _run(turtle, 1.5)
    energy = energies(world, log)
    gain = float((energy - np.minimum.accumulate(energy)).max() / (energy[0] - energy.min()))
    names = [thing.name for thing in log.things]
    height = log.poses[:, names.index(next(name for name in ("b", "b0", "c") if name in names)), 2]
    rising = np.flatnonzero(np.diff(height) > 0)
    after = height[rising[0] :].max() if len(rising) else height[-1]
    rebound = float((after - height[-1]) / (height[0] - height[-1]))
    wrong = [f"{100 * gain:.1f} % of the energy lost comes back"] if gain > _tolerance(log) else []
    return wrong + ([f"it rebounds to {rebound:.2f} of the drop"] if rebound > most else [])


def _tolerance(log: Log) -> float:
    return LIQUID_GAIN if len(log.particles.tick) else GAIN


def _run(turtle: str, duration: float) -> tuple[World, Log]:
    composed = scene(turtle, particles=PARTICLES)
    world = compile_world(composed)
    return world, simulate(world, read_program(parse_term("wait(0.1)"), composed), duration=duration)

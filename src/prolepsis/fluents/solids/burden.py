"""Where the centre of mass of a thing is with all that it carries: what stands on it, and the liquid within."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import ticks_of
from prolepsis.fluents.kinematics import BALANCE_WINDOW
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.solids.support import bearing_forces, support_runs
from prolepsis.geometry.rotations import rotate, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.geometry.solids import bounded, centre_of_volume
from prolepsis.log.things import Thing

CARRIED = 0.5
"""Share of its weight [1] from which something is carried by what it stands on; less leans."""


def own_centre(thing: Thing) -> FloatArray:
    """Return the centre of mass of a thing that is a body of its own, in its frame [m], shape (3,)."""
    return centre_of_volume(thing.shape) if thing.centre is None else np.array(thing.centre)


def laden_centre(observation: Observation, unit: int, start: int) -> FloatArray:
    """Return the centre of mass of a unit with all that it carries at a tick, as long as it does, shape (T, 3).

    It is in the frame of the unit [m].
    """
    pose = observation.log.poses[:, unit]
    mass = observation.mass(unit).astype(np.float64)
    moment = mass[:, None] * own_centre(observation.log.things[unit])
    for burden, during in _burdens(observation, unit, start, {unit}):
        weight = observation.mass(burden) * during
        there = observation.log.poses[:, burden]
        position = there[:, :3] + rotate(there[:, 3:], own_centre(observation.log.things[burden]))
        moment += weight[:, None] * rotate_back(pose[:, 3:], position - pose[:, :3])
        mass += weight
    for frame, weight, position in _contents(observation, unit, start):
        mass[frame] += weight
        moment[frame] += weight * position
    return moment / np.maximum(mass, 1e-12)[:, None]


def _burdens(observation: Observation, unit: int, start: int, known: set[int]) -> Iterator[tuple[int, BoolArray]]:
    """Yield what a unit carries at a tick, and when it does without a break, shape (T,) each."""
    window = ticks_of(BALANCE_WINDOW, observation.dt)
    for (below, above), stretches in observation.of(support_runs).items():
        here = stretches[(stretches[:, 0] <= start + window) & (start < stretches[:, 1])]
        if below != unit or above in known or not len(here) or not bounded(observation.log.things[above].shape):
            continue
        near = slice(max(start - window, 0), start + window)
        bearing = float(observation.of(bearing_forces)[below, above][near].mean())
        if bearing < CARRIED * float(observation.mass(above)[start]) * observation.gravity:
            continue
        during = np.zeros(observation.tick_count, dtype=np.bool_)
        during[here[0, 0] : here[0, 1]] = True
        yield above, during
        for further, then in _burdens(observation, above, start, known | {above}):
            yield further, during & then


def _contents(observation: Observation, unit: int, start: int) -> Iterator[tuple[slice, float, FloatArray]]:
    """Yield, from frame to frame, the mass of the particles within the bounds of a unit [kg] and their middle [m]."""
    particles, pose = observation.log.particles, observation.log.poses[:, unit]
    bounds = [solid.bounds() for solid in bounded(observation.log.things[unit].shape)]
    if not len(particles.stuff) or not bounds:
        return
    low, high = np.min([each for each, _ in bounds], axis=0), np.max([each for _, each in bounds], axis=0)
    ends = np.append(particles.tick[1:], observation.tick_count)
    for frame in range(max(int(np.searchsorted(ends, start, side="right")), 0), len(particles.tick)):
        tick = int(particles.tick[frame])
        position = rotate_back(pose[tick, 3:], particles.position[frame].astype(np.float64) - pose[tick, :3])
        within = ((position >= low) & (position <= high)).all(axis=1)
        weight = float(particles.mass[within].sum())
        if weight > 0:
            yield slice(tick, int(ends[frame])), weight, particles.mass[within] @ position[within] / weight

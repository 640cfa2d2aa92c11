"""Mechanical energy of everything in a log: bodies with their turning, and the particles of liquids."""

from __future__ import annotations

import numpy as np

from prolepsis.engine.world import World
from prolepsis.geometry.rotations import multiply, rotate, rotate_back
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import Log

WINDOW = 0.1
"""The energy is the greatest within this time [s]: meanwhile contacts store and return some."""


def energies(world: World, log: Log) -> FloatArray:
    """Return the mechanical energy of all bodies, and of the liquids where there are some [J], of each window."""
    body = _bodies(world, log)
    particles = log.particles
    if len(particles.tick):
        # A liquid's motion is known from where it is every so many ticks, so that of bodies is taken over the same.
        ticks = np.concatenate(([0.0], np.cumsum(body)))[np.minimum(particles.tick, len(body))]
        body = np.diff(ticks) / np.diff(np.minimum(particles.tick, len(body))) + _liquids(log)
    span = max(1, round(WINDOW / (log.dt if not len(particles.tick) else log.dt * np.diff(particles.tick)[0])))
    return np.array([body[k : k + span].max() for k in range(0, len(body) - span + 1, span)])


def _bodies(world: World, log: Log) -> FloatArray:
    model = world.model
    total = np.zeros(log.tick_count - 1)
    for number, thing in enumerate(log.things):
        if thing.fixed or not thing.is_body:
            continue
        at = model.body(thing.name).id
        mass, inertia = float(model.body_mass[at]), model.body_inertia[at]
        pose = log.poses[:, number]
        middle = pose[:, :3] + rotate(pose[:, 3:], model.body_ipos[at])
        speed = np.diff(middle, axis=0) / log.dt
        change = multiply(pose[1:, 3:], pose[:-1, 3:] * np.array([1.0, -1, -1, -1]))
        spin = 2.0 * change[:, 1:] * np.sign(change[:, :1] + 1e-300) / log.dt
        own = rotate_back(model.body_iquat[at], rotate_back(pose[:-1, 3:], spin))
        height = (middle[1:, 2] + middle[:-1, 2]) / 2
        total += mass * (0.5 * np.square(speed).sum(axis=1) + 9.81 * height)
        total += 0.5 * np.square(own) @ inertia
    return total


def _liquids(log: Log) -> FloatArray:
    particles = log.particles
    place = particles.position.astype(np.float64)
    time = np.diff(particles.tick) * log.dt
    speed = np.diff(place, axis=0) / time[:, None, None]
    height = (place[1:, :, 2] + place[:-1, :, 2]) / 2
    return (0.5 * np.square(speed).sum(axis=2) + 9.81 * height) @ particles.mass

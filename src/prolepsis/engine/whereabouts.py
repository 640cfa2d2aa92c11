"""Where a thing is and how fast it goes, also where it is no rigid body: a hand, what is in pieces, a liquid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.things import Thing
from prolepsis.scene.running import Running


def whereabouts(state: Running, thing: Thing) -> tuple[FloatArray, FloatArray]:
    """Return position [m] and velocity [m/s] of a thing in the world, each of shape (3,).

    They are those of its frame while a rigid body carries it. The frame of a whole that hangs together by joints goes
    with the first of its parts; of what has fallen apart, or flows, they are those of its middle.
    """
    index = state.scene.index(thing.name)
    if state.carrier[index] >= 0:
        return state.pose(thing.name)[:3], state.velocity(thing.name)
    things = state.scene.things
    first = next((part for part in things if part.whole == thing.name and part.mount.by == "joints"), None)
    if first is not None:
        offset = matrix(np.array(first.orientation)).T @ np.subtract(thing.position, first.position)
        pose = state.pose(first.name)
        position = pose[:3] + matrix(pose[3:]) @ offset
        return position, state.velocity_at(first.name, position)
    particles = state.particles
    if particles is not None and (mine := particles.stuff == index).any():
        velocity = particles.velocity[mine]
        holders = particles.holder[mine]
        for holder in {int(each) for each in holders if each >= 0}:
            velocity[holders == holder] = state.velocity(things[holder].name)
        weights = particles.mass[mine]
        return np.average(particles.now()[mine], 0, weights), np.average(velocity, 0, weights)
    parts = [
        part
        for part in _parts(things, thing.name)
        if part.mass > 0 and state.carrier[state.scene.index(part.name)] >= 0
    ]
    if not parts:
        return np.array(thing.position), np.zeros(3)
    weights = np.array([part.mass for part in parts])
    positions = np.array([state.pose(part.name)[:3] for part in parts])
    return np.average(positions, 0, weights), np.average([state.velocity(part.name) for part in parts], 0, weights)


def _parts(things: tuple[Thing, ...], whole: str) -> list[Thing]:
    """Return all that has no parts and belongs to a whole, at any depth."""
    direct = [part for part in things if part.whole == whole]
    return [leaf for part in direct for leaf in (_parts(things, part.name) or [part])]


def carrier_of(things: Sequence[Thing], index: Mapping[str, int], i: int) -> int:
    """Return the rigid body that carries thing ``i`` at the start, by its index, or -1."""
    k = i
    while True:
        if things[k].is_body:
            return k
        whole = things[k].whole
        if whole is None:
            return -1
        k = index[whole]

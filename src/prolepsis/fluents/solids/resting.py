"""What fixed things rest on: physics computes no forces between them, so their shapes must tell."""

from __future__ import annotations

import numpy as np

from prolepsis.fluents.observation import Observation
from prolepsis.geometry.rotations import rotate, rotate_back
from prolepsis.geometry.shape import FloatArray
from prolepsis.geometry.solids import Solid, bounded, solid_of

TOUCHING = 0.005
"""Gap between fixed things that counts as touching [m]: how exactly furniture is modelled."""
_LOWEST = 0.002
"""Height above its lowest point [m] within which a thing's points are its feet."""


def fixed_supports(observation: Observation) -> tuple[tuple[int, int], ...]:
    """Return the pairs (below, above) of fixed units of which the first bears the second's feet."""
    things = observation.log.things
    fixed = [unit for unit in observation.units if things[unit].fixed]
    pairs: list[tuple[int, int]] = []
    for above in fixed:
        feet = _feet(observation, above)
        if len(feet):
            pairs += [(below, above) for below in fixed if below != above and _bears(observation, below, feet)]
    return tuple(pairs)


def _fixed_parts(observation: Observation, unit: int) -> list[int]:
    things = observation.log.things
    return [i for i in np.flatnonzero(observation.unit == unit).tolist() if things[i].fixed]


def _feet(observation: Observation, unit: int) -> FloatArray:
    points: list[FloatArray] = []
    for part in _fixed_parts(observation, unit):
        pose = observation.log.poses[0, part]
        for solid in bounded(observation.log.things[part].shape):
            here = solid.corners @ solid.rotation.T + solid.position
            points.append(rotate(pose[3:], here) + pose[:3])
    if not points:
        return np.zeros((0, 3))
    everything = np.concatenate(points)
    height = everything @ observation.up
    return everything[height <= height.min() + _LOWEST]


def _bears(observation: Observation, unit: int, feet: FloatArray) -> bool:
    up = observation.up
    for part in _fixed_parts(observation, unit):
        pose = observation.log.poses[0, part]
        for geom in observation.log.things[part].shape.geoms:
            solid = solid_of(geom)
            gap = _distance(solid, pose, feet)
            if geom.type == "plane":
                bearing = gap <= TOUCHING
            else:
                below = _distance(solid, pose, feet - 2 * TOUCHING * up)
                above = _distance(solid, pose, feet + 2 * TOUCHING * up)
                bearing = (gap <= TOUCHING) & (below < 0) & (above > 0)
            if bearing.any():
                return True
    return False


def _distance(solid: Solid, pose: FloatArray, points: FloatArray) -> FloatArray:
    return solid.distance(rotate_back(pose[3:], points - pose[:3]))

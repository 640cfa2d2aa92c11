"""When a blob is within the hollow of a vessel: if nothing contains it, it is on its way out, so not spilled yet."""

from __future__ import annotations

import numpy as np

from prolepsis.fluents.hollows import PLUG, hollows_of
from prolepsis.fluents.inside import CLEARANCE
from prolepsis.fluents.kinematics import centres
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.shapes_in_time import RigidShape, rigid_shapes
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.containment import blob_shares
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import BoolArray
from prolepsis.geometry.solids import bounded


def blobs_in_hollows(observation: Observation) -> dict[int, dict[int, BoolArray]]:
    """Return when the middle of each blob is in the hollow of each vessel, for those that ever are: (T,) each."""
    blobs = [blob for shares in observation.of(blob_shares).values() for blob in shares]
    found: dict[int, dict[int, BoolArray]] = {}
    if not blobs:
        return found
    for shape in observation.of(rigid_shapes):
        unit = int(observation.unit[shape.body])
        if shape.is_hollow and not is_stuff(observation, unit):
            for blob, mask in _within(observation, shape, blobs).items():
                masks = found.setdefault(blob, {})
                masks[unit] = masks[unit] | mask if unit in masks else mask
    return found


def _within(observation: Observation, shape: RigidShape, blobs: list[int]) -> dict[int, BoolArray]:
    """Return when the middle of each blob is in the hollow of one shape, which stands on any side, gaps stopped."""
    hollows: dict[float, BoolArray] = {}
    low, high = shape.bounds()
    host = observation.log.poses[:, shape.body]
    found: dict[int, BoolArray] = {}
    for blob in blobs:
        local = rotate_back(host[:, 3:], observation.of(centres)[blob] - host[:, :3])
        near = np.flatnonzero(np.all((local > low) & (local < high), axis=1) & shape.during)
        if not len(near):
            continue
        space = hollows_of(observation, shape).whole
        solids = bounded(observation.log.things[blob].shape)
        least = min((solid.half_width for solid in solids), default=0.0)
        plug = max(PLUG, space.step * int(CLEARANCE * least / space.step))
        if plug not in hollows:
            hollows[plug] = space.hollow(plug)
        nodes = np.rint((local[near] - space.origin) / space.step).astype(np.int64)
        mask = np.zeros(observation.tick_count, dtype=np.bool_)
        mask[near] = hollows[plug][tuple(nodes.T)]
        if mask.any():
            found[blob] = mask
    return found

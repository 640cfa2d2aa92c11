"""How what stands on something turns there: by how much, about which point, and how far it is from going over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.intervals import debounce, mask_of, ticks_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.solids.burden import own_centre
from prolepsis.fluents.solids.contact import FLICKER
from prolepsis.fluents.solids.touch import UNDER_COSINE, touches
from prolepsis.geometry.rotations import angle_between, cross, rotate, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.solids import bounded

TURNING_WINDOW = 0.05
"""Time over which turning is taken [s]."""
ROLLING = 0.25
"""Speed of the point of contact within the body over that of its centre about that point [1], from which it rolls: a
ball has 1, an edge that is rounded by a tenth of the height 0.1."""

BENEATH = 0.5
"""Share of its turning [1] by which the normal of what presses on a body turns in its frame when it rolls beneath."""
RESTING = 0.1
"""What is borne as near as this to where it turned, as a share of the height of its centre [1], rests on its edge."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Standing:
    """A unit that is borne by another body, both as rigid bodies; all vectors are in the frame of the unit."""

    unit: int
    """What stands."""
    below: int
    """The thing on which it stands."""
    touching: BoolArray
    """When it does, hops included, shape (T,)."""
    pressing: BoolArray
    """When it does, without hops, shape (T,)."""
    upright: FloatArray
    """The direction that was up when it first stood there, and that moves with what is below, shape (T, 3)."""
    up: FloatArray
    """Against gravity, shape (T, 3)."""
    point: FloatArray
    """Where it is borne, the middle of all contacts by force [m], shape (T, 3)."""
    point_below: FloatArray
    """The same in the frame of what is below [m], shape (T, 3)."""
    normal: FloatArray
    """Mean normal of these contacts, towards the unit, shape (T, 3)."""
    centre: FloatArray
    """Its centre of mass [m], shape (3,)."""

    def speed(self, dt: float) -> FloatArray:
        """Return how fast it turns about any horizontal axis, over half a window before and after [rad/s], (T,)."""
        half = ticks_of(TURNING_WINDOW / 2, dt)
        return self._turned(half, half) / (2 * half * dt)

    def step(self) -> FloatArray:
        """Return by how much it turns so from each tick to the next [rad], shape (T,)."""
        return self._turned(0, 1)

    def _turned(self, before: int, after: int) -> FloatArray:
        """Return the lesser of how it turns on what is below and in the world: what lies still does not turn."""
        return np.minimum(*(_norms(_change(axis, before, after)) for axis in (self.upright, self.up)))

    def on_edge(self, dt: float) -> BoolArray:
        """Return whether it turns about a point that stays where it is in the body, or in what is below, or lies there
        with a face that stays the same, as a board does on a ball that rolls, shape (T,).

        At its landing the point jumps, so the steadier of half a window before and after each tick counts.
        """
        half = ticks_of(TURNING_WINDOW / 2, dt)
        return self.touching & (self._about_edge(half, 0) | self._about_edge(0, half))

    def about_edge(self, on_edge: BoolArray) -> BoolArray:
        """Return when it is borne where it turned last, be it at rest there, shape (T,)."""
        now = np.arange(len(on_edge))
        last = np.maximum.accumulate(np.where(on_edge, now, 0))
        near = _norms(self.point - self.point[last]) < RESTING * _norms(self.centre - self.point)
        return on_edge | (self.touching & on_edge[last] & near)

    def _about_edge(self, before: int, after: int) -> BoolArray:
        rotation, moved = _change(self.upright, before, after), _change(self.point, before, after)
        size = _norms(rotation)
        axis = cross(self.upright, rotation) / np.maximum(size, 1e-12)[:, None]
        # Along the edge it may move: a corner of it is borne first.
        moved -= np.einsum("tc,tc->t", moved, axis)[:, None] * axis
        least = np.minimum(_norms(moved), _norms(_change(self.point_below, before, after)))
        # Of what is long and borne at one end, only the distance of its middle from the axis counts.
        arm = self.centre - self.point
        arm -= np.einsum("tc,tc->t", arm, axis)[:, None] * axis
        faces = _norms(_change(self.normal, before, after)) < ROLLING * size
        return (least < ROLLING * _norms(arm) * size) | (faces & (size > 0))


def standings(observation: Observation, unit: int) -> Iterator[Standing]:
    """Yield how a unit stands on each body that ever bears it."""
    log, contacts, count = observation.log, observation.log.contacts, observation.tick_count
    pose = log.poses[:, unit]
    if not bounded(log.things[unit].shape):
        return
    rows = [touch.rows for touch in observation.of(touches) if unit in (touch.a, touch.b)]
    if not rows:
        return
    rows = np.concatenate(rows)
    above = observation.unit[contacts.b[rows]] == unit
    normal = np.where(above[:, None], contacts.normal[rows], -contacts.normal[rows])
    bearing = normal @ observation.up >= UNDER_COSINE
    rows, normal = rows[bearing], normal[bearing]
    other = np.where(above[bearing], contacts.a[rows], contacts.b[rows])
    press = np.abs(np.einsum("ci,ci->c", contacts.force[rows], contacts.normal[rows]))
    for below in np.unique(other).tolist():
        here = (other == below) & (press > 0)
        tick = contacts.tick[rows[here]]
        if not len(tick):
            continue
        total = np.bincount(tick, press[here], count).astype(np.float64)
        known = np.flatnonzero(total > 0)
        mask = np.zeros(count, dtype=np.bool_)
        mask[known] = True
        point, up = (_means(tick, press[here], each[here], total)[known] for each in (contacts.point[rows], normal))
        base = log.poses[:, below]
        # What rolls beneath it does not take it along.
        turned = np.repeat(base[known[:1]], count, axis=0) if _rolls(base, up, known) else base
        stand = rotate_back(turned[known[0], 3:], observation.up)
        yield Standing(
            unit=unit,
            below=below,
            pressing=mask,
            touching=mask_of(debounce(mask, observation.dt, gap=FLICKER), count),
            upright=rotate_back(pose[:, 3:], rotate(turned[:, 3:], stand)),
            up=rotate_back(pose[:, 3:], observation.up),
            point=_held(rotate_back(pose[known, 3:], point - pose[known, :3]), known, count),
            point_below=_held(rotate_back(base[known, 3:], point - base[known, :3]), known, count),
            normal=_held(rotate_back(pose[known, 3:], up), known, count),
            centre=own_centre(log.things[unit]),
        )


def _rolls(base: FloatArray, normal: FloatArray, known: IntArray) -> bool:
    """Return whether a body rolls beneath what presses on it: it turns, and with it the place at which that presses.

    Args:
        base: Poses of the body, shape (T, 7).
        normal: Where that presses, in the world, shape (K, 3).
        known: When it does, shape (K,).
    """
    path = _norms(np.diff(rotate_back(base[known, 3:], normal), axis=0)).sum()
    turning = angle_between(base[known[:-1], 3:], base[known[1:], 3:]).sum()
    return bool(path > BENEATH * turning > 0.0)


def _means(tick: IntArray, weight: FloatArray, values: FloatArray, total: FloatArray) -> FloatArray:
    sums = [np.bincount(tick, weight * values[:, k], len(total)) for k in range(3)]
    return np.stack(sums, axis=1) / np.maximum(total, 1e-300)[:, None]


def _held(values: FloatArray, known: IntArray, count: int) -> FloatArray:
    """Return values at all ticks, where they are not known the last ones, shape (T, 3)."""
    which = np.maximum(np.searchsorted(known, np.arange(count), side="right") - 1, 0)
    return values[which]


def _change(values: FloatArray, before: int, after: int) -> FloatArray:
    """Return by how much values change from some ticks before each tick to some after it, shape (T, 3)."""
    now = np.arange(len(values))
    return values[np.minimum(now + after, len(now) - 1)] - values[np.maximum(now - before, 0)]


def _norms(vectors: FloatArray) -> FloatArray:
    return np.sqrt(np.einsum("...c,...c->...", vectors, vectors))

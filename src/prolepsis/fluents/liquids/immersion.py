"""``immersed(x, liquid)`` and ``floats(x, liquid)``: how much of a body is below the surface of what a vessel holds."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.intervals import debounce, mask_of, ticks_of
from prolepsis.fluents.liquids.particle_locations import Inside, ParticleLocations, particle_locations
from prolepsis.fluents.margins import NearMiss, margin_of, nearly
from prolepsis.fluents.observation import Observation, is_held_from_outside
from prolepsis.fluents.registry import fluent
from prolepsis.fluents.shapes_in_time import RigidShape, rigid_shapes
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.containment import fractions
from prolepsis.fluents.solids.touch import touches
from prolepsis.geometry.rotations import rotate
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.near import MARGIN, NEAR
from prolepsis.log.timeline import Fact

NOTICEABLE_SHARE = 0.1
"""Share of a body's volume [1] that is below the surface of what it is immersed in."""
BARELY, WHOLLY = 0.01, 0.97
"""Up to which share [1] a body only touches a liquid, and from which on nothing that can be told looks out."""
BORNE_SHARE = 0.5
"""Share of its weight [1] that a liquid bears of what floats in it; contacts may bear the rest."""
BOBBING_SPEED = 0.3
"""Vertical speed [m/s] up to which what a liquid bears floats; what falls in or is thrown out is faster."""
SPEED_WINDOW = 0.05
"""Time over which that speed is taken [s]."""
GAP, LEAST = 0.1, 0.1
"""Gap that is not noticed and shortest stretch of either [s]."""
LATTICE = 12
"""Points along the longest side of a body at which it is looked at."""
REACH = 2.0
"""How far round a body its liquid's surface is looked for [spacings]."""
SECTORS, WET_SECTORS = 8, 3
"""Directions in which that is done, and in how many of them there must be liquid."""
COMPANY = 2
"""So many particles must be close below one that is of the surface: a drop in the air has none."""

DIRECTIONS = 16
"""Directions across, in each of which a body is in a liquid as far as that reaches ..."""
BESIDE = 0.6
"""... and a little more [spacings]: to the wall it is half a spacing from the outermost particles."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Immersion:
    """One body in what one vessel holds of one liquid."""

    unit: int
    """The body."""
    vessel: int
    """Unit that holds the liquid."""
    stuff: int
    """The liquid."""
    share: FloatArray
    """Share of the body's volume below the surface [1], at each tick, shape (T,)."""


@fluent("immersed", "o1", "o2")
def immersed(observation: Observation) -> Iterator[Fact | NearMiss]:
    """At least a noticeable share of o1's volume is below the surface of the liquid o2 that a vessel holds."""
    for (unit, stuff), share in _shares(observation).items():
        what = ("fluent", "immersed", (observation.unit_names[unit], observation.unit_names[stuff]))
        ratio, least = share / NOTICEABLE_SHARE, ticks_of(LEAST, observation.dt)
        stretches = debounce(ratio >= 1.0, observation.dt, gap=GAP, least=LEAST)
        for start, end in stretches.tolist():
            evidence = {**fractions(share[start:end]), MARGIN: margin_of(ratio, start, end, least)}
            yield observation.fact(*what, (start, end), evidence)
        yield from nearly(observation, what, ratio, stretches, least)


@fluent("floats", "o1", "o2")
def floats(observation: Observation) -> Iterator[Fact | NearMiss]:
    """The liquid o2 bears at least half of o1's weight, and o1 looks out of it and neither sinks nor shoots up."""
    for (unit, stuff), share in _shares(observation).items():
        what = ("fluent", "floats", (observation.unit_names[unit], observation.unit_names[stuff]))
        borne = _borne_by_liquid(observation, unit)
        slow = (share > BARELY) & (_vertical_speed(observation, unit) < BOBBING_SPEED)
        ratio = np.where(slow & (share < WHOLLY), borne / BORNE_SHARE, 0.0)
        lightness, least = _lightness(observation, unit, stuff), ticks_of(LEAST, observation.dt)
        stretches = debounce(ratio >= 1.0, observation.dt, gap=GAP, least=LEAST)
        for start, end in stretches.tolist():
            evidence = {
                "share": float(borne[start:end].mean()),
                **fractions(share[start:end]),
                MARGIN: margin_of(np.minimum(ratio, np.maximum(lightness, 1.0)), start, end, least),
            }
            yield observation.fact(*what, (start, end), evidence)
        # What is about as dense as the liquid might as well have looked out.
        alike = slow & (share > WHOLLY) & (lightness <= 1 / (1 - NEAR))
        covered = np.minimum(np.minimum(borne / BORNE_SHARE, lightness), WHOLLY / np.maximum(share, WHOLLY))
        yield from nearly(observation, what, np.where(alike, covered, ratio), stretches, least)


def immersions(observation: Observation) -> tuple[Immersion, ...]:
    """Return how deep each loose body was in what each vessel holds, of those that ever were in any."""
    seen = observation.of(particle_locations)
    if seen is None:
        return ()
    found: list[Immersion] = []
    for inside in seen.inside:
        for shape in observation.of(rigid_shapes):
            unit = int(observation.unit[shape.body])
            if unit == inside.unit or not _may_be_immersed(observation, shape):
                continue
            for stuff, share in _submerged(observation, seen, inside, shape).items():
                if (share > BARELY).any():
                    series = np.where(shape.during, seen.at_ticks(share, observation.tick_count), 0.0)
                    found.append(Immersion(unit=unit, vessel=inside.unit, stuff=stuff, share=series))
    return tuple(found)


def _shares(observation: Observation) -> dict[tuple[int, int], FloatArray]:
    """Return the share of each body in each liquid, in whatever vessel."""
    found: dict[tuple[int, int], FloatArray] = {}
    for each in observation.of(immersions):
        key = each.unit, each.stuff
        found[key] = np.maximum(found[key], each.share) if key in found else each.share
    return found


def _may_be_immersed(observation: Observation, shape: RigidShape) -> bool:
    unit = int(observation.unit[shape.body])
    own = shape.body == unit and bool(shape.solids) and not observation.log.things[unit].fixed
    # A fragment of a shell is thinner than a particle.
    outside = is_held_from_outside(observation, unit) or observation.has_role(unit, "Mounted", "Piece", "Blob")
    return own and not outside and not is_stuff(observation, unit)


def _submerged(
    observation: Observation, seen: ParticleLocations, inside: Inside, shape: RigidShape
) -> dict[int, FloatArray]:
    """Return the share of a body's volume in each liquid of a vessel, in each frame, shape (F,)."""
    particles, up = seen.particles, observation.up
    pose = observation.log.poses[particles.tick, shape.body]
    points = lattice(shape)
    middle = points.mean(axis=0)
    centre = pose[:, :3] + rotate(pose[:, 3:], middle)
    reach = float(np.linalg.norm(points - middle, axis=1).max()) + REACH * particles.spacing
    away = particles.position - centre[:, None].astype(np.float32)
    close = inside.pool & (np.einsum("fpc,fpc->fp", away, away) < reach**2)
    found: dict[int, FloatArray] = {}
    for frame in np.flatnonzero(close.any(axis=1)).tolist():
        matter = rotate(pose[frame, 3:], points - middle)
        chosen = inside.pool[frame]
        share, near = _below_surface(away[frame, chosen].astype(np.float64), matter, up, particles.spacing)
        if share > 0.0:
            stuffs, counts = np.unique(particles.stuff[chosen][near], return_counts=True)
            for stuff, count in zip(stuffs.tolist(), counts.tolist(), strict=True):
                series = found.setdefault(stuff, np.zeros(len(particles.tick)))
                series[frame] = share * count / len(particles.stuff[chosen][near])
    return found


def _below_surface(liquid: FloatArray, matter: FloatArray, up: FloatArray, spacing: float) -> tuple[float, IntArray]:
    """Return the share of a body's points below the surface of the liquid round it, and which particles tell so.

    Args:
        liquid: Particles relative to the body's middle [m], shape (n, 3).
        matter: Points of the body relative to its middle [m], shape (m, 3).
        up: Unit vector against gravity, shape (3,).
        spacing: [m].
    """
    across, height = matter - np.outer(matter @ up, up), matter @ up
    wide = float(np.linalg.norm(across, axis=1).max()) + REACH * spacing
    level = liquid @ up
    flat = liquid - np.outer(level, up)
    ring = np.flatnonzero((np.einsum("nc,nc->n", flat, flat) < wide * wide) & (level > height.min() - spacing))
    e1 = np.cross(up, [1.0, 0.0, 0.0] if abs(up[0]) < 0.5 else [0.0, 1.0, 0.0])
    angle = np.arctan2(flat[ring] @ np.cross(up, e1), flat[ring] @ e1)
    sector = np.minimum(((angle + math.pi) / (2 * math.pi) * SECTORS).astype(np.int64), SECTORS - 1)
    tops: list[float] = []
    for k in range(SECTORS):
        heights = np.sort(level[ring][sector == k])[::-1]
        for i in range(len(heights) - COMPANY):
            if heights[i] - heights[i + COMPANY] < REACH * spacing:
                tops.append(float(heights[i]))
                break
    if len(tops) < WET_SECTORS:
        return 0.0, ring
    surface = float(np.median(tops)) + spacing / 2
    return float(((height < surface) & _within(liquid, matter, up, spacing)).mean()), ring


def _within(liquid: FloatArray, matter: FloatArray, up: FloatArray, spacing: float) -> BoolArray:
    """Return which points of a body are where the liquid is, not under or round its vessel, shape (m,)."""
    e1 = np.cross(up, [1.0, 0.0, 0.0] if abs(up[0]) < 0.5 else [0.0, 1.0, 0.0])
    angles = np.arange(DIRECTIONS) * 2 * math.pi / DIRECTIONS
    directions = np.vstack([np.outer(np.cos(angles), e1) + np.outer(np.sin(angles), np.cross(up, e1)), -up])
    return (matter @ directions.T <= (liquid @ directions.T).max(axis=0) + BESIDE * spacing).all(axis=1)


def lattice(shape: RigidShape) -> FloatArray:
    """Return points spread evenly through a body, in its frame, shape (n, 3)."""
    points, within = _points(shape)
    return points[within] if within.any() else np.array([solid.corners.mean(axis=0) for solid in shape.solids])


def _points(shape: RigidShape) -> tuple[FloatArray, BoolArray]:
    """Return points spread evenly through the box round a body, shape (n, 3), and which are in the body, shape (n,)."""
    low, high = shape.bounds()
    wide = high - low
    counts = [max(1, round(LATTICE * float(each / wide.max()))) for each in wide]
    axes = [low[c] + wide[c] * (np.arange(counts[c]) + 0.5) / counts[c] for c in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return points, np.min([solid.distance(points) for solid in shape.solids], axis=0) < 0.0


def _borne_by_liquid(observation: Observation, unit: int) -> FloatArray:
    """Return the share of a body's weight that no contact bears [1], shape (T,)."""
    lifted = np.zeros(observation.tick_count)
    for touch in observation.of(touches):
        if unit in (touch.a, touch.b):
            lifted[touch.tick] += touch.lifts_b if unit == touch.b else -touch.lifts_b
    weight = np.maximum(observation.mass(unit) * observation.gravity, 1e-12)
    share: FloatArray = np.clip(1.0 - np.abs(lifted) / weight, 0.0, 1.0)
    return share


def _lightness(observation: Observation, unit: int, stuff: int) -> FloatArray:
    """Return the density of a liquid over that of a body [1], shape (T,); infinite for what may hold air."""
    particles = observation.log.particles
    own = particles.stuff == stuff
    density = float(particles.mass[own].sum() / max(particles.volume[own].sum(), 1e-12))
    found = np.full(observation.tick_count, np.inf)
    for shape in observation.of(rigid_shapes):
        if shape.body == unit and shape.solids and not shape.is_hollow:
            low, high = shape.bounds()
            displaced = float(np.prod(high - low) * _points(shape)[1].mean()) * density
            found = np.where(shape.during, displaced / np.maximum(observation.mass(unit), 1e-12), found)
    return found


def _vertical_speed(observation: Observation, unit: int) -> FloatArray:
    half = ticks_of(SPEED_WINDOW / 2, observation.dt)
    height = observation.log.poses[:, unit, :3] @ observation.up
    ticks = np.arange(len(height))
    first, last = np.maximum(ticks - half, 0), np.minimum(ticks + half, len(height) - 1)
    speed: FloatArray = np.abs(height[last] - height[first]) / np.maximum((last - first) * observation.dt, 1e-12)
    return speed


def immersed_in(observation: Observation, vessel: int) -> dict[int, BoolArray]:
    """Return when bodies are immersed in what a vessel holds, by unit, shape (T,) each."""
    found: dict[int, BoolArray] = {}
    for each in observation.of(immersions):
        if each.vessel == vessel:
            stretches = debounce(each.share >= NOTICEABLE_SHARE, observation.dt, gap=GAP, least=LEAST)
            mask = mask_of(stretches, observation.tick_count)
            found[each.unit] = found[each.unit] | mask if each.unit in found else mask
    return found

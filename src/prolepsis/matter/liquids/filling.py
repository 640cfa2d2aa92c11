"""Filling: each liquid becomes a pool of particles, in a container, on a surface, or soaked up by a sponge."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from prolepsis.geometry.hollows import Basin, space_of
from prolepsis.geometry.packing import lattice, lowest, relaxed
from prolepsis.geometry.rotations import rotated
from prolepsis.geometry.shape import FloatArray, Geom, Shape
from prolepsis.geometry.signed_distance import shifted
from prolepsis.log.things import Thing
from prolepsis.matter.liquids.liquids import Placement
from prolepsis.matter.liquids.region import Region, box_of
from prolepsis.scenario.scenario import FEWEST_PARTICLES, MOST_PARTICLES
from prolepsis.scene.extent import place_on
from prolepsis.scene.kind import RestingHeight
from prolepsis.scene.posed import Posed, nearest, posed
from prolepsis.scene.scene import Pool
from prolepsis.terms.errors import KnowledgeError

FULL = 1.002
"""Volume over capacity [1] up to which rounding may go."""
GRAVITY = 9.81
"""[m/s^2], for how thick a puddle is."""
UP = np.array([0.0, 0.0, 1.0])
"""Direction against gravity."""
UNEVEN = 0.25
"""How far from the spacing the ground under a puddle may lie [spacings]."""


def fill(
    liquids: Sequence[Thing],
    placements: Mapping[str, Placement],
    solids: Mapping[str, tuple[Thing, ...]],
    resting_height: RestingHeight,
    particles: int,
) -> tuple[tuple[Thing, ...], tuple[Pool, ...]]:
    """Return the liquids with their masses and positions, and a pool for each.

    Args:
        liquids: What flows, with density and volume, or the fill of its container.
        placements: Where each of them is.
        solids: The bodies of each whole, at their poses.
        resting_height: Finds where a thing rests.
        particles: Number of particles of the largest liquid.

    Raises:
        KnowledgeError: If one does not fit where it is, or there are too many or too few particles.
    """
    if not liquids:
        return (), ()
    basins: dict[str, tuple[Posed, Basin]] = {}
    for name in sorted({placement.host for placement in placements.values() if placement.relation == "contains"}):
        basins[name] = basin_of(name, solids[name])
    volumes = {each.name: _volume(each, placements[each.name], basins) for each in liquids}
    for host, (container, basin) in basins.items():
        inside = [each for each in liquids if placements[each.name] == Placement(relation="contains", host=host)]
        volumes |= _fills(container, basin, solids[host][0], inside, volumes)
    spacing = (max(volumes.values()) / particles) ** (1 / 3)
    counts = {name: round(volume / spacing**3) for name, volume in volumes.items()}
    _refuse_counts(counts, particles)
    matter = tuple(posed(thing) for each in solids.values() for thing in each if thing.shape.geoms)
    found: dict[str, FloatArray] = {}
    for host, (container, basin) in basins.items():
        inside = [each for each in liquids if placements[each.name] == Placement(relation="contains", host=host)]
        found |= _poured(container, basin, inside, volumes, counts, spacing, matter)
    for each in liquids:
        placement = placements[each.name]
        if placement.relation == "on":
            found[each.name] = _puddle(
                each, solids[placement.host], volumes[each.name], counts[each.name], spacing, matter, resting_height
            )
        elif placement.relation == "absorbs":
            found[each.name] = _soaked(each, solids[placement.host], counts[each.name])
    made = tuple(_settled(each, volumes[each.name], found[each.name]) for each in liquids)
    pools = tuple(
        Pool(
            stuff=each.name,
            position=found[each.name],
            spacing=spacing,
            holder=placements[each.name].host if placements[each.name].relation == "absorbs" else None,
        )
        for each in liquids
    )
    return made, pools


def _settled(liquid: Thing, volume: float, points: FloatArray) -> Thing:
    x, y, z = (float(v) for v in points.mean(axis=0))
    mass = liquid.quantities["density"] * volume
    return replace(
        liquid, position=(x, y, z), mass=mass, quantities={**liquid.quantities, "volume": volume, "mass": mass}
    )


def _refuse_counts(counts: Mapping[str, int], particles: int) -> None:
    total = sum(counts.values())
    if total > MOST_PARTICLES:
        raise KnowledgeError(
            f"particles = {particles} makes {total} particles of all liquids; allowed: at most {MOST_PARTICLES}"
        )
    fewest = min(counts, key=lambda name: counts[name])
    if counts[fewest] < FEWEST_PARTICLES:
        enough = math.ceil(particles * FEWEST_PARTICLES / max(counts[fewest], 0.5))
        raise KnowledgeError(
            f"{fewest} would be {counts[fewest]} particles at particles = {particles}, which are those of the largest "
            f"liquid; allowed: at least {FEWEST_PARTICLES}, here from particles = {enough} on"
        )


def basin_of(name: str, bodies: tuple[Thing, ...]) -> tuple[Posed, Basin]:
    """Return a container as it stands, its holes stopped, and its basin.

    Raises:
        KnowledgeError: If it has none.
    """
    if bodies and bodies[0].shape.geoms:
        whole = replace(bodies[0], shape=replace(bodies[0].shape, holes=()))
        container = posed(whole)
        basin = _basin(container, whole, UP)
        if basin is not None:
            return container, basin
    raise KnowledgeError(
        f"{name} contains a liquid at the start, but as it stands it has no cavity that would hold any"
    )


def _basin(container: Posed, thing: Thing, up: FloatArray) -> Basin | None:
    solids = shifted(container.field.solids, np.array([*thing.position, *thing.orientation]))
    return space_of(solids, container.low, container.high).basin(up)


def _fills(
    container: Posed, basin: Basin, vessel: Thing, liquids: Sequence[Thing], volumes: Mapping[str, float]
) -> dict[str, float]:
    """Return the volumes [m^3] of liquids that follow from their fill, as shares of what the vessel holds upright.

    Its ``capacity`` is that of an ideal outline, which may be more than fits between its walls. Whether it is does not
    hang on the fill, so that more of it is always more.
    """
    capacity = vessel.quantities.get("capacity", 0.0)
    filling = {each.name: each.quantities.get("fill", 0.0) for each in liquids}
    filling = {name: share for name, share in filling.items() if volumes[name] == share * capacity > 0.0}
    if not filling:
        return {}
    up = rotated(vessel.orientation, (0.0, 0.0, 1.0))
    upright = basin if np.allclose(up, UP) else _basin(container, vessel, up)
    if upright is None or FULL * upright.capacity >= capacity:
        return {}
    return {name: share * upright.capacity for name, share in filling.items()}


def _volume(liquid: Thing, placement: Placement, basins: Mapping[str, tuple[Posed, Basin]]) -> float:
    """Return the volume of a liquid [m^3]."""
    known = liquid.quantities.get("volume")
    if known is None and "fill" in liquid.quantities and placement.relation == "contains":
        known = liquid.quantities["fill"] * basins[placement.host][1].capacity
    if known is None:
        raise KnowledgeError(f"{liquid.name} ({liquid.kind}) has no volume; state :volume, :mass or :fill")
    if "density" not in liquid.quantities:
        raise KnowledgeError(f"{liquid.name} ({liquid.kind}) has no density; state :density")
    if "viscosity" not in liquid.quantities:
        raise KnowledgeError(f"{liquid.name} ({liquid.kind}) has no viscosity; state :viscosity")
    return known


def _poured(
    container: Posed,
    basin: Basin,
    liquids: Sequence[Thing],
    volumes: Mapping[str, float],
    counts: Mapping[str, int],
    spacing: float,
    matter: tuple[Posed, ...],
) -> dict[str, FloatArray]:
    """Return the particles of all liquids in one container, the densest at the bottom."""
    ordered = sorted(liquids, key=lambda each: (-each.quantities["density"], each.name))
    names = " and ".join(each.name for each in ordered)
    host, volume, capacity = container.name, sum(volumes[each.name] for each in ordered), basin.capacity
    if volume > FULL * capacity:
        raise KnowledgeError(
            f"{names}: {1e6 * volume:.4g} ml are to be in {host}, which holds {1e6 * capacity:.4g} ml as it stands"
        )
    level = basin.level(volume)
    region = Region.of(container, basin, matter, spacing, level)
    count = sum(counts[each.name] for each in ordered)
    points = lowest(region.admits, *box_of(region, basin), count, spacing)
    if points is None:
        raise KnowledgeError(
            f"{names}: the cavity of {host} is too narrow for {count} particles {1e3 * spacing:.2g} mm apart; "
            f"allowed: more particles"
        )
    points = relaxed(points, spacing, region.confine)
    points = points[np.argsort(points[:, 2], kind="stable")]
    found: dict[str, FloatArray] = {}
    start = 0
    for each in ordered:
        found[each.name] = points[start : start + counts[each.name]]
        start += counts[each.name]
    return found


def _puddle(
    liquid: Thing,
    under: tuple[Thing, ...],
    volume: float,
    count: int,
    spacing: float,
    matter: tuple[Posed, ...],
    resting_height: RestingHeight,
) -> FloatArray:
    """Return the particles of a puddle as thick as its surface tension makes it, but no thinner than one layer."""
    q = liquid.quantities
    x, y = place_on(liquid, [under])
    drop = Thing(
        name=liquid.name,
        kind=liquid.kind,
        shape=Shape(geoms=(Geom(type="sphere", size=(spacing / 2, 0.0, 0.0)),)),
        position=(x, y, 0.0),
    )
    ground = resting_height(drop, [thing for thing in under if thing.shape.geoms])
    length = math.sqrt(q.get("surfaceTension", 0.0) / (q["density"] * GRAVITY))
    thickness = 2 * length * math.sin(q.get("contactAngle", math.pi / 2) / 2)
    layers = max(round(thickness / spacing), 1)
    across = math.ceil(math.sqrt(2 * count / layers)) + 2
    half = across * spacing / 2
    region = Region(matter=matter, clearance=0.5 * spacing - UNEVEN * spacing, level=math.inf)
    low = np.array([x - half, y - half, ground])
    points = lattice(low, np.array([x + half, y + half, ground + (layers - 0.5) * spacing]), spacing)
    points = points[region.admits(points)]
    order = np.argsort(np.hypot(points[:, 0] - x, points[:, 1] - y), kind="stable")[:count]
    chosen = points[order]
    bottom = chosen[chosen[:, 2] < ground + 0.5 * spacing]
    support = nearest([posed(thing) for thing in under if thing.shape.geoms], bottom)
    if len(chosen) < count or (np.abs(support - 0.5 * spacing) > UNEVEN * spacing).any():
        area = 1e4 * volume / (layers * spacing)
        raise KnowledgeError(
            f"{liquid.name}: {1e6 * volume:.4g} ml would be a puddle of {area:.3g} cm^2 at x = {x:g}, y = {y:g}, where "
            f"{under[0].whole or under[0].name} is not level so far; allowed: on a level surface, or :contains"
        )
    return chosen


def _soaked(liquid: Thing, sponge: tuple[Thing, ...], count: int) -> FloatArray:
    """Return particles spread evenly through a sponge."""
    matter = posed(sponge[0])
    step = float(np.prod(matter.high - matter.low) / count) ** (1 / 3)
    while True:
        # Of a thin sheet one layer in the middle, until the lattice is finer.
        points = lattice(matter.low + np.minimum(step, matter.high - matter.low) / 2, matter.high, step)
        points = points[matter.distance(points) < 0]
        if len(points) >= count:
            # Every so many, so that no corner is left dry.
            return points[np.linspace(0, len(points) - 1, count).round().astype(np.int64)]
        step *= 0.97

"""The world file: the world as MJCF, and in it what each whole is made of, for the eye.

A whole that may fall apart is one body until it does, and what flows is no body at all. So the file shows the pieces
of each whole, the bonds between them and what is inside, too: as solids without mass that touch nothing, and as sites,
in groups that a viewer leaves out until they are switched on. Comments tell what each thing is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from prolepsis.engine.world import World, add_geom, seen_from
from prolepsis.geometry.rotations import inverse, matrix
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.things import Thing
from prolepsis.scene.parts import Bonds
from prolepsis.scene.scene import Pool, Scene
from prolepsis.system.mujoco import mujoco

WHOLES, PIECES, CONTENTS = 1, 4, 5
"""Groups: solids that hide what they are made of (shown at first), pieces with their bonds, what is inside (hidden)."""
SLENDER = 10.0
"""Width of a bond over the radius with which it is shown [1]."""
BOND_COLOUR = (0.85, 0.2, 0.1, 1.0)
MOST_SHOWN = 1000
"""Particles of a pool that are shown; of more, every so many, each as large as what it stands for."""
LEGEND = (
    f"Geom and site group {PIECES}: pieces of wholes and the bonds between them; group {CONTENTS}: what is inside. "
    f"They are hidden at first, have no mass and touch nothing. Geom group {WHOLES}: wholes. Numbers are in SI units."
)


def world_file(world: World) -> str:
    """Return the world file (MJCF) at the start: without what is only shown, it is what is simulated."""
    scene, spec = world.scene, world.spec.copy()
    joined = {name for bonds in scene.each(Bonds) for pair in bonds.pairs for name in pair}
    for thing in scene.things:
        carrier = _carrier(scene, thing.name)
        if thing.emerges and carrier is not None:
            for geom in spec.body(carrier.name).geoms:
                if geom.contype or geom.conaffinity:
                    geom.group = WHOLES
            _show(spec, thing, carrier, PIECES if thing.name in joined else CONTENTS, world.grippiest)
    for bonds in scene.each(Bonds):
        _show_bonds(spec, scene, bonds)
    for pool in scene.pools:
        _show_pool(spec, scene, pool)
    spec.compile()
    return _commented(spec.to_xml(), _told(scene))


def _carrier(scene: Scene, name: str | None) -> Thing | None:
    """Return the body that a thing moves with at the start, if any."""
    while name is not None:
        thing = scene.thing(name)
        if thing.is_body:
            return thing
        name = thing.whole
    return None


def _show(spec: Any, thing: Thing, carrier: Thing, group: int, grippiest: float) -> None:
    """Show the solids of what becomes a body only later, with the surface that they then have."""
    position, orientation = seen_from(carrier, thing)
    frame = spec.body(carrier.name).add_frame(pos=list(position), quat=list(orientation))
    for k in range(len(thing.shape.geoms)):
        made = add_geom(spec, frame, thing, k, grippiest, mass=0.0)
        made.contype, made.conaffinity, made.group = 0, 0, group


def _show_bonds(spec: Any, scene: Scene, bonds: Bonds) -> None:
    """Show each bond as a rod from the middle of one piece to that of the other, the thicker the wider it is."""
    carrier = _carrier(scene, bonds.whole)
    if carrier is None:
        return
    body = spec.body(carrier.name)
    for (first, second), width in zip(bonds.pairs, bonds.widths, strict=True):
        ends = [np.asarray(seen_from(carrier, scene.thing(name))[0]) for name in (first, second)]
        body.add_site(
            name=f"{first}:{second}",
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=np.concatenate(ends).tolist(),
            size=[width / SLENDER, 0.0, 0.0],
            rgba=list(BOND_COLOUR),
            group=PIECES,
        )


def _show_pool(spec: Any, scene: Scene, pool: Pool) -> None:
    """Show the particles of a liquid as balls that move with what it is in."""
    step = -(-len(pool.position) // MOST_SHOWN)
    radius = pool.spacing / 2 * step ** (1 / 3)
    colour = scene.thing(pool.stuff).shape.colour
    vessel = pool.holder or _vessel(scene, pool.stuff)
    carrier = _carrier(scene, vessel)
    body = spec.worldbody if carrier is None else spec.body(carrier.name)
    for k, point in enumerate(_seen_from(carrier, pool.position)[::step]):
        name = f"{pool.stuff}/{k * step}"
        body.add_site(name=name, pos=point.tolist(), size=[radius, 0.0, 0.0], rgba=list(colour), group=CONTENTS)


def _vessel(scene: Scene, stuff: str) -> str | None:
    """Return what contains a stuff, as the situation tells, if anything."""
    known = (vessel for relation, vessel, inside in scene.domain.relations if (relation, inside) == ("contains", stuff))
    return next(known, None)


def _seen_from(carrier: Thing | None, points: FloatArray) -> FloatArray:
    """Return points of the world in the frame of a body, shape (n, 3)."""
    if carrier is None:
        return points
    return (points - np.asarray(carrier.position)) @ matrix(inverse(carrier.orientation)).T


def _told(scene: Scene) -> dict[str, list[str]]:
    """Return what is told of each body, in lines: its class and quantities, and those of what it consists of."""
    bonds = {each.whole: each for each in scene.each(Bonds)}
    shown = {name for each in bonds.values() for pair in each.pairs for name in pair}
    pools = {pool.stuff: pool for pool in scene.pools}
    told: dict[str, list[str]] = {}
    for thing in scene.things:
        carrier = thing if thing.is_body else _carrier(scene, thing.whole or _vessel(scene, thing.name))
        if carrier is None or thing.name in shown:
            continue
        what = f"{thing.name}: {thing.kind}"
        if carrier is not thing:
            what += f" in {carrier.name}"
        if thing.name in pools:
            what += f", {len(pools[thing.name].position)} particles"
        made_of = [each for each in scene.parts(thing.name) if each.name in shown]
        if made_of:
            masses = " to ".join(dict.fromkeys(f"{f([each.mass for each in made_of]):.3g}" for f in (min, max)))
            what += f", {len(made_of)} pieces of {masses} kg"
        if thing.name in bonds:
            what += f", {len(bonds[thing.name].pairs)} bonds"
        known = {"mass": thing.mass, **thing.quantities} if thing.mass else dict(thing.quantities)
        numbers = ", ".join(f"{name} {value:.6g}" for name, value in sorted(known.items()))
        told.setdefault(carrier.name, []).append(f"{what}; {numbers}" if numbers else what)
    return told


def _commented(text: str, told: Mapping[str, list[str]]) -> str:
    """Return MJCF with a legend, and what is told of each body above it."""
    lines: list[str] = []
    for line in text.splitlines():
        opened = re.match(r'( *)<body name="([^"]*)"', line)
        if opened is not None:
            lines += [f"{opened[1]}{_comment(each)}" for each in told.get(opened[2], ())]
        lines.append(line)
        if line.startswith("<mujoco"):
            lines.append(f"  {_comment(LEGEND)}")
    return "\n".join(lines) + "\n"


def _comment(text: str) -> str:
    """Return an XML comment; two hyphens would end it, and names may have them."""
    return f"<!-- {re.sub('-(?=-)', '- ', text)} -->"

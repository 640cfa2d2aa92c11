"""The parts of what has a breakable ellipsoidal shell: the shell and its shards, what flows inside, a firm kernel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from prolepsis.geometry.packing import lattice
from prolepsis.geometry.rotations import matrix, rotated
from prolepsis.geometry.shape import FloatArray, Geom, Patch, Shape, Triple, triple
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.things import WITHIN, Thing
from prolepsis.matter.shells.cutting import CutShell, curvature_radius, ellipsoid_shell
from prolepsis.scene.colours import colour_of
from prolepsis.scene.kind import Individuals, Made
from prolepsis.scene.parts import Bonds, Kernel, Shard
from prolepsis.scene.scene import Pool
from prolepsis.terms.errors import KnowledgeError

SLENDEREST, FLATTEST = 0.5, 2.0
"""Least and greatest breadth over length of a shell that is cut into pieces [1]."""
THICKEST = 0.25
"""Greatest thickness of a shell over its least half width [1]; a chocolate drop's is a seventh."""
NEEDED = (
    "breakingForce",
    "shellThickness",
    "youngsModulus",
    "poissonRatio",
    "fractureStrain",
    "plateStiffness",
    "poleStiffnessRatio",
    "crackTipWeakening",
    "crackedForceShare",
    "crackReliefShare",
    "pieceCount",
    "friction",
)
"""What must be known of a shell."""
STUFFS = ("EggYolk", "EggWhite", "Liquid")
"""What flows out of a shell, from the middle outwards."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Shell:
    """The shell of a whole, and what it falls apart into."""

    whole: str
    """The thing that has it."""
    name: str
    """The thing that it is."""
    shards: tuple[str, ...]
    """Its pieces."""
    kernels: tuple[str, ...]
    """What is firm inside and comes free."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Membraned:
    """A stuff that a membrane holds together."""

    name: str
    """The stuff."""
    force: float
    """Force at which a probe punctures the membrane [N]."""
    probe_radius: float
    """Radius of that probe [m]."""


def shelled(individuals: Individuals, whole: Thing) -> Made:
    """Return a whole with a shell and its parts.

    Args:
        individuals: The individuals of the situation.
        whole: The whole at its place, an ellipsoid.

    Raises:
        KnowledgeError: If it cannot be simulated.
    """
    kb = individuals.kb
    shells = [part for part in kb.parts(whole.name) if kb.is_a(part, "Shell")]
    if len(shells) != 1:
        raise KnowledgeError(f"{whole.name} has {len(shells)} shells, needed: 1")
    if len(whole.shape.geoms) != 1 or whole.shape.geoms[0].type != "ellipsoid":
        raise KnowledgeError(f"{whole.name} has a shell, so its shape must be ellipsoid")
    half_length, _, half_breadth = whole.shape.geoms[0].size
    if not SLENDEREST <= half_breadth / half_length <= FLATTEST:
        size = f"{2 * half_length:g} m long and {2 * half_breadth:g} m broad"
        allowed = f"{SLENDEREST:g} to {FLATTEST:g} times the length"
        raise KnowledgeError(f"{whole.name} is {size}; allowed: a breadth of {allowed}")
    if "BrokenThing" in kb.classes(whole.name):
        raise KnowledgeError(f"{whole.name} is broken at the start; only whole ones can be simulated")
    parts = [_part(kb, part, whole, individuals.roles(part)) for part in kb.parts(whole.name)]
    shell = next(part for part in parts if part.name == shells[0])
    for needed in NEEDED:
        if needed not in shell.quantities:
            raise KnowledgeError(f"{shell.name} ({shell.kind}) has no {needed}; state it")
    thickness, thickest = shell.quantities["shellThickness"], THICKEST * min(half_length, half_breadth)
    if thickness > thickest:
        raise KnowledgeError(
            f"{kb.location(shell.name)}: {shell.name} ({shell.kind}): shellThickness = {thickness:g} m: allowed: at "
            f"most {thickest:.3g} m, a quarter of the least half width of {whole.name}; a thicker wall is no shell"
        )
    inside = [part for part in parts if part is not shell]
    stuffs = [
        replace(part, shape=Shape(colour=colour_of(kb, part.name)))
        for cls in STUFFS
        for part in inside
        if next((known for known in STUFFS if kb.is_a(part.name, known)), None) == cls
    ]
    kernels = [_kernel(kb, part, whole, shell) for part in inside if kb.is_a(part.name, "Kernel")]
    if len(kernels) > 1 or (kernels and stuffs):
        names = ", ".join(part.name for part in (*kernels, *stuffs))
        raise KnowledgeError(f"{whole.name} has {names} inside; allowed: liquids, or one kernel")
    # What touches the world is the shell, so the whole is as slippery as that.
    slippery = replace(whole, quantities={**whole.quantities, "friction": shell.quantities["friction"]})
    shards, areas = shell_pieces(slippery, shell)
    cut = shell_of(slippery, shell)
    bonds = Bonds(
        whole=shell.name,
        pairs=tuple((shards[int(bond[0])].name, shards[int(bond[1])].name) for bond in cut.bonds),
        widths=tuple(float(width) for width in cut.widths),
    )
    known = Shell(
        whole=whole.name,
        name=shell.name,
        shards=tuple(shard.name for shard in shards),
        kernels=tuple(kernel.name for kernel in kernels),
    )
    firm = [
        Kernel(name=kernel.name, whole=whole.name, adhesion=kernel.quantities.get("adhesionStrength", 0.0))
        for kernel in kernels
    ]
    membranes = [_membrane(kb, stuff) for stuff in stuffs if kb.is_a(stuff.name, "Membraned")]
    return Made(things=(slippery, shell, *stuffs, *kernels, *shards), parts=(known, bonds, *areas, *firm, *membranes))


def _membrane(kb: KnowledgeBase, stuff: Thing) -> Membraned:
    force, radius = (kb.number(stuff.name, needed) for needed in ("membraneForce", "probeRadius"))
    if force is None or radius is None:
        where = f"{kb.location(stuff.name)}: {stuff.name} ({stuff.kind})"
        raise KnowledgeError(f"{where} has a membrane; state its membraneForce and the probeRadius")
    return Membraned(name=stuff.name, force=force, probe_radius=radius)


def _part(kb: KnowledgeBase, name: str, whole: Thing, roles: frozenset[str]) -> Thing:
    quantities = {p: float(k.value) for p, k in kb.quantities(name).items() if isinstance(k.value, float)}
    return Thing(
        name=name,
        kind=kb.kind(name),
        position=whole.position,
        orientation=whole.orientation,
        mass=quantities.get("mass", 0.0),
        whole=whole.name,
        mount=WITHIN,
        roles=roles - {"Breakable", "Container"},
        quantities=quantities,
    )


def _kernel(kb: KnowledgeBase, part: Thing, whole: Thing, shell: Thing) -> Thing:
    """Return the kernel: hidden in the shell as its pieces are, and drawn in by what the flat pieces take up."""
    a, b, c = (float(v) for v in room_within(whole, shell) * np.asarray(whole.shape.geoms[0].size))
    shape = Shape(geoms=(Geom(type="ellipsoid", size=(a, b, c)),), colour=colour_of(kb, part.name))
    return replace(part, shape=shape, roles=part.roles | {"Piece"})


CLEARANCE = 0.99
"""Size of what is firm inside a shell over the room that the pieces leave [1]."""


def shell_of(egg: Thing, shell: Thing) -> CutShell:
    """Return the shell of an egg, cut into as many pieces as it may fall into."""
    a, b, c = egg.shape.geoms[0].size
    return ellipsoid_shell((a, b, c), round(shell.quantities["pieceCount"]), shell.quantities["shellThickness"])


def room_within(egg: Thing, shell: Thing) -> float:
    """Return the size of an ellipsoid of the egg's form that touches no piece of its shell, over the egg's [1]."""
    cut = shell_of(egg, shell)
    room = 1.0
    for centre, normal, outline in zip(cut.centres, cut.normals, cut.outlines, strict=True):
        # The inner face of a convex piece is flat: it lies as deep as its corners.
        outside = float(centre @ normal)
        room = min(room, (outside + float((outline @ normal).min())) / outside)
    return CLEARANCE * room


def shell_pieces(egg: Thing, shell: Thing) -> tuple[tuple[Thing, ...], tuple[Shard, ...]]:
    """Return the pieces of an egg's shell as things, with their share of its mass, and what they are."""
    parts = shell_of(egg, shell)
    made: list[Thing] = []
    shards: list[Shard] = []
    for k, (centre, outline, area) in enumerate(zip(parts.centres, parts.outlines, parts.areas, strict=True)):
        vertices = tuple((float(x), float(y), float(z)) for x, y, z in outline)
        made.append(
            Thing(
                name=f"{shell.name}/piece{k}",
                kind=f"{shell.kind}Piece",
                shape=Shape(
                    geoms=(Geom(type="mesh", vertices=vertices),),
                    patch=_patch(egg, shell, parts, k),
                    colour=egg.shape.colour,
                ),
                position=_world_position(egg, centre),
                orientation=egg.orientation,
                mass=float(shell.mass * area / parts.areas.sum()),
                whole=shell.name,
                mount=WITHIN,
                roles=frozenset({"Piece"}),
                quantities={"friction": shell.quantities["friction"]},
            )
        )
        radius = curvature_radius(np.asarray(egg.shape.geoms[0].size), centre)
        shards.append(Shard(name=made[-1].name, whole=egg.name, area=float(area), radius=radius))
    return tuple(made), tuple(shards)


def _patch(egg: Thing, shell: Thing, cut: CutShell, number: int) -> Patch:
    thickness = shell.quantities["shellThickness"]
    beside = cut.bonds[(cut.bonds == number).any(axis=1)].sum(axis=1) - number
    return Patch(
        semi_axes=triple(np.asarray(egg.shape.geoms[0].size) - thickness / 2),
        thickness=thickness,
        middle=triple(-cut.centres[number]),
        neighbours=tuple(triple(cut.centres[k] - cut.centres[number]) for k in beside.tolist()),
    )


def _world_position(egg: Thing, offset: FloatArray) -> Triple:
    x, y, z = np.asarray(egg.position) + rotated(egg.orientation, (offset[0], offset[1], offset[2]))
    return (float(x), float(y), float(z))


PARTICLES = 400
"""Particles of an egg in a scene without another liquid: some 5 mm apart."""
CLOSEST = 0.7
"""Least distance of particles over the spacing [1]: more than an egg holds is refused."""
FINER = 0.98
"""Step by which the lattice is made finer [1]."""
ROOMY = 2.0
"""The lattice is first looked for near the middle, where there is room for the cube of this times four as many points
[1]: one of a whole shell that is nearly empty would fill the memory."""


def egg_pools(
    egg: Thing, stuffs: Sequence[Thing], spacing: float | None, particles: int = PARTICLES
) -> tuple[tuple[Thing, ...], tuple[Pool, ...]]:
    """Return the stuffs of an egg with their volumes, and their particles.

    Args:
        egg: The egg at its place.
        stuffs: What is inside, from the middle outwards.
        spacing: That of the other liquids of the scene [m], if there are any.
        particles: Else the number of particles of this egg.

    Raises:
        KnowledgeError: If there is more than the egg holds.
    """
    if not stuffs:
        return (), ()
    volumes = [stuff.mass / stuff.quantities["density"] for stuff in stuffs]
    apart = float(np.cbrt(sum(volumes) / particles)) if spacing is None else spacing
    counts = [max(round(volume / apart**3), 1) for volume in volumes]
    points = _packed(np.asarray(egg.shape.geoms[0].size), sum(counts), apart)
    if points is None:
        raise KnowledgeError(
            f"{egg.name} is too small for {1e6 * sum(volumes):.3g} ml of {' and '.join(stuff.name for stuff in stuffs)}"
        )
    world = np.asarray(egg.position) + points @ matrix(np.asarray(egg.orientation)).T
    made: list[Thing] = []
    pools: list[Pool] = []
    start = 0
    for stuff, volume, count in zip(stuffs, volumes, counts, strict=True):
        made.append(replace(stuff, quantities={**stuff.quantities, "volume": volume}))
        chosen = world[start : start + count]
        pools.append(Pool(stuff=stuff.name, position=chosen, spacing=apart, holder=egg.name))
        start += count
    return tuple(made), tuple(pools)


def _packed(semi_axes: FloatArray, count: int, spacing: float) -> FloatArray | None:
    """Return ``count`` lattice points within an ellipsoid, the nearest to its middle first, shape (count, 3)."""
    step = spacing
    while step > CLOSEST * spacing:
        near = ROOMY * step * float(np.cbrt(count / np.prod(semi_axes)))
        for share in sorted({min(near, 1.0), 1.0}):
            high = np.floor(share * semi_axes / step) * step
            points = lattice(-high, high, step)
            # The yolk is a ball in the middle; round it, all is filled alike.
            layer = np.linalg.norm(points / semi_axes, axis=1)
            if (layer <= share).sum() >= count:
                points = points[np.argsort(layer, kind="stable")[:count]]
                return points[np.argsort(np.linalg.norm(points, axis=1), kind="stable")]
        step *= FINER
    return None

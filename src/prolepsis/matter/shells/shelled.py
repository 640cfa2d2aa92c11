"""What has a breakable ellipsoidal shell: its parts - shell, stuffs, a firm kernel, the shards of the shell."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from prolepsis.geometry.shape import Geom, Shape
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.things import WITHIN, Thing
from prolepsis.matter.shells.egg_things import room_within, shell_pieces
from prolepsis.scene.colours import colour_of
from prolepsis.scene.kind import Individuals, Made
from prolepsis.scene.parts import Kernel
from prolepsis.terms.errors import KnowledgeError

SLENDEREST, FLATTEST = 0.5, 2.0
"""Least and greatest breadth over length of a shell that is cut into pieces [1]."""
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
    return Made(things=(slippery, shell, *stuffs, *kernels, *shards), parts=(known, *areas, *firm, *membranes))


def _membrane(kb: KnowledgeBase, stuff: Thing) -> Membraned:
    force, radius = kb.quantity(stuff.name, "membraneForce"), kb.quantity(stuff.name, "probeRadius")
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

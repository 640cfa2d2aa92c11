"""The liquids of a situation: what flows by itself, and where it is told to be at the start."""

from __future__ import annotations

import math
from dataclasses import dataclass

from prolepsis.geometry.shape import Shape
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.things import WITHIN, Thing
from prolepsis.scene.colours import colour_of
from prolepsis.terms.errors import KnowledgeError

RELATIONS = ("contains", "on", "absorbs")
"""How a liquid is told to be somewhere."""

AMOUNTS = ("volume", "mass", "fill")
"""What tells how much of a liquid there is."""
ALIKE = 1e-3
"""By what share a stated mass may differ from density times a stated volume: nobody rounds more."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Placement:
    """Where a liquid is at the start."""

    relation: str
    """``contains``, ``on`` or ``absorbs``."""
    host: str
    """The container, what it lies on, or the sponge."""


def is_liquid(kb: KnowledgeBase, name: str) -> bool:
    """Return whether an individual is a liquid of its own, not the inside of an egg."""
    return kb.is_a(name, "Liquid") and kb.whole(name) is None


def liquid_thing(kb: KnowledgeBase, name: str, roles: frozenset[str]) -> Thing:
    """Return a liquid as a thing without a body."""
    quantities = {p: float(k.value) for p, k in kb.quantities(name).items() if isinstance(k.value, float)}
    kind = kb.kind(name)
    return Thing(
        name=name,
        kind=kind,
        shape=Shape(colour=colour_of(kb, name)),
        mount=WITHIN,
        roles=roles,
        quantities=quantities,
    )


def placement_of(kb: KnowledgeBase, name: str) -> Placement:
    """Return where a liquid is told to be.

    Raises:
        KnowledgeError: If it is told to be nowhere, or in two places.
    """
    told = [
        Placement(relation=relation, host=host)
        for relation in RELATIONS
        for host in (kb.subjects(relation, name) if relation != "on" else kb.objects_of(relation, name))
    ]
    if not told:
        raise KnowledgeError(
            f"{name} ({kb.kind(name)}) is nowhere; state what :contains it, what it is :on, or what :absorbs it"
        )
    if len(told) > 1:
        hosts = ", ".join(placement.host for placement in told)
        raise KnowledgeError(f"{name} ({kb.kind(name)}) is in several places: {hosts}; name a liquid for each")
    (placement,) = told
    if placement.relation == "absorbs":
        _refuse_dry(kb, placement.host, name)
    return placement


def refuse_amounts(kb: KnowledgeBase, name: str) -> None:
    """Refuse a liquid of which two amounts are told that are not the same.

    Raises:
        KnowledgeError: With both.
    """
    told = [amount for amount in AMOUNTS if kb.stated(name, amount) is not None]
    volume, mass, density = (kb.number(name, known) for known in ("volume", "mass", "density"))
    agree = volume and mass and density and math.isclose(mass, density * volume, rel_tol=ALIKE)
    if len(told) > 1 and not (told == ["volume", "mass"] and agree):
        where = f"{kb.location(name)}: {name} ({kb.kind(name)})"
        raise KnowledgeError(f"{where}: its {' and '.join(told)} are stated; allowed: one of {', '.join(AMOUNTS)}")


def _refuse_dry(kb: KnowledgeBase, sponge: str, liquid: str) -> None:
    kind = kb.kind(sponge)
    if kb.number(sponge, "absorbentCapacity") is None:
        raise KnowledgeError(f"{sponge} ({kind}) absorbs {liquid}, but has no absorbentCapacity; state it")
    if not kb.number(sponge, "saturation"):
        raise KnowledgeError(f"{sponge} ({kind}) absorbs {liquid}; state its :saturation, above 0 and at most 1")
    told = [amount for amount in AMOUNTS if kb.stated(liquid, amount) is not None]
    if told:
        raise KnowledgeError(
            f"{kb.location(liquid)}: {liquid} ({kb.kind(liquid)}): how much of it there is tells the saturation of "
            f"{sponge}; leave out its {' and '.join(told)}"
        )
    if len(kb.objects_of("absorbs", sponge)) > 1:
        raise KnowledgeError(f"{sponge} ({kind}) absorbs several liquids at the start; allowed: one")

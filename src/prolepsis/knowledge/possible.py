"""Values are possible: within the limits of their classes, on the right side of each other, and none is idle."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from prolepsis.knowledge import derived
from prolepsis.knowledge.batches import refuse_idle_batches
from prolepsis.knowledge.deriving import derive, mass_of_volume, masses_of
from prolepsis.knowledge.vocabulary import Property
from prolepsis.terms.errors import KnowledgeError

if TYPE_CHECKING:
    from prolepsis.knowledge.knowledge_base import KnowledgeBase

_EXTENTS = ("length", "breadth", "width", "height", "radius", "thickness")
ALIKE = 0.01
"""A mass and what follows from density and volume agree within this share [1]: people round."""


def refuse_impossible_values(base: KnowledgeBase) -> None:
    """Refuse what no individual can have.

    Raises:
        KnowledgeError: If masses of parts and wholes contradict each other, a value is out of the limits of a class or
            on the wrong side of another one, or a batch states what its individuals do not have.
    """

    def where(name: str, property_name: str = "mass") -> str:
        stated = base.situation.said.get((name, property_name))
        return stated[0].where if stated else base.situation.locations[name]

    masses_of(base).refuse(where)
    refuse_idle_batches(base)
    compared = [entry for entry in base.vocabulary.properties.values() if entry.at_least_of or entry.at_most_of]
    usual: set[tuple[str, ...]] = set()
    for name in base.individuals:
        classes = base.types.classes[name]
        for limit in (limit for c in classes for limit in base.vocabulary.classes[c].limits):
            value = base.text(name, limit.name) if limit.among else base.number(name, limit.name)
            if value is not None and not limit.admits(value):
                known = base.find(name, limit.name)
                follows = f" ({known.source})" if known is not None and known.origin == "derived" else ""
                said = f"{limit.name} = {limit.shown(value)}{follows}: must be {limit.bounds} for a {base.kind(name)}"
                raise KnowledgeError(f"{where(name, limit.name)}: {name}: {said}")
        _refuse_twice_told(base, name, where)
        _refuse_no_matter(base, name, where)
        for entry in compared:
            # Of those of whom nothing of it is said, one of each kind is enough.
            said = any((name, each) in base.situation.said for each in (entry.name, *_others(entry)))
            if said or classes not in usual:
                _refuse_wrong_side(base, name, entry, where(name, entry.name))
        usual.add(classes)


def _refuse_twice_told(base: KnowledgeBase, name: str, where: Callable[[str, str], str]) -> None:
    """Refuse a capacity that follows from extents, and a mass that density and volume contradict."""
    if base.stated(name, "capacity") is not None and derive(base, name, "capacity") is not None:
        raise KnowledgeError(f"{where(name, 'capacity')}: {name}: its capacity follows from its extents; leave it out")
    mass, density = base.stated(name, "mass"), base.stated(name, "density")
    found = None if mass is None or density is None else mass_of_volume(base, name)
    if mass is not None and found is not None and not math.isclose(mass, float(found.value), rel_tol=ALIKE):
        raise KnowledgeError(
            f"{where(name, 'mass')}: {name}: its mass is {mass:g} kg, but {found.source} is {found.value:g} kg; "
            "allowed: one of mass and density, or both if they agree"
        )


def _refuse_no_matter(base: KnowledgeBase, name: str, where: Callable[[str, str], str]) -> None:
    """Refuse a mass and extents, of which one is stated, that no matter of the individual's classes has."""
    stated = next((each for each in ("mass", *_EXTENTS) if base.stated(name, each) is not None), None)
    shape, mass = base.text(name, "shape"), base.number(name, "mass")
    # What encloses nothing has no volume, and the file of a mesh is read when it is composed.
    if stated is None or mass is None or shape in (None, "mesh"):
        return
    found = derived.volume(shape, lambda extent: base.number(name, extent))
    if found is None:
        return
    density, (volume, formula) = mass / found[0], found
    limits = (limit for c in base.types.classes[name] for limit in base.vocabulary.classes[c].limits)
    for bound in (base.vocabulary.properties["density"], *(each for each in limits if each.name == "density")):
        if not bound.admits(density):
            one = not all(any(base.stated(name, each) is not None for each in told) for told in (("mass",), _EXTENTS))
            raise KnowledgeError(
                f"{where(name, stated)}: {name}: its mass, {mass:.3g} kg, in its volume, {volume:.3g} m3 ({formula}), "
                f"is {density:.3g} kg/m3: must be {bound.bounds} for a {base.kind(name)}"
                f"{'; state both mass and extents' if one else ''}"
            )


def _others(entry: Property) -> Iterator[str]:
    yield from filter(None, (entry.at_least_of, entry.at_most_of))


def _refuse_wrong_side(base: KnowledgeBase, name: str, entry: Property, where: str) -> None:
    """Refuse a value on the wrong side of another one of the same individual.

    A default gives way to what is said of the other: who makes a shell stronger need not know how it bears cushions.
    """
    value, said = base.number(name, entry.name), base.situation.said
    for other, words, sign in ((entry.at_least_of, "at least", 1.0), (entry.at_most_of, "at most", -1.0)):
        if not other or value is None or ((name, other) in said and (name, entry.name) not in said):
            continue
        bound = base.number(name, other)
        if bound is not None and sign * value < sign * bound:
            raise KnowledgeError(
                f"{where}: {name} ({base.kind(name)}): {entry.name} = {entry.shown(value)}: must be {words} its "
                f"{other}, {entry.shown(bound)}; state both"
            )

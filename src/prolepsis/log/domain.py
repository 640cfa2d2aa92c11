"""What is known of the individuals, as plain rows that queries can read: no triples, no reasoner."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # A question reads domains, and has no need of shapes.
    from prolepsis.log.things import Thing


@dataclass(frozen=True, kw_only=True, slots=True)
class Domain:
    """Domain knowledge of one run, with inferred classes. Names are atoms: ``egg1``, ``Egg``, ``mass``."""

    instances: tuple[tuple[str, str], ...] = ()
    """(individual, class), inferred classes included."""
    parts: tuple[tuple[str, str], ...] = ()
    """(whole, part), direct parts only."""
    values: tuple[tuple[str, str, float | str], ...] = ()
    """(individual, property, value), quantities in SI units."""
    relations: tuple[tuple[str, str, str], ...] = ()
    """(relation, subject, object): what the situation asserts, which holds from 0.0 on (``log/asserted.py``)."""
    subclasses: tuple[tuple[str, str], ...] = ()
    """(class, class above it), as told."""
    definitions: tuple[tuple[str, str, str], ...] = ()
    """(class, property, filler) of classes that are defined by all of such rows: ``("WetGripper", "is a", "Gripper")``,
    ``("WetThing", "wet", "is true")``, ``("LiquidContainer", "comprises", "Liquid")``; an empty filler is anything.
    What is no property or class has a space, as no name has."""
    subproperties: tuple[tuple[str, str], ...] = ()
    """(property, property above it), as told; of two that are the same each is above the other."""
    inverses: tuple[tuple[str, str], ...] = ()
    """(property, what says the same from the other end), as told; a symmetric one is its own."""
    declared: tuple[tuple[str, str], ...] = ()
    """(kind, name) of classes and properties, but quantities, of which no other row tells that they exist."""
    units: tuple[tuple[str, str], ...] = ()
    """(property, SI unit) of quantities."""
    untold: tuple[tuple[str], ...] = ()
    """Each class of which a log that others made tells nothing: it does not decide what is found of nothing else."""
    unchecked: str = ""
    """Why it was not decided whether this contradicts itself; empty if it does not."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Domain({len({name for name, _ in self.instances})} individuals)"


def with_things(domain: Domain, things: Iterable[Thing]) -> Domain:
    """Return ``domain`` with what things say of themselves of which it says nothing: shards, links of a robot."""
    known = {name for name, _ in domain.instances}
    new = [thing for thing in things if thing.name not in known]
    instances = sorted({(t.name, kind) for t in new for kind in {t.kind, *t.roles}})
    values = sorted((t.name, name, value) for t in new for name, value in t.quantities.items())
    masses = sorted((t.name, "mass", t.mass) for t in new if t.mass > 0 and "mass" not in t.quantities)
    parts = sorted((t.whole, t.name) for t in new if t.whole is not None)
    return replace(
        domain,
        instances=(*domain.instances, *instances),
        parts=(*domain.parts, *(part for part in parts if part not in domain.parts)),
        values=(*domain.values, *sorted([*values, *masses])),
    )

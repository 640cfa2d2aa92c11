"""What is known of the individuals, as plain rows that queries can read: no triples, no reasoner."""

from __future__ import annotations

from dataclasses import dataclass


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
    unchecked: str = ""
    """Why it was not decided whether this contradicts itself; empty if it does not."""

"""The situation: all individuals, and what is said of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

INVERSES = {"partOf": "hasPart", "supports": "on"}
"""Properties that say what another one says, from the other end; only the other one is kept."""
MOST_INDIVIDUALS = 4000
"""Individuals of what is simulated: twice as many as there may be things that move; to look further would take long."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Statement:
    """One value or relation of an individual."""

    subject: str
    """The individual."""
    property: str
    """Name of the property."""
    value: float | str
    """In SI units, ``true``/``false``, or the name of another individual."""
    where: str
    """File and line, or why it is said."""
    derived: bool = False
    """True if it follows from a default part."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Situation:
    """All individuals and what is said of them."""

    classes: Mapping[str, tuple[str, ...]]
    """Told classes of each individual, sorted by name."""
    iris: Mapping[str, str]
    """Full IRI of each individual."""
    statements: tuple[Statement, ...]
    """Values and relations, in the order of files and names."""
    locations: Mapping[str, str]
    """File and line where each individual is introduced."""
    wholes: Mapping[str, str]
    """Part to whole."""
    parts: Mapping[str, tuple[str, ...]] = field(init=False, repr=False)
    """Whole to its direct parts, sorted."""
    said: Mapping[tuple[str, str], tuple[Statement, ...]] = field(init=False, repr=False)
    """Individual and property to the statements with them, in order."""
    said_with: Mapping[tuple[str, str], tuple[str, ...]] = field(init=False, repr=False)
    """Relation and its object to its subjects, sorted."""

    def __post_init__(self) -> None:
        """Index what is said: it is looked up as often as there are individuals."""
        parts: dict[str, list[str]] = {}
        for part, whole in sorted(self.wholes.items()):
            parts.setdefault(whole, []).append(part)
        said: dict[tuple[str, str], list[Statement]] = {}
        subjects: dict[tuple[str, str], set[str]] = {}
        for s in self.statements:
            said.setdefault((s.subject, s.property), []).append(s)
            if isinstance(s.value, str):
                subjects.setdefault((s.property, s.value), set()).add(s.subject)
        object.__setattr__(self, "parts", {whole: tuple(names) for whole, names in parts.items()})
        object.__setattr__(self, "said", {key: tuple(statements) for key, statements in said.items()})
        object.__setattr__(self, "said_with", {key: tuple(sorted(names)) for key, names in subjects.items()})

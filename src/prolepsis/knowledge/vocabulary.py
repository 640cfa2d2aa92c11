"""The vocabulary: which classes and properties there are, with units, bounds, defaults and their sources."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from prolepsis.log.domain import Domain
from prolepsis.terms.units import si_symbol, to_si, unit_of

CERTAINTIES = {
    "T": "seen in a text",
    "R": "measured",
    "C": "computed",
    "M": "from memory, unverified",
    "D": "decided here",
}
"""How well a default is known."""
INVERSE_OF = "inverse of "
"""What a property that is only named as the inverse of another begins with."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Property:
    """What may be said of an individual."""

    name: str
    """``mass``."""
    iri: str
    """Full IRI."""
    kind: str
    """``quantity`` (a number with a unit), ``truth`` (true or false), ``text``, or ``relation`` (to an individual)."""
    unit: str = ""
    """Unit of a plain number as it is written, ``deg``."""
    above: float | None = None
    """Values must be greater than this [unit]."""
    at_least: float | None = None
    """Values must not be less than this [unit]."""
    at_most: float | None = None
    """Values must not be greater than this [unit]."""
    at_least_of: str = ""
    """Another property of the same individual than which values must not be less; empty if there is none."""
    at_most_of: str = ""
    """Another property of the same individual than which values must not be greater; empty if there is none."""
    among: tuple[str, ...] = ()
    """Individuals of which values must be one; any if empty."""
    whole: bool = False
    """True if values must be whole numbers."""
    of_parts: bool = False
    """True if what is stated of a whole is so of its parts, unless it is stated of them."""
    functional: bool = False
    """True if an individual has at most one value."""
    parents: tuple[str, ...] = ()
    """More general properties, and those that are said to be the same."""
    inverses: tuple[str, ...] = ()
    """Properties that say the same from the other end; a symmetric one is its own."""
    range: str = ""
    """Class of the values of a relation, if one is named."""
    alignments: tuple[str, ...] = ()
    """IRIs of other ontologies that it corresponds to."""
    comment: str = ""
    """What it means."""

    @property
    def si_unit(self) -> str:
        """SI unit of the values that the knowledge base gives, ``rad``."""
        return si_symbol(unit_of(self.unit)) if self.kind == "quantity" else ""

    @property
    def bounds(self) -> str:
        """What is allowed, in words."""
        if self.among:
            return " or ".join(self.among)
        parts = [f"greater than {self.above:g}"] if self.above is not None else []
        parts += [f"at least {self.at_least:g}"] if self.at_least is not None else []
        parts += [f"at most {self.at_most:g}"] if self.at_most is not None else []
        bounds = " and ".join(parts) + (f" {self.unit}" if parts and self.unit not in ("", "1") else "")
        others = (("at least", self.at_least_of), ("at most", self.at_most_of))
        bounds = " and ".join([*filter(None, [bounds]), *(f"{words} its {other}" for words, other in others if other)])
        return " ".join((["a whole number"] if self.whole else []) + ([bounds] if bounds else []))

    def shown(self, value: float | str) -> str:
        """Return a value in SI units as a message shows it, in the unit in which it is written."""
        if isinstance(value, str):
            return value
        unit = unit_of(self.unit)
        return f"{(value - unit.offset) / unit.factor:g} {self.unit if self.unit != '1' else ''}".rstrip()

    def admits(self, value: float | str) -> bool:
        """Return whether a value, in SI units if it is a quantity, is within the bounds."""
        if isinstance(value, str):
            return not self.among or value in self.among
        return not (
            (self.whole and not float(value).is_integer())
            or (self.above is not None and not value > to_si(self.above, self.unit))
            or (self.at_least is not None and not value >= to_si(self.at_least, self.unit))
            or (self.at_most is not None and not value <= to_si(self.at_most, self.unit))
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class Default:
    """What a class says of its individuals unless they say otherwise."""

    property: str
    """Name of the property."""
    value: float | str
    """In SI units, ``true``/``false``, or the name of an individual."""
    deviation: float
    """Standard deviation between individuals, in SI units; 0 if not stated."""
    batch_deviation: float
    """That between individuals of one batch, at most as great."""
    source: str
    """Where it comes from."""
    certainty: str
    """One of ``CERTAINTIES``."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Curve:
    """A default that depends on another property; between two points the logarithm of the value changes evenly."""

    property: str
    """Name of the property whose value it gives."""
    over: str
    """Name of the property that it depends on."""
    points: tuple[tuple[float, float], ...]
    """(where, value) in SI units, where ascending; at least two, all values positive."""
    source: str
    """Where it comes from."""
    certainty: str
    """One of ``CERTAINTIES``."""

    def at(self, where: float) -> float | None:
        """Return the value at ``where``, or None if that is outside all points."""
        if not self.points[0][0] <= where <= self.points[-1][0]:
            return None
        for (a, low), (b, high) in zip(self.points[:-1], self.points[1:], strict=True):
            if where <= b:
                return low * (high / low) ** ((where - a) / (b - a))
        return None


@dataclass(frozen=True, kw_only=True, slots=True)
class DefaultPart:
    """A part that an individual of a class has unless it says otherwise."""

    kind: str
    """Class of the part."""
    unless: str
    """Not made when a stated part is of this class."""
    counted_by: str
    """Property of the whole that tells how many of them there are; empty if there is one."""
    source: str
    """Where it comes from."""
    certainty: str
    """One of ``CERTAINTIES``."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ClassEntry:
    """A named class as it is written."""

    name: str
    """``Egg``."""
    iri: str
    """Full IRI."""
    parents: tuple[str, ...] = ()
    """Named superclasses that are told."""
    defined: bool = False
    """True if the reasoner decides who belongs to it (``owl:equivalentClass``)."""
    conditions: tuple[tuple[str, str], ...] = ()
    """What makes up a definition that is an intersection of named classes, ``("is a", "Gripper")``, of what is true,
    ``("wet", "is true")``, and of relations to some of a named class, ``("contains", "Liquid")``, or to what has one to
    it, ``("inverse of contains", "Cup")``; none of any other."""
    defaults: tuple[Default, ...] = ()
    """Class defaults."""
    curves: tuple[Curve, ...] = ()
    """Class defaults that depend on another property."""
    limits: tuple[Property, ...] = ()
    """Properties with narrower bounds for the individuals of the class."""
    parts: tuple[DefaultPart, ...] = ()
    """Default parts."""
    needs_whole: tuple[str, ...] = ()
    """Its individuals must be parts of one of these classes."""
    called: str = ""
    """What a default part of it is called, before its whole's number, where the whole is named as its class: ``white``
    of ``egg1``; empty if it is always called after its whole."""
    alignments: tuple[str, ...] = ()
    """IRIs of other ontologies that it corresponds to."""
    comment: str = ""
    """What it means."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Vocabulary:
    """All classes and properties, by name."""

    classes: Mapping[str, ClassEntry]
    """By name, sorted."""
    properties: Mapping[str, Property]
    """By name, sorted."""
    _told: dict[tuple[str, ...], tuple[str, ...]] = field(
        default_factory=dict[tuple[str, ...], tuple[str, ...]], init=False, repr=False, compare=False
    )
    """What was asked of the classes already: many individuals are told to be of the same."""

    def domain(self) -> Domain:
        """Return what is told of classes and properties as plain rows, and nothing of individuals."""
        classes, properties = self.classes.values(), self.properties.values()
        subclasses = tuple(sorted({(c.name, above) for c in classes for above in c.parents}))
        definitions = tuple((c.name, *row) for c in classes for row in c.conditions)
        inverses = [(p.name, its) for p in properties for its in p.inverses]
        inverses += [(p, p.removeprefix(INVERSE_OF)) for _, p, _ in definitions if p.startswith(INVERSE_OF)]
        placed = {name for row in subclasses for name in row} | {row[0] for row in definitions}
        bare = [("class", name) for name in self.classes if name not in placed]
        return Domain(
            subclasses=subclasses,
            definitions=definitions,
            subproperties=tuple((p.name, above) for p in properties for above in p.parents),
            inverses=tuple(sorted({*inverses})),
            declared=(*bare, *((p.kind, p.name) for p in properties if p.kind != "quantity")),
            units=tuple((p.name, p.si_unit) for p in properties if p.kind == "quantity"),
        )

    def told_classes(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return ``names`` and all their told superclasses, sorted."""
        if names not in self._told:
            self._told[names] = self._told_classes(names)
        return self._told[names]

    def _told_classes(self, names: tuple[str, ...]) -> tuple[str, ...]:
        found: set[str] = set()
        queue = list(names)
        while queue:
            name = queue.pop()
            if name in self.classes and name not in found:
                found.add(name)
                queue.extend(self.classes[name].parents)
        return tuple(sorted(found))

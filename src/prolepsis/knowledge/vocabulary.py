"""The vocabulary: which classes and properties there are, with units, bounds, defaults and their sources."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rdflib import OWL, RDF, RDFS, XSD, BNode, Literal, Namespace, URIRef
from rdflib.collection import Collection
from rdflib.term import Node

from prolepsis.errors import InputError, KnowledgeError
from prolepsis.knowledge.turtle import NAMESPACE, Document, local_name
from prolepsis.units import qudt_symbol, read_quantity, si_symbol, to_si, unit_of

PRO = Namespace(NAMESPACE)
HAS_UNIT = URIRef("http://qudt.org/schema/qudt/hasUnit")

CERTAINTIES = {
    "T": "seen in a text",
    "R": "measured",
    "C": "computed",
    "M": "from memory, unverified",
    "D": "decided here",
}
"""How well a default is known."""


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
    functional: bool = False
    """True if an individual has at most one value."""
    parents: tuple[str, ...] = ()
    """More general properties."""
    range: str = ""
    """Class of the values of a relation, if one is named."""
    comment: str = ""
    """What it means."""

    @property
    def si_unit(self) -> str:
        """SI unit of the values that the knowledge base gives, ``rad``."""
        return si_symbol(unit_of(self.unit)) if self.kind == "quantity" else ""

    @property
    def bounds(self) -> str:
        """What is allowed, in words."""
        parts = [f"greater than {self.above:g}"] if self.above is not None else []
        parts += [f"at least {self.at_least:g}"] if self.at_least is not None else []
        parts += [f"at most {self.at_most:g}"] if self.at_most is not None else []
        return " and ".join(parts) + (f" {self.unit}" if parts and self.unit not in ("", "1") else "")


@dataclass(frozen=True, kw_only=True, slots=True)
class Default:
    """What a class says of its individuals unless they say otherwise."""

    property: str
    """Name of the property."""
    value: float | str
    """In SI units, ``true``/``false``, or the name of an individual."""
    deviation: float
    """Standard deviation between individuals, in SI units; 0 if not stated."""
    source: str
    """Where it comes from."""
    certainty: str
    """One of ``CERTAINTIES``."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DefaultPart:
    """A part that an individual of a class has unless it says otherwise."""

    kind: str
    """Class of the part."""
    unless: str
    """Not made when a stated part is of this class."""
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
    defaults: tuple[Default, ...] = ()
    """Class defaults."""
    parts: tuple[DefaultPart, ...] = ()
    """Default parts."""
    needs_whole: tuple[str, ...] = ()
    """Its individuals must be parts of one of these classes."""
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

    def told_classes(self, names: tuple[str, ...]) -> tuple[str, ...]:
        """Return ``names`` and all their told superclasses, sorted."""
        found: set[str] = set()
        queue = list(names)
        while queue:
            name = queue.pop()
            if name in self.classes and name not in found:
                found.add(name)
                queue.extend(self.classes[name].parents)
        return tuple(sorted(found))


def read_vocabulary(documents: tuple[Document, ...]) -> Vocabulary:
    """Return the classes and properties that ``documents`` declare.

    Raises:
        KnowledgeError: If a unit is unknown, or a default lacks property, value, source or certainty.
    """
    properties: dict[str, Property] = {}
    for document in documents:
        for iri in _named(document, OWL.DatatypeProperty, OWL.ObjectProperty):
            properties[local_name(iri)] = _property(document, iri)
    classes: dict[str, ClassEntry] = {}
    for document in documents:
        for iri in _named(document, OWL.Class):
            entry = _class(document, iri, properties)
            classes[entry.name] = _joined(classes[entry.name], entry) if entry.name in classes else entry
    return Vocabulary(classes=dict(sorted(classes.items())), properties=dict(sorted(properties.items())))


def _named(document: Document, *types: URIRef) -> list[URIRef]:
    found = {s for t in types for s in document.graph.subjects(RDF.type, t) if isinstance(s, URIRef)}
    return sorted(found)


def _one(document: Document, subject: Node, predicate: URIRef) -> Node | None:
    values = sorted(document.graph.objects(subject, predicate), key=str)
    return values[0] if values else None


def _text(document: Document, subject: Node, predicate: URIRef) -> str:
    node = _one(document, subject, predicate)
    return "" if node is None else str(node)


def _number(document: Document, subject: Node, predicate: URIRef) -> float | None:
    node = _one(document, subject, predicate)
    return None if node is None else float(str(node))


def _property(document: Document, iri: URIRef) -> Property:
    graph = document.graph
    ranges = [local_name(r) for r in graph.objects(iri, RDFS.range) if isinstance(r, URIRef)]
    unit_node = _one(document, iri, HAS_UNIT)
    unit, kind = "", "relation"
    if (iri, RDF.type, OWL.DatatypeProperty) in graph:
        kind = "truth" if (iri, RDFS.range, XSD.boolean) in graph else "text"
    if isinstance(unit_node, URIRef):
        symbol = qudt_symbol(local_name(unit_node))
        if symbol is None:
            raise KnowledgeError(
                f"{document.where(iri)}: property {local_name(iri)} has the unknown unit <{unit_node}>"
            )
        unit, kind = symbol, "quantity"
    return Property(
        name=local_name(iri),
        iri=str(iri),
        kind=kind,
        unit=unit,
        above=_number(document, iri, PRO.above),
        at_least=_number(document, iri, PRO.atLeast),
        at_most=_number(document, iri, PRO.atMost),
        functional=(iri, RDF.type, OWL.FunctionalProperty) in graph,
        parents=tuple(sorted(local_name(p) for p in graph.objects(iri, RDFS.subPropertyOf) if isinstance(p, URIRef))),
        range=ranges[0] if ranges and kind == "relation" else "",
        comment=_text(document, iri, RDFS.comment),
    )


def _class(document: Document, iri: URIRef, properties: Mapping[str, Property]) -> ClassEntry:
    graph = document.graph
    parents = [p for p in graph.objects(iri, RDFS.subClassOf) if isinstance(p, URIRef)]
    for meaning in graph.objects(iri, OWL.equivalentClass):
        for members in graph.objects(meaning, OWL.intersectionOf):
            parents += [member for member in Collection(graph, members) if isinstance(member, URIRef)]
    others = [e for e in graph.objects(iri, OWL.equivalentClass) if isinstance(e, URIRef)]
    others += [m for m in graph.objects(iri, PRO.alignedWith) if isinstance(m, URIRef)]
    own = [p for p in parents if not _foreign(p)]
    return ClassEntry(
        name=local_name(iri),
        iri=str(iri),
        parents=tuple(sorted(local_name(p) for p in own)),
        defined=any(isinstance(e, BNode) for e in graph.objects(iri, OWL.equivalentClass)),
        defaults=tuple(sorted(_defaults(document, iri, properties), key=lambda d: d.property)),
        parts=tuple(sorted(_parts(document, iri), key=lambda p: p.kind)),
        needs_whole=tuple(sorted(local_name(w) for w in graph.objects(iri, PRO.needsWhole) if isinstance(w, URIRef))),
        alignments=tuple(sorted({str(p) for p in parents + others if _foreign(p)})),
        comment=_text(document, iri, RDFS.comment),
    )


def _foreign(iri: URIRef) -> bool:
    return "ontologydesignpatterns.org" in iri or "ease-crc.org" in iri


def _joined(first: ClassEntry, second: ClassEntry) -> ClassEntry:
    """Return what two files say of one class."""
    return ClassEntry(
        name=first.name,
        iri=first.iri,
        parents=tuple(sorted({*first.parents, *second.parents})),
        defined=first.defined or second.defined,
        defaults=tuple(sorted((*first.defaults, *second.defaults), key=lambda d: d.property)),
        parts=tuple(sorted((*first.parts, *second.parts), key=lambda p: p.kind)),
        needs_whole=tuple(sorted({*first.needs_whole, *second.needs_whole})),
        alignments=tuple(sorted({*first.alignments, *second.alignments})),
        comment=first.comment or second.comment,
    )


def _provenance(document: Document, iri: URIRef, node: Node, what: str) -> tuple[str, str]:
    source, certainty = _text(document, node, PRO.source), _text(document, node, PRO.certainty)
    if not source:
        raise KnowledgeError(f"{document.where(iri)}: {what} of {local_name(iri)} has no :source")
    if certainty not in CERTAINTIES:
        known = ", ".join(f"{letter} ({meaning})" for letter, meaning in CERTAINTIES.items())
        raise KnowledgeError(
            f"{document.where(iri)}: {what} of {local_name(iri)} has the certainty {certainty!r}; known: {known}"
        )
    return source, certainty


def _defaults(document: Document, iri: URIRef, properties: Mapping[str, Property]) -> Iterator[Default]:
    for node in document.graph.objects(iri, PRO.default):
        of = _one(document, node, PRO.of)
        name = local_name(of) if isinstance(of, URIRef) else "nothing"
        what = f"the default {name}"
        if name not in properties:
            raise KnowledgeError(f"{document.where(iri)}: {what} of {local_name(iri)} is of no known property")
        source, certainty = _provenance(document, iri, node, what)
        value = _one(document, node, PRO.value)
        if value is None:
            raise KnowledgeError(f"{document.where(iri)}: {what} of {local_name(iri)} has no :value")
        where = f"{document.where(iri)}: {what} of {local_name(iri)}"
        deviation = _one(document, node, PRO.deviation)
        entry = properties[name]
        yield Default(
            property=name,
            value=read_value(entry, value, where=where),
            deviation=0.0 if deviation is None else float(str(deviation)) * unit_of(entry.unit).factor,
            source=source,
            certainty=certainty,
        )


def _parts(document: Document, iri: URIRef) -> Iterator[DefaultPart]:
    for node in document.graph.objects(iri, PRO.defaultPart):
        of, unless = _one(document, node, PRO.of), _one(document, node, PRO.unless)
        if not isinstance(of, URIRef):
            raise KnowledgeError(f"{document.where(iri)}: a default part of {local_name(iri)} has no :of")
        source, certainty = _provenance(document, iri, node, f"the default part {local_name(of)}")
        kind = local_name(of)
        unless_name = local_name(unless) if isinstance(unless, URIRef) else kind
        yield DefaultPart(kind=kind, unless=unless_name, source=source, certainty=certainty)


def read_value(entry: Property, node: Node | str | float, *, where: str) -> float | str:
    """Return a value as it is written in SI units, checked against the bounds of its property.

    Args:
        entry: The property.
        node: A Turtle literal or IRI, a number in the property's unit, or a text such as ``"58 g"``.
        where: File, line and subject, for the message.

    Raises:
        KnowledgeError: If it is not of the right kind, or outside the bounds.
    """
    if entry.kind == "relation":
        if isinstance(node, (Literal, BNode)):
            raise KnowledgeError(f"{where}: {entry.name} must name an individual, not {str(node)!r}")
        return local_name(node) if isinstance(node, URIRef) else str(node)
    if isinstance(node, (URIRef, BNode)):
        raise KnowledgeError(f"{where}: {entry.name} must be a value, not {local_name(URIRef(str(node)))!r}")
    text = str(node).strip()
    if entry.kind == "truth":
        if text.lower() not in ("true", "false", "1", "0"):
            raise KnowledgeError(f"{where}: {entry.name} must be true or false, not {text!r}")
        return "true" if text.lower() in ("true", "1") else "false"
    if entry.kind == "text":
        return text
    read = read_quantity(text)
    if read is None:
        raise KnowledgeError(f"{where}: {entry.name} must be a number, with or without a unit, not {text!r}")
    number, unit = read
    try:
        value = to_si(number, unit or entry.unit, entry.unit)
    except InputError as error:
        raise KnowledgeError(f"{where}: {entry.name} = {text!r}: {error}") from error
    return _bounded(entry, value, text, where)


def _bounded(entry: Property, value: float, text: str, where: str) -> float:
    def si(bound: float) -> float:
        return to_si(bound, entry.unit)

    finite = value - value == 0.0
    low = entry.above is not None and not value > si(entry.above)
    low = low or (entry.at_least is not None and not value >= si(entry.at_least))
    high = entry.at_most is not None and not value <= si(entry.at_most)
    if not finite or low or high:
        allowed = f" and {entry.bounds}" if entry.bounds else ""
        raise KnowledgeError(f"{where}: {entry.name} = {text}: must be finite{allowed}")
    return value

"""The reasoner sees of a number only what definitions distinguish: in which cell between their bounds it lies.

A class such as "breaks at 100 N or less" splits the forces into two cells. Each cell becomes a class of value
objects, the data property becomes an object property to them, and the axioms say that the cells are disjoint
and exhaustive. That is exact for restrictions on values, it keeps the reasoner away from the data ranges that
pyhermit 0.2.3 leaves out of the left-hand side of a definition, and two situations that
differ only in numbers look the same to it, so its answer is reused.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from rdflib import OWL, RDF, RDFS, XSD, BNode, Graph, Literal, URIRef
from rdflib.collection import Collection
from rdflib.term import Node

from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.knowledge.vocabulary import Property, Vocabulary
from prolepsis.terms.errors import KnowledgeError, brief
from prolepsis.terms.units import to_si

Scalar = float | str

_FACETS = {
    XSD.minInclusive: ">=",
    XSD.minExclusive: ">",
    XSD.maxInclusive: "<=",
    XSD.maxExclusive: "<",
}
_DATATYPES = {
    "quantity": (XSD.double, XSD.float, XSD.decimal, RDFS.Literal),
    "truth": (XSD.boolean, RDFS.Literal),
    "text": (XSD.string, RDFS.Literal),
}
"""Datatypes to which every value of a kind of property belongs."""


@dataclass(frozen=True, slots=True)
class DataRange:
    """A set of values: all of them, listed ones, an interval, or one combined from others."""

    kind: str
    """``all``, ``values``, ``<``, ``<=``, ``>``, ``>=``, ``and``, ``or`` or ``not``."""
    values: tuple[Scalar, ...] = ()
    """Listed values, or the one bound, in SI units."""
    of: tuple[DataRange, ...] = ()
    """What a combined range is made of."""

    def admits(self, value: Scalar) -> bool:
        """Return whether ``value`` (in SI units) belongs to the range."""
        match self.kind:
            case "all":
                return True
            case "values":
                return value in self.values
            case "and":
                return all(part.admits(value) for part in self.of)
            case "or":
                return any(part.admits(value) for part in self.of)
            case "not":
                return not self.of[0].admits(value)
            case _:
                return self._compares(float(value), float(self.values[0]))

    def _compares(self, value: float, bound: float) -> bool:
        return {"<": value < bound, "<=": value <= bound, ">": value > bound, ">=": value >= bound}[self.kind]

    def points(self) -> Iterable[Scalar]:
        """Return all values at which membership can change."""
        return (*self.values, *(point for part in self.of for point in part.points()))

    def __str__(self) -> str:
        if self.kind in ("and", "or"):
            return f" {self.kind} ".join(str(part) for part in self.of)
        if self.kind == "not":
            return f"not ({self.of[0]})"
        if self.kind == "all":
            return "any value"
        shown = ", ".join(f"{v:g}" if isinstance(v, float) else str(v) for v in self.values)
        return shown if self.kind == "values" else f"{self.kind} {shown}"


def read_range(graph: Graph, node: Node, entry: Property) -> DataRange:
    """Return the data range that ``node`` denotes, with its bounds in SI units.

    Raises:
        KnowledgeError: If it is written in a way that is not supported.
    """
    if isinstance(node, Literal):
        return DataRange("values", (_scalar(node, entry),))
    if isinstance(node, URIRef):
        return _all_of(node, entry)
    for predicate, kind in ((OWL.unionOf, "or"), (OWL.intersectionOf, "and")):
        members = graph.value(node, predicate)
        if members is not None:
            return DataRange(kind, of=tuple(read_range(graph, m, entry) for m in Collection(graph, members)))
    complement = graph.value(node, OWL.datatypeComplementOf)
    if complement is not None:
        return DataRange("not", of=(read_range(graph, complement, entry),))
    listed = graph.value(node, OWL.oneOf)
    if listed is not None:
        return DataRange("values", tuple(_scalar(m, entry) for m in Collection(graph, listed)))
    facets, base = graph.value(node, OWL.withRestrictions), graph.value(node, OWL.onDatatype)
    if facets is not None and isinstance(base, URIRef) and entry.kind == "quantity":
        _all_of(base, entry)
        parts = [
            DataRange(_FACETS[URIRef(str(predicate))], (_scalar(bound, entry),))
            for facet in Collection(graph, facets)
            for predicate, bound in sorted(graph.predicate_objects(facet))
            if predicate in _FACETS
        ]
        if parts:
            return DataRange("and", of=tuple(parts))
    raise KnowledgeError(f"a restriction on {entry.name} has a range of values that cannot be read")


def _all_of(datatype: URIRef, entry: Property) -> DataRange:
    known = (*_DATATYPES[entry.kind], *((XSD.integer,) if entry.whole else ()))
    if datatype not in known:
        allowed = ", ".join(local_name(each) for each in known)
        raise KnowledgeError(f"a value of {entry.name} is no {local_name(datatype)}; allowed: {allowed}")
    return DataRange("all")


def _scalar(node: Node, entry: Property) -> Scalar:
    text = str(node).strip()
    if entry.kind == "quantity":
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise KnowledgeError(f"a restriction on {entry.name} must name a number, not {brief(repr(text))}")
        return to_si(number, entry.unit)
    if entry.kind == "truth":
        truth = {"true": "true", "1": "true", "false": "false", "0": "false"}.get(text.lower())
        if truth is None:
            raise KnowledgeError(f"a restriction on {entry.name} must name true or false, not {brief(repr(text))}")
        return truth
    return text


@dataclass(frozen=True, slots=True)
class Cells:
    """The cells of one property: classes of its values that definitions tell apart."""

    iri: str
    """IRI of the property."""
    samples: tuple[Scalar, ...]
    """One value of each cell."""
    points: tuple[Scalar, ...]
    """The values that are cells of their own."""
    mentioned: bool = False
    """Whether any axiom speaks of its values."""

    def name(self, index: int) -> str:
        """Return the class of the cell as the reasoner sees it."""
        return f"<{self.iri}/cell{index}>"

    def all(self) -> tuple[str, ...]:
        """Return the classes of all cells."""
        return tuple(self.name(i) for i in range(len(self.samples)))

    def within(self, values: DataRange) -> tuple[str, ...]:
        """Return the classes of the cells that lie in the range."""
        return tuple(self.name(i) for i, sample in enumerate(self.samples) if values.admits(sample))

    def region(self, cells: tuple[str, ...]) -> str:
        """Return the class of the values that lie in any of ``cells`` (at least one)."""
        if len(cells) == len(self.samples):
            return "<http://www.w3.org/2002/07/owl#Thing>"
        if len(cells) == 1:
            return cells[0]
        numbers = "-".join(str(self.all().index(cell)) for cell in cells)
        return f"<{self.iri}/cells{numbers}>"

    def of(self, value: Scalar) -> str:
        """Return the class of the cell in which ``value`` lies."""
        if value in self.points:
            return self.name(self.samples.index(value))
        if isinstance(value, str):
            return self.name(len(self.samples) - 1)
        below = sum(1 for point in self.points if float(point) < value)
        return self.name(2 * below)


def read_cells(documents: tuple[Document, ...], vocabulary: Vocabulary) -> Mapping[str, Cells]:
    """Return the cells of every data property, by name."""
    points: dict[str, set[Scalar]] = {}
    iris: dict[str, str] = {}
    for document in documents:
        graph = document.graph
        for iri in graph.subjects(RDF.type, OWL.DatatypeProperty):
            if isinstance(iri, URIRef):
                iris[local_name(iri)] = str(iri)
        for entry, node in _ranges(graph, vocabulary):
            try:
                points.setdefault(entry.name, set()).update(read_range(graph, node, entry).points())
            except KnowledgeError as error:
                raise KnowledgeError(f"{document.path}: {error}") from None
    return {name: _cells(vocabulary.properties[name], iri, points.get(name)) for name, iri in sorted(iris.items())}


def _ranges(graph: Graph, vocabulary: Vocabulary) -> Iterator[tuple[Property, Node]]:
    """Yield each data property that an axiom speaks of, with the range of values of which it does."""
    mentions = [
        *((iri, filler) for node, iri in graph.subject_objects(OWL.onProperty) for filler in range_nodes(graph, node)),
        *((iri, node) for iri, node in graph.subject_objects(RDFS.range) if isinstance(node, BNode)),
        *(
            (iri, value)
            for node, iri in graph.subject_objects(OWL.assertionProperty)
            for value in graph.objects(node, OWL.targetValue)
        ),
    ]
    for iri, node in mentions:
        entry = vocabulary.properties.get(local_name(iri)) if isinstance(iri, URIRef) else None
        if entry is not None and entry.kind != "relation":
            yield entry, node


def range_nodes(graph: Graph, node: Node) -> list[Node]:
    """Return the data ranges that a restriction on a data property mentions."""
    predicates = (OWL.someValuesFrom, OWL.allValuesFrom, OWL.hasValue, OWL.onDataRange)
    found = [filler for predicate in predicates for filler in graph.objects(node, predicate)]
    counted = any(
        graph.value(node, word) is not None for word in (OWL.minCardinality, OWL.maxCardinality, OWL.cardinality)
    )
    return [*found, *([RDFS.Literal] if counted else [])]


def _cells(entry: Property, iri: str, points: set[Scalar] | None) -> Cells:
    mentioned = points is not None
    if not points:
        return Cells(iri, ("",) if entry.kind != "quantity" else (0.0,), (), mentioned)
    if entry.kind == "truth":
        return Cells(iri, ("false", "true"), ("false", "true"), mentioned)
    if entry.kind == "text":
        listed = tuple(sorted(str(point) for point in points))
        return Cells(iri, (*listed, "".join(listed) + " and any other"), listed, mentioned)
    bounds = sorted(float(point) for point in points)
    samples: list[Scalar] = [bounds[0] - 1.0 - abs(bounds[0])]
    for low, high in zip(bounds, [*bounds[1:], math.inf], strict=True):
        samples += [low, (low + high) / 2 if high < math.inf else low + 1.0 + abs(low)]
    return Cells(iri, tuple(samples), tuple(bounds), mentioned)

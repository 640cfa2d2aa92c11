"""Class expressions of a Turtle file become those of the reasoner (OWL functional syntax), each with a reading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rdflib import OWL, BNode, Graph, URIRef
from rdflib.collection import Collection
from rdflib.term import Node

from prolepsis.knowledge.cells import Cells, range_nodes, read_range
from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.knowledge.vocabulary import Property, Vocabulary
from prolepsis.terms.errors import KnowledgeError, brief

Expression = tuple[str, str]
"""A class expression in functional syntax, and as a person would write it."""

THING: Expression = ("<http://www.w3.org/2002/07/owl#Thing>", "anything")
NOTHING: Expression = ("<http://www.w3.org/2002/07/owl#Nothing>", "nothing")

_COUNTS = {
    OWL.minQualifiedCardinality: ("Min", "at least"),
    OWL.maxQualifiedCardinality: ("Max", "at most"),
    OWL.qualifiedCardinality: ("Exact", "exactly"),
    OWL.minCardinality: ("Min", "at least"),
    OWL.maxCardinality: ("Max", "at most"),
    OWL.cardinality: ("Exact", "exactly"),
}


@dataclass(frozen=True, slots=True)
class Reader:
    """Reads the expressions of one file."""

    document: Document
    vocabulary: Vocabulary
    cells: Mapping[str, Cells]
    mentioned: set[str]
    """IRIs of the classes read so far; each must be declared."""
    regions: set[tuple[str, tuple[str, ...]]]
    """Unions of cells read so far, by property."""

    @property
    def graph(self) -> Graph:
        return self.document.graph

    def expression(self, node: Node) -> Expression:
        """Return the class expression that ``node`` denotes."""
        if isinstance(node, URIRef):
            self.mentioned.add(str(node))
            return f"<{node}>", local_name(node)
        connected = self.connected(node)
        if connected is not None:
            return connected
        on = self.graph.value(node, OWL.onProperty)
        if on is not None:
            return self._restriction(node, on)
        raise KnowledgeError(f"{self.document.path}: a class expression cannot be read: {self._shown(node)}")

    def connected(self, node: Node) -> Expression | None:
        """Return what is said of ``node`` by a list or a complement: of a class with a name, what it means."""
        for predicate, functor, word in (
            (OWL.intersectionOf, "ObjectIntersectionOf", " and "),
            (OWL.unionOf, "ObjectUnionOf", " or "),
        ):
            members = self.graph.value(node, predicate)
            if members is not None:
                parts = self.listed(members)
                return joined(functor, word, parts)
        complement = self.graph.value(node, OWL.complementOf)
        if complement is not None:
            text, reading = self.expression(complement)
            return f"ObjectComplementOf({text})", f"not {reading}"
        listed = self.graph.value(node, OWL.oneOf)
        if listed is not None:
            members = sorted({str(member) for member in Collection(self.graph, listed)})
            if not members:
                return NOTHING
            names = ", ".join(local_name(URIRef(member)) for member in members)
            return f"ObjectOneOf({' '.join(f'<{m}>' for m in members)})", f"one of {names}"
        return None

    def listed(self, node: Node) -> list[Expression]:
        """Return the class expressions of a list, sorted, each once."""
        return sorted({self.expression(member) for member in Collection(self.graph, node)})

    def _shown(self, node: Node) -> str:
        said = sorted(f"{local_name(URIRef(str(p)))} {o}" for p, o in self.graph.predicate_objects(node))
        return "; ".join(said) or "it is empty"

    def role(self, node: Node) -> Expression:
        """Return a relation, or the inverse of one, and as a person would write it."""
        inverse = self.graph.value(node, OWL.inverseOf) if isinstance(node, BNode) else None
        if inverse is not None:
            return f"ObjectInverseOf(<{inverse}>)", f"inverse {local_name(URIRef(str(inverse)))}"
        return f"<{node}>", local_name(URIRef(str(node)))

    def _restriction(self, node: Node, on: Node) -> Expression:
        role, name = self.role(on)
        if name in self.cells:
            return self._data_restriction(node, name)
        for predicate, functor, word in (
            (OWL.someValuesFrom, "ObjectSomeValuesFrom", "some"),
            (OWL.allValuesFrom, "ObjectAllValuesFrom", "only"),
        ):
            filler = self.graph.value(node, predicate)
            if filler is not None:
                text, reading = self.expression(filler)
                return f"{functor}({role} {text})", f"({name} {word} {reading})"
        value = self.graph.value(node, OWL.hasValue)
        if value is not None:
            return f"ObjectHasValue({role} <{value}>)", f"({name} {local_name(URIRef(str(value)))})"
        for predicate, (functor, word) in _COUNTS.items():
            count = self.graph.value(node, predicate)
            if count is not None:
                filler = self.graph.value(node, OWL.onClass)
                text, reading = THING if filler is None else self.expression(filler)
                number = _whole(count, self.document)
                return f"Object{functor}Cardinality({number} {role} {text})", f"({name} {word} {number} {reading})"
        raise KnowledgeError(f"{self.document.path}: a restriction on {name} cannot be read: {self._shown(node)}")

    def _data_restriction(self, node: Node, name: str) -> Expression:
        nodes, entry = range_nodes(self.graph, node), self.vocabulary.properties[name]
        if not nodes:
            raise KnowledgeError(f"{self.document.path}: a restriction on {name} cannot be read: {self._shown(node)}")
        region, shown = self.region(name, nodes[0])
        some = f"ObjectSomeValuesFrom(<{entry.iri}> {region})", f"({name} {shown})"
        for predicate, (functor, word) in _COUNTS.items():
            count = self.graph.value(node, predicate)
            if count is not None:
                reading = f"({name} {word} {count} {shown})"
                return self._data_count(functor, _whole(count, self.document), entry, some), reading
        if self.graph.value(node, OWL.allValuesFrom) is not None:
            return f"ObjectAllValuesFrom(<{entry.iri}> {region})", f"({name} only {shown})"
        return some

    def _data_count(self, functor: str, count: int, entry: Property, some: Expression) -> str:
        """Return an expression for a count of values: whether there is one says all where there is at most one."""
        none = f"ObjectComplementOf({some[0]})"
        least, most = functor != "Max" and count > 0, functor != "Min"
        if (least and count > 1) or (most and count > 0):
            if not entry.functional:
                told = f"a count of {count} of {entry.name}, which may have several values, is not read"
                raise KnowledgeError(
                    f"{self.document.path}: {told}; allowed: owl:someValuesFrom, or an owl:FunctionalProperty"
                )
            return NOTHING[0] if least and count > 1 else some[0] if least else THING[0]
        return some[0] if least else none if most else THING[0]

    def region(self, name: str, node: Node) -> Expression:
        """Return the class of the values in a data range of the property, and the range in words."""
        cells, values = self.cells[name], read_range(self.graph, node, self.vocabulary.properties[name])
        inside = cells.within(values)
        if 1 < len(inside) < len(cells.samples):
            self.regions.add((name, inside))
        return (cells.region(inside) if inside else NOTHING[0]), str(values)


def _whole(count: Node, document: Document) -> int:
    text = str(count)
    if not (text.isdecimal() and len(text) < 10):
        raise KnowledgeError(f"{document.path}: a count must be a whole number of at least 0, not {brief(repr(text))}")
    return int(text)


def joined(functor: str, word: str, parts: list[Expression]) -> Expression:
    """Return several expressions as one."""
    if not parts:
        return THING if functor == "ObjectIntersectionOf" else NOTHING
    if len(parts) == 1:
        return parts[0]
    return f"{functor}({' '.join(text for text, _ in parts)})", f"({word.join(reading for _, reading in parts)})"

"""Axioms as the reasoner reads them (OWL functional syntax), each with a reading and the file it comes from."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rdflib import OWL, RDF, RDFS, BNode, Graph, URIRef
from rdflib.collection import Collection
from rdflib.term import Node

from prolepsis.knowledge.cells import Cells, range_nodes, read_cells, read_range
from prolepsis.knowledge.situation import Situation
from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.knowledge.vocabulary import Vocabulary
from prolepsis.terms.errors import KnowledgeError


@dataclass(frozen=True, order=True, slots=True)
class Axiom:
    """One axiom."""

    text: str
    """In functional syntax, without prefixes."""
    reading: str = ""
    """As a person would say it."""
    where: str = ""
    """File and line, or what it follows from."""


Expression = tuple[str, str]
"""A class expression in functional syntax, and as a person would write it."""

THING: Expression = ("<http://www.w3.org/2002/07/owl#Thing>", "anything")
NOTHING: Expression = ("<http://www.w3.org/2002/07/owl#Nothing>", "nothing")

_IRI = re.compile(r"<([^<>]*)>")

_PROPERTY_TYPES = {
    OWL.FunctionalProperty: ("FunctionalObjectProperty", "has at most one value"),
    OWL.InverseFunctionalProperty: ("InverseFunctionalObjectProperty", "has at most one subject"),
    OWL.TransitiveProperty: ("TransitiveObjectProperty", "is transitive"),
    OWL.SymmetricProperty: ("SymmetricObjectProperty", "is symmetric"),
    OWL.AsymmetricProperty: ("AsymmetricObjectProperty", "is asymmetric"),
    OWL.ReflexiveProperty: ("ReflexiveObjectProperty", "is reflexive"),
    OWL.IrreflexiveProperty: ("IrreflexiveObjectProperty", "is irreflexive"),
}
_PROPERTY_PAIRS = {
    RDFS.subPropertyOf: ("SubObjectPropertyOf", "is a kind of"),
    OWL.inverseOf: ("InverseObjectProperties", "is the inverse of"),
    OWL.equivalentProperty: ("EquivalentObjectProperties", "is the same as"),
    OWL.propertyDisjointWith: ("DisjointObjectProperties", "excludes"),
}
_CLASS_PAIRS = {
    RDFS.subClassOf: ("SubClassOf", "every {} is {}"),
    OWL.equivalentClass: ("EquivalentClasses", "{} means {}"),
    OWL.disjointWith: ("DisjointClasses", "no {} is {}"),
}
_COUNTS = {
    OWL.minQualifiedCardinality: ("Min", "at least"),
    OWL.maxQualifiedCardinality: ("Max", "at most"),
    OWL.qualifiedCardinality: ("Exact", "exactly"),
    OWL.minCardinality: ("Min", "at least"),
    OWL.maxCardinality: ("Max", "at most"),
    OWL.cardinality: ("Exact", "exactly"),
}


@dataclass(frozen=True, slots=True)
class _Reader:
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
        for predicate, functor, word in (
            (OWL.intersectionOf, "ObjectIntersectionOf", " and "),
            (OWL.unionOf, "ObjectUnionOf", " or "),
        ):
            members = self.graph.value(node, predicate)
            if members is not None:
                parts = sorted(self.expression(member) for member in Collection(self.graph, members))
                return _joined(functor, word, parts)
        complement = self.graph.value(node, OWL.complementOf)
        if complement is not None:
            text, reading = self.expression(complement)
            return f"ObjectComplementOf({text})", f"not {reading}"
        listed = self.graph.value(node, OWL.oneOf)
        if listed is not None:
            members = sorted(str(member) for member in Collection(self.graph, listed))
            names = ", ".join(local_name(URIRef(member)) for member in members)
            return f"ObjectOneOf({' '.join(f'<{m}>' for m in members)})", f"one of {names}"
        on = self.graph.value(node, OWL.onProperty)
        if on is not None:
            return self._restriction(node, on)
        raise KnowledgeError(f"{self.document.path}: a class expression cannot be read: {self._shown(node)}")

    def _shown(self, node: Node) -> str:
        said = sorted(f"{local_name(URIRef(str(p)))} {o}" for p, o in self.graph.predicate_objects(node))
        return "; ".join(said) or "it is empty"

    def _restriction(self, node: Node, on: Node) -> Expression:
        inverse = self.graph.value(on, OWL.inverseOf) if isinstance(on, BNode) else None
        role = f"ObjectInverseOf(<{inverse}>)" if inverse is not None else f"<{on}>"
        name = f"inverse {local_name(URIRef(str(inverse)))}" if inverse is not None else local_name(URIRef(str(on)))
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
                return f"Object{functor}Cardinality({count} {role} {text})", f"({name} {word} {count} {reading})"
        raise KnowledgeError(f"{self.document.path}: a restriction on {name} cannot be read: {self._shown(node)}")

    def _data_restriction(self, node: Node, name: str) -> Expression:
        nodes, entry, cells = range_nodes(self.graph, node), self.vocabulary.properties[name], self.cells[name]
        if not nodes:
            raise KnowledgeError(f"{self.document.path}: a restriction on {name} cannot be read: {self._shown(node)}")
        values = read_range(self.graph, nodes[0], entry)
        inside = cells.within(values)
        union = cells.region(inside) if inside else NOTHING[0]
        if 1 < len(inside) < len(cells.samples):
            self.regions.add((name, inside))
        only = self.graph.value(node, OWL.allValuesFrom) is not None
        functor = "ObjectAllValuesFrom" if only else "ObjectSomeValuesFrom"
        return f"{functor}(<{cells.iri}> {union})", f"({name} {'only ' if only else ''}{values})"


def _joined(functor: str, word: str, parts: list[Expression]) -> Expression:
    if len(parts) == 1:
        return parts[0]
    return f"{functor}({' '.join(text for text, _ in parts)})", f"({word.join(reading for _, reading in parts)})"


def terminology(
    documents: tuple[Document, ...], vocabulary: Vocabulary
) -> tuple[tuple[Axiom, ...], Mapping[str, Cells]]:
    """Return the axioms of classes and properties, sorted, and the cells of the data properties."""
    cells = read_cells(documents, vocabulary)
    axioms: list[Axiom] = []
    classes = {entry.iri for entry in vocabulary.classes.values()}
    regions: set[tuple[str, tuple[str, ...]]] = set()
    for document in documents:
        reader = _Reader(document, vocabulary, cells, classes, regions)
        axioms += [*_class_axioms(reader), *_property_axioms(reader)]
    axioms += _cell_axioms(cells, regions)
    axioms += [Axiom(f"Declaration(Class(<{iri}>))") for iri in sorted(classes)]
    axioms += [
        Axiom(f"Declaration(Class({name}))") for own in cells.values() if len(own.samples) > 1 for name in own.all()
    ]
    used = {token for axiom in axioms for token in _IRI.findall(axiom.text) if "Functional" not in axiom.text}
    idle = {entry.iri for entry in vocabulary.properties.values() if entry.kind != "relation"} - used
    axioms = [a for a in axioms if not idle.intersection(_IRI.findall(a.text))]
    roles = [entry.iri for entry in vocabulary.properties.values() if entry.iri not in idle]
    axioms += [Axiom(f"Declaration(ObjectProperty(<{iri}>))") for iri in roles]
    return tuple(sorted(set(axioms))), cells


def _class_axioms(reader: _Reader) -> Iterator[Axiom]:
    graph, document = reader.graph, reader.document
    for predicate, (functor, words) in _CLASS_PAIRS.items():
        for subject, node in graph.subject_objects(predicate):
            if isinstance(subject, URIRef):
                (left, left_reading), (right, right_reading) = reader.expression(subject), reader.expression(node)
                reading = words.format(left_reading, _with_article(right_reading))
                yield Axiom(f"{functor}({left} {right})", reading, document.where(subject))
    for subject, node in graph.subject_objects(RDF.type):
        if isinstance(subject, URIRef) and isinstance(node, BNode):
            text, reading = reader.expression(node)
            said = f"{local_name(subject)} is {_with_article(reading)}"
            yield Axiom(f"ClassAssertion({text} <{subject}>)", said, document.where(subject))
    for subject in graph.subjects(RDF.type, OWL.AllDisjointClasses):
        listed = graph.value(subject, OWL.members)
        members = [] if listed is None else sorted(reader.expression(m) for m in Collection(graph, listed))
        reading = f"nothing is two of {', '.join(r for _, r in members)}"
        yield Axiom(f"DisjointClasses({' '.join(t for t, _ in members)})", reading, str(document.path))


def _property_axioms(reader: _Reader) -> Iterator[Axiom]:
    graph, document = reader.graph, reader.document
    for kind, (functor, words) in _PROPERTY_TYPES.items():
        for subject in graph.subjects(RDF.type, kind):
            if isinstance(subject, URIRef):
                yield Axiom(f"{functor}(<{subject}>)", f"{local_name(subject)} {words}", document.where(subject))
    for predicate, (functor, words) in _PROPERTY_PAIRS.items():
        for subject, other in graph.subject_objects(predicate):
            if isinstance(subject, URIRef) and isinstance(other, URIRef):
                reading = f"{local_name(subject)} {words} {local_name(other)}"
                yield Axiom(f"{functor}(<{subject}> <{other}>)", reading, document.where(subject))
    for predicate, functor, words in (
        (RDFS.domain, "ObjectPropertyDomain", "what has {} is {}"),
        (RDFS.range, "ObjectPropertyRange", "every {} is {}"),
    ):
        for subject, node in graph.subject_objects(predicate):
            is_data_range = predicate == RDFS.range and local_name(URIRef(str(subject))) in reader.cells
            if isinstance(subject, URIRef) and not is_data_range:
                text, reading = reader.expression(node)
                said = words.format(local_name(subject), _with_article(reading))
                yield Axiom(f"{functor}(<{subject}> {text})", said, document.where(subject))
    for subject, node in graph.subject_objects(OWL.propertyChainAxiom):
        chain = [str(member) for member in Collection(graph, node)]
        text = f"SubObjectPropertyOf(ObjectPropertyChain({' '.join(f'<{c}>' for c in chain)}) <{subject}>)"
        reading = f"{' of '.join(local_name(URIRef(c)) for c in chain)} implies {local_name(URIRef(str(subject)))}"
        yield Axiom(text, reading, document.where(URIRef(str(subject))))


def _cell_axioms(cells: Mapping[str, Cells], regions: set[tuple[str, tuple[str, ...]]]) -> Iterator[Axiom]:
    for own in cells.values():
        if len(own.samples) > 1:
            yield Axiom(f"DisjointClasses({' '.join(own.all())})")
    for name, inside in sorted(regions):
        # A union would make the reasoner guess; a class of its own between the cells says as much of any one value.
        region = cells[name].region(inside)
        yield Axiom(f"Declaration(Class({region}))")
        for cell in cells[name].all():
            functor = "SubClassOf" if cell in inside else "DisjointClasses"
            yield Axiom(f"{functor}({cell} {region})")


def assertions(
    situation: Situation, vocabulary: Vocabulary, cells: Mapping[str, Cells], terms: tuple[Axiom, ...]
) -> tuple[Axiom, ...]:
    """Return the axioms of individuals, sorted.

    Of the values, only those count that an axiom can tell apart. A value that is not stated is the default of
    the individual's *told* classes; the defaults of inferred classes do not take part, so that inference does
    not depend on itself.
    """
    domains = {a.text.split("<", 1)[1].split(">", 1)[0] for a in terms if a.text.startswith("ObjectPropertyDomain")}
    axioms: list[Axiom] = []
    for name, told in situation.classes.items():
        iri, location = situation.iris[name], situation.locations[name]
        for class_name in told:
            reading = f"{name} is {_with_article(class_name)}"
            axioms.append(Axiom(f"ClassAssertion(<{vocabulary.classes[class_name].iri}> <{iri}>)", reading, location))
        for entry_name, own in cells.items():
            default = (
                None
                if (name, entry_name) in situation.said or len(own.samples) < 2
                else told_default(vocabulary, told, entry_name)
            )
            if default is not None:
                class_name, value = default
                said, where = (
                    f"{name} {entry_name} {value:g}" if isinstance(value, float) else "",
                    f"default of {class_name}",
                )
                axioms.append(Axiom(_some(own, value, iri), said or f"{name} {entry_name} {value}", where))
    for s in situation.statements:
        iri, entry = situation.iris[s.subject], vocabulary.properties[s.property]
        shown = f"{s.value:g}" if isinstance(s.value, float) else s.value
        reading = f"{s.subject} {s.property} {shown}"
        if entry.kind == "relation":
            text = f"ObjectPropertyAssertion(<{entry.iri}> <{iri}> <{situation.iris[str(s.value)]}>)"
            axioms.append(Axiom(text, reading, s.where))
        elif len(cells[s.property].samples) > 1 or entry.iri in domains:
            axioms.append(Axiom(_some(cells[s.property], s.value, iri), reading, s.where))
    names = " ".join(f"<{situation.iris[name]}>" for name in situation.classes)
    axioms.append(Axiom(f"DifferentIndividuals({names})", "two names are two things"))
    return tuple(sorted(set(axioms)))


def _some(cells: Cells, value: float | str, iri: str) -> str:
    cell = cells.of(value) if len(cells.samples) > 1 else THING[0]
    return f"ClassAssertion(ObjectSomeValuesFrom(<{cells.iri}> {cell}) <{iri}>)"


def told_default(vocabulary: Vocabulary, told: tuple[str, ...], property_name: str) -> tuple[str, float | str] | None:
    """Return class and value of the default that the told classes give, the most specific first."""
    candidates = {
        c: d.value
        for c in vocabulary.told_classes(told)
        for d in vocabulary.classes[c].defaults
        if d.property == property_name
    }
    best = [c for c in candidates if not any(o != c and c in vocabulary.told_classes((o,)) for o in candidates)]
    return (best[0], candidates[best[0]]) if best else None


def _with_article(reading: str) -> str:
    if reading.startswith("(") or reading.startswith(("not ", "one of ")):
        return reading.removeprefix("(").removesuffix(")") if reading.startswith("(") else reading
    return f"{'an' if reading[0] in 'AEIOU' else 'a'} {reading}"

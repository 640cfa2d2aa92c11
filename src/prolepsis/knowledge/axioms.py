"""Axioms as the reasoner reads them (OWL functional syntax), each with a reading and the file it comes from."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

from rdflib import OWL, RDF, RDFS, BNode, URIRef
from rdflib.collection import Collection

from prolepsis.knowledge.cells import Cells, read_cells
from prolepsis.knowledge.expressions import THING, Expression, Reader, joined
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
_MEANINGS = (OWL.intersectionOf, OWL.unionOf, OWL.complementOf, OWL.oneOf)
_TARGETS = ("an owl:targetIndividual", "an owl:targetValue")


def terminology(
    documents: tuple[Document, ...], vocabulary: Vocabulary
) -> tuple[tuple[Axiom, ...], Mapping[str, Cells]]:
    """Return the axioms of classes and properties, sorted, and the cells of the data properties."""
    cells = read_cells(documents, vocabulary)
    axioms: list[Axiom] = []
    classes = {entry.iri for entry in vocabulary.classes.values()}
    regions: set[tuple[str, tuple[str, ...]]] = set()
    for document in documents:
        reader = Reader(document, vocabulary, cells, classes, regions)
        axioms += [*_class_axioms(reader), *_property_axioms(reader), *_denied(reader)]
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


def _class_axioms(reader: Reader) -> Iterator[Axiom]:
    graph, document = reader.graph, reader.document
    for predicate, (functor, words) in _CLASS_PAIRS.items():
        for subject, node in graph.subject_objects(predicate):
            (left, left_reading), (right, right_reading) = reader.expression(subject), reader.expression(node)
            reading = words.format(left_reading.removeprefix("(").removesuffix(")"), with_article(right_reading))
            yield Axiom(f"{functor}({left} {right})", reading, document.where(subject))
    for subject in sorted({s for word in _MEANINGS for s in graph.subjects(word) if isinstance(s, URIRef)}):
        meaning = reader.connected(subject)
        if meaning is not None:
            reading = f"{local_name(subject)} means {with_article(meaning[1])}"
            yield Axiom(f"EquivalentClasses(<{subject}> {meaning[0]})", reading, document.where(subject))
    for subject, node in graph.subject_objects(OWL.disjointUnionOf):
        parts = reader.listed(node)
        text, said = joined("ObjectUnionOf", " or ", parts)
        name, where = local_name(URIRef(str(subject))), document.where(subject)
        yield Axiom(f"EquivalentClasses(<{subject}> {text})", f"{name} means {with_article(said)}", where)
        yield from _apart(parts, where)
    for subject, node in graph.subject_objects(RDF.type):
        if isinstance(subject, URIRef) and isinstance(node, BNode):
            text, reading = reader.expression(node)
            said = f"{local_name(subject)} is {with_article(reading)}"
            yield Axiom(f"ClassAssertion({text} <{subject}>)", said, document.where(subject))
    for subject in graph.subjects(RDF.type, OWL.AllDisjointClasses):
        for listed in graph.objects(subject, OWL.members):
            yield from _apart(reader.listed(listed), str(document.path))


def _apart(parts: list[Expression], where: str) -> Iterator[Axiom]:
    if len(parts) > 1:
        reading = f"nothing is two of {', '.join(reading for _, reading in parts)}"
        yield Axiom(f"DisjointClasses({' '.join(text for text, _ in parts)})", reading, where)


def _denied(reader: Reader) -> Iterator[Axiom]:
    """Yield what is said not to be so: that an individual is among those who have the value."""
    graph, document = reader.graph, reader.document
    for node in graph.subjects(RDF.type, OWL.NegativePropertyAssertion):
        subject, role = graph.value(node, OWL.sourceIndividual), graph.value(node, OWL.assertionProperty)
        target, value = graph.value(node, OWL.targetIndividual), graph.value(node, OWL.targetValue)
        name = local_name(URIRef(str(role)))
        if (target is None) != (name in reader.cells):
            raise KnowledgeError(f"{document.path}: a denial of {name} needs {_TARGETS[name in reader.cells]}")
        if value is not None:
            region, shown = reader.region(name, value)
            has = f"ObjectSomeValuesFrom(<{role}> {region})"
        else:
            has, shown = f"ObjectHasValue(<{role}> <{target}>)", local_name(URIRef(str(target)))
        said = f"not {local_name(URIRef(str(subject)))} {name} {shown}"
        yield Axiom(f"SubClassOf(ObjectOneOf(<{subject}>) ObjectComplementOf({has}))", said, str(document.path))


def _property_axioms(reader: Reader) -> Iterator[Axiom]:
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
            if isinstance(subject, URIRef) and not (is_data_range and isinstance(node, URIRef)):
                name = local_name(subject)
                text, reading = reader.region(name, node) if is_data_range else reader.expression(node)
                said = words.format(name, reading if is_data_range else with_article(reading))
                yield Axiom(f"{functor}(<{subject}> {text})", said, document.where(subject))
    for subject, node in graph.subject_objects(OWL.propertyChainAxiom):
        chain = [reader.role(member) for member in Collection(graph, node)]
        text = f"SubObjectPropertyOf(ObjectPropertyChain({' '.join(role for role, _ in chain)}) <{subject}>)"
        reading = f"{' of '.join(name for _, name in chain)} implies {local_name(URIRef(str(subject)))}"
        yield Axiom(text, reading, document.where(URIRef(str(subject))))
    for subject in graph.subjects(RDF.type, OWL.AllDisjointProperties):
        for listed in graph.objects(subject, OWL.members):
            for one, other in combinations(sorted({str(member) for member in Collection(graph, listed)}), 2):
                reading = f"{local_name(URIRef(one))} excludes {local_name(URIRef(other))}"
                yield Axiom(f"DisjointObjectProperties(<{one}> <{other}>)", reading, str(document.path))


def _cell_axioms(cells: Mapping[str, Cells], regions: set[tuple[str, tuple[str, ...]]]) -> Iterator[Axiom]:
    for own in cells.values():
        if len(own.samples) > 1:
            yield Axiom(f"DisjointClasses({' '.join(own.all())})")
            yield Axiom(f"ObjectPropertyRange(<{own.iri}> ObjectUnionOf({' '.join(own.all())}))")
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
            reading = f"{name} is {with_article(class_name)}"
            axioms.append(Axiom(f"ClassAssertion(<{vocabulary.classes[class_name].iri}> <{iri}>)", reading, location))
        for entry_name, own in cells.items():
            default = (
                None
                if (name, entry_name) in situation.said or not own.mentioned
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
        elif cells[s.property].mentioned or entry.iri in domains:
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


def with_article(reading: str) -> str:
    """Return a reading of a class expression as it stands after "is": ``an Egg``."""
    if reading.startswith("(") or reading.startswith(("not ", "one of ")):
        return reading.removeprefix("(").removesuffix(")") if reading.startswith("(") else reading
    return f"{'an' if reading[0] in 'AEIOU' else 'a'} {reading}"

"""Declarations: the classes and properties that Turtle files declare become the vocabulary."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from rdflib import OWL, RDF, RDFS, XSD, BNode, Graph, Literal, Namespace, URIRef
from rdflib.collection import Collection
from rdflib.term import Node

from prolepsis.knowledge.sources import NAMESPACE
from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.knowledge.vocabulary import (
    CERTAINTIES,
    INVERSE_OF,
    ClassEntry,
    Curve,
    Default,
    DefaultPart,
    Property,
    Vocabulary,
)
from prolepsis.knowledge.written import read_value
from prolepsis.terms.errors import KnowledgeError, brief
from prolepsis.terms.units import qudt_symbol, unit_of

PRO = Namespace(NAMESPACE)
HAS_UNIT = URIRef("http://qudt.org/schema/qudt/hasUnit")


def read_vocabulary(documents: tuple[Document, ...]) -> Vocabulary:
    """Return the classes and properties that ``documents`` declare.

    Raises:
        KnowledgeError: If a unit is unknown, or a default lacks property, value, source or certainty.
    """
    properties: dict[str, Property] = {}
    for document in documents:
        for iri in _named(document, OWL.DatatypeProperty, OWL.ObjectProperty):
            entry = _property(document, iri)
            known = properties.get(entry.name)
            _refuse_second_name(document, iri, known)
            # The file of correspondences declares properties anew.
            properties[entry.name] = entry if known is None else _more_aligned(known, entry)
    for entry in properties.values():
        _refuse_unlike(documents, entry, properties)
    for document in documents:
        # A file may say more of a property that another one declares.
        for field, iri, other in _between_properties(document):
            known = properties.get(local_name(iri))
            if known is not None and known.iri == str(iri):
                told = {*(known.parents if field == "parents" else known.inverses), local_name(other)}
                properties[known.name] = replace(known, **{field: tuple(sorted(told))})
    classes: dict[str, ClassEntry] = {}
    for document in documents:
        for iri in _named(document, OWL.Class):
            entry = _class(document, iri, properties)
            _refuse_second_name(document, iri, classes.get(entry.name, properties.get(entry.name)))
            classes[entry.name] = _joined(classes[entry.name], entry) if entry.name in classes else entry
    for document in documents:
        # A file may say more of a class that another one declares.
        said = {iri for iri in document.graph.subjects(RDFS.subClassOf) if isinstance(iri, URIRef)}
        for iri in sorted(said.difference(_named(document, OWL.Class))):
            known = classes.get(local_name(iri))
            if known is not None and known.iri == str(iri):
                classes[known.name] = _joined(known, _class(document, iri, properties))
    return Vocabulary(classes=dict(sorted(classes.items())), properties=dict(sorted(properties.items())))


def _refuse_unlike(documents: tuple[Document, ...], entry: Property, properties: Mapping[str, Property]) -> None:
    """Refuse a property that is bounded by what cannot be compared with it."""
    for name in filter(None, (entry.at_least_of, entry.at_most_of)):
        other = properties.get(name)
        if other is None or other.kind != "quantity" or other.si_unit != entry.si_unit:
            where = next(d.where(URIRef(entry.iri)) for d in documents if (URIRef(entry.iri), None, None) in d.graph)
            raise KnowledgeError(
                f"{where}: {entry.name} is bounded by {name}; allowed: a number, or a property with the same unit"
            )


def _between_properties(document: Document) -> Iterator[tuple[str, URIRef, URIRef]]:
    """Yield which field of the first property names the second."""
    graph = document.graph
    same = {
        pair for one, other in graph.subject_objects(OWL.equivalentProperty) for pair in ((one, other), (other, one))
    }
    symmetric = {(iri, iri) for iri in graph.subjects(RDF.type, OWL.SymmetricProperty)}
    told = (
        ("parents", {*graph.subject_objects(RDFS.subPropertyOf), *same}),
        ("inverses", {*graph.subject_objects(OWL.inverseOf), *symmetric}),
    )
    for field, pairs in told:
        for iri, other in sorted(pairs, key=str):
            if isinstance(iri, URIRef) and isinstance(other, URIRef):
                yield field, iri, other


def _refuse_second_name(document: Document, iri: URIRef, known: Property | ClassEntry | None) -> None:
    if known is not None and known.iri != str(iri):
        told = f"two things are called {known.name}: <{known.iri}> and <{iri}>; name one otherwise"
        raise KnowledgeError(f"{document.where(iri)}: {told}")


def _more_aligned(first: Property, second: Property) -> Property:
    more, fewer = (first, second) if first.comment else (second, first)
    return replace(more, alignments=tuple(sorted({*more.alignments, *fewer.alignments})))


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
    numbers = sorted((n for n in document.graph.objects(subject, predicate) if not isinstance(n, URIRef)), key=str)
    node = numbers[0] if numbers else None
    try:
        return None if node is None else float(str(node))
    except ValueError:
        where = document.where(subject) if isinstance(subject, URIRef) else str(document.path)
        raise KnowledgeError(
            f"{where}: {local_name(predicate)} must be a number, not {brief(repr(str(node)))}"
        ) from None


def _property_named(document: Document, subject: URIRef, predicate: URIRef) -> str:
    """Return the other property that bounds a property, empty if there is none."""
    names = sorted(local_name(n) for n in document.graph.objects(subject, predicate) if isinstance(n, URIRef))
    return names[0] if names else ""


def _property(document: Document, iri: URIRef) -> Property:
    graph = document.graph
    ranges = [local_name(r) for r in graph.objects(iri, RDFS.range) if isinstance(r, URIRef)]
    unit_node = _one(document, iri, HAS_UNIT)
    unit, kind = "", "relation"
    if (iri, RDF.type, OWL.DatatypeProperty) in graph:
        kind = "truth" if (iri, RDFS.range, XSD.boolean) in graph else "text"
        if kind == "text" and unit_node is None and {"double", "float", "decimal", "integer"} & {*ranges}:
            raise KnowledgeError(
                f"{document.where(iri)}: property {local_name(iri)} is a number without a unit; state qudt:hasUnit, "
                "for a pure number unit:UNITLESS"
            )
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
        at_least_of=_property_named(document, iri, PRO.atLeast),
        at_most_of=_property_named(document, iri, PRO.atMost),
        whole=(iri, PRO.whole, Literal(True)) in graph,
        of_parts=(iri, PRO.ofParts, Literal(True)) in graph,
        functional=(iri, RDF.type, OWL.FunctionalProperty) in graph,
        parents=tuple(sorted(local_name(p) for p in graph.objects(iri, RDFS.subPropertyOf) if isinstance(p, URIRef))),
        range=ranges[0] if ranges and kind == "relation" else "",
        alignments=tuple(sorted(str(o) for o in graph.objects(iri, PRO.alignedWith))),
        comment=_text(document, iri, RDFS.comment),
    )


def _class(document: Document, iri: URIRef, properties: Mapping[str, Property]) -> ClassEntry:
    graph = document.graph
    parents = [p for p in graph.objects(iri, RDFS.subClassOf) if isinstance(p, URIRef)]
    for meaning in graph.objects(iri, OWL.equivalentClass):
        for members in graph.objects(meaning, OWL.intersectionOf):
            parents += [member for member in Collection(graph, members) if isinstance(member, URIRef)]
    same = [e for e in graph.objects(iri, OWL.equivalentClass) if isinstance(e, URIRef)]
    parents += same
    others = [m for m in graph.objects(iri, PRO.alignedWith) if isinstance(m, URIRef)]
    own = [p for p in parents if not is_aligned(p)]
    return ClassEntry(
        name=local_name(iri),
        iri=str(iri),
        parents=tuple(sorted(local_name(p) for p in own)),
        defined=any(isinstance(e, BNode) or not is_aligned(e) for e in graph.objects(iri, OWL.equivalentClass)),
        conditions=_conditions(document, iri),
        defaults=tuple(sorted(_defaults(document, iri, properties), key=lambda d: d.property)),
        curves=tuple(sorted(_curves(document, iri, properties), key=lambda c: c.property)),
        limits=tuple(sorted(_limits(document, iri, properties), key=lambda p: p.name)),
        parts=tuple(sorted(_parts(document, iri, properties), key=lambda p: p.kind)),
        needs_whole=tuple(sorted(local_name(w) for w in graph.objects(iri, PRO.needsWhole) if isinstance(w, URIRef))),
        called=_word(document, iri),
        alignments=tuple(sorted({str(p) for p in parents + others if is_aligned(p)})),
        comment=_text(document, iri, RDFS.comment),
    )


def _conditions(document: Document, iri: URIRef) -> tuple[tuple[str, str], ...]:
    """Return what a definition asks for, one row each; nothing if a part of it is of another form, or there are two."""
    graph, found = document.graph, list[tuple[str, str]]()
    told = {*graph.objects(iri, OWL.equivalentClass), *graph.subjects(OWL.equivalentClass, iri)}
    meanings = [e for e in told if isinstance(e, BNode)] or [e for e in told if not is_aligned(e)]
    if len(meanings) != 1:
        return ()
    members = graph.value(meanings[0], OWL.intersectionOf)
    for member in meanings if members is None else Collection(graph, members):
        on = _asked(graph, graph.value(member, OWL.onProperty))
        truth, some = graph.value(member, OWL.hasValue), graph.value(member, OWL.someValuesFrom)
        if isinstance(member, URIRef):
            found.append(("is a", local_name(member)))
        elif on and isinstance(truth, Literal) and truth.value is True:
            found.append((on, "is true"))
        elif on and isinstance(some, URIRef) and not str(some).startswith(str(XSD)):
            found.append((on, "" if some == OWL.Thing else local_name(some)))
        else:
            return ()
    return tuple(sorted(found))


def _asked(graph: Graph, on: Node | None) -> str:
    """Return a property as conditions name it, empty if it has no name."""
    if isinstance(on, URIRef):
        return local_name(on)
    inverse = None if on is None else graph.value(on, OWL.inverseOf)
    return f"{INVERSE_OF}{local_name(inverse)}" if isinstance(inverse, URIRef) else ""


def _word(document: Document, iri: URIRef) -> str:
    word = _text(document, iri, PRO.called)
    if word and not (word.isascii() and word.isalpha() and word.islower()):
        told = f"parts of class {local_name(iri)} are called {brief(repr(word))}"
        raise KnowledgeError(f"{document.where(iri)}: {told}; allowed: small letters")
    return word


def is_aligned(iri: Node) -> bool:
    """Return whether a name is of an ontology that ours is aligned with, and that is not read."""
    return "ontologydesignpatterns.org" in str(iri) or "ease-crc.org" in str(iri)


def _joined(first: ClassEntry, second: ClassEntry) -> ClassEntry:
    """Return what two files say of one class."""
    return ClassEntry(
        name=first.name,
        iri=first.iri,
        parents=tuple(sorted({*first.parents, *second.parents})),
        defined=first.defined or second.defined,
        conditions=() if first.conditions and second.conditions else first.conditions or second.conditions,
        defaults=tuple(sorted((*first.defaults, *second.defaults), key=lambda d: d.property)),
        curves=(*first.curves, *second.curves),
        limits=(*first.limits, *second.limits),
        parts=tuple(sorted((*first.parts, *second.parts), key=lambda p: p.kind)),
        needs_whole=tuple(sorted({*first.needs_whole, *second.needs_whole})),
        called=first.called or second.called,
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
            f"{document.where(iri)}: {what} of {local_name(iri)} has the certainty {brief(repr(certainty), 30)}; "
            f"known: {known}"
        )
    return source, certainty


def _of(document: Document, iri: URIRef, node: Node, what: str, properties: Mapping[str, Property]) -> Property:
    of = _one(document, node, PRO.of)
    name = local_name(of) if isinstance(of, URIRef) else "nothing"
    if name not in properties:
        raise KnowledgeError(f"{document.where(iri)}: {what} {name} of {local_name(iri)} is of no known property")
    return properties[name]


def _limits(document: Document, iri: URIRef, properties: Mapping[str, Property]) -> Iterator[Property]:
    for node in document.graph.objects(iri, PRO.limit):
        among = (local_name(o) for o in document.graph.objects(node, PRO.among) if isinstance(o, URIRef))
        yield replace(
            _of(document, iri, node, "the limit", properties),
            above=_number(document, node, PRO.above),
            at_least=_number(document, node, PRO.atLeast),
            at_most=_number(document, node, PRO.atMost),
            among=tuple(sorted(among)),
        )


def _curves(document: Document, iri: URIRef, properties: Mapping[str, Property]) -> Iterator[Curve]:
    for node in document.graph.objects(iri, PRO.curve):
        entry = _of(document, iri, node, "the curve", properties)
        over = properties.get(local_name(URIRef(str(_one(document, node, PRO.over)))))
        what = f"the curve {entry.name}"
        where = f"{document.where(iri)}: {what} of {local_name(iri)}"
        if over is None:
            raise KnowledgeError(f"{where} has no :over, the property that it depends on")
        source, certainty = _provenance(document, iri, node, what)
        points: list[tuple[float, float]] = []
        for point in document.graph.objects(node, PRO.point):
            ends = (_one(document, point, PRO.at), _one(document, point, PRO.value))
            read = [
                read_value(each, end, where=where)
                for each, end in zip((over, entry), ends, strict=True)
                if end is not None
            ]
            if len(read) != 2 or not isinstance(read[0], float) or not isinstance(read[1], float) or read[1] <= 0:
                raise KnowledgeError(f"{where}: a point needs :at and a positive :value")
            points.append((read[0], read[1]))
        if len({a for a, _ in points}) < max(len(points), 2):
            raise KnowledgeError(f"{where} needs two points or more, each :at another place")
        yield Curve(
            property=entry.name, over=over.name, points=tuple(sorted(points)), source=source, certainty=certainty
        )


def _defaults(document: Document, iri: URIRef, properties: Mapping[str, Property]) -> Iterator[Default]:
    for node in document.graph.objects(iri, PRO.default):
        entry = _of(document, iri, node, "the default", properties)
        what = f"the default {entry.name}"
        source, certainty = _provenance(document, iri, node, what)
        value = _one(document, node, PRO.value)
        if value is None:
            raise KnowledgeError(f"{document.where(iri)}: {what} of {local_name(iri)} has no :value")
        where = f"{document.where(iri)}: {what} of {local_name(iri)}"
        stated, within = _one(document, node, PRO.deviation), _one(document, node, PRO.batchDeviation)
        deviation = 0.0 if stated is None else _deviation(entry, stated, where)
        batch_deviation = deviation if within is None else _deviation(entry, within, where)
        if batch_deviation > deviation:
            raise KnowledgeError(f"{where}: the batchDeviation must not be greater than the deviation")
        yield Default(
            property=entry.name,
            value=read_value(entry, value, where=where),
            deviation=deviation,
            batch_deviation=batch_deviation,
            source=source,
            certainty=certainty,
        )


def _deviation(entry: Property, node: Node, where: str) -> float:
    try:
        number = float(str(node))
    except ValueError:
        number = math.nan
    if entry.kind != "quantity" or not (math.isfinite(number) and number >= 0.0):
        raise KnowledgeError(
            f"{where}: the deviation must be a finite number of at least 0, in the property's unit, not "
            f"{brief(repr(str(node)))}"
        )
    return number * unit_of(entry.unit).factor


def _parts(document: Document, iri: URIRef, properties: Mapping[str, Property]) -> Iterator[DefaultPart]:
    for node in document.graph.objects(iri, PRO.defaultPart):
        of, unless = _one(document, node, PRO.of), _one(document, node, PRO.unless)
        if not isinstance(of, URIRef):
            raise KnowledgeError(f"{document.where(iri)}: a default part of {local_name(iri)} has no :of")
        source, certainty = _provenance(document, iri, node, f"the default part {local_name(of)}")
        kind = local_name(of)
        unless_name = local_name(unless) if isinstance(unless, URIRef) else kind
        counted = _one(document, node, PRO.countedBy)
        counted_by = local_name(counted) if isinstance(counted, URIRef) else ""
        if counted is not None and (counted_by not in properties or not properties[counted_by].whole):
            raise KnowledgeError(
                f"{document.where(iri)}: the default part {kind} of {local_name(iri)} is :countedBy "
                f"{counted_by or 'nothing'}, which is no property that is a whole number"
            )
        yield DefaultPart(kind=kind, unless=unless_name, counted_by=counted_by, source=source, certainty=certainty)

"""Every name is spelt as it was declared: a class, property or individual that nothing declares is refused."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from rdflib import OWL, RDF, RDFS, URIRef
from rdflib.term import Node

from prolepsis.knowledge.declarations import PRO
from prolepsis.knowledge.naming import refuse_unusable_names
from prolepsis.knowledge.sources import NAMESPACE
from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.knowledge.vocabulary import Vocabulary
from prolepsis.terms.errors import UnknownNameError, brief

_COMMON = (
    "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "http://www.w3.org/2000/01/rdf-schema#",
    "http://www.w3.org/2002/07/owl#",
    "http://www.w3.org/2001/XMLSchema#",
    "http://www.w3.org/2004/02/skos/",
    "http://purl.org/dc/",
    "http://qudt.org/",
)
"""Namespaces whose names need no declaration."""

_CLASS_PREDICATES = {
    RDF.type,
    RDF.first,
    RDFS.subClassOf,
    RDFS.domain,
    RDFS.range,
    OWL.equivalentClass,
    OWL.disjointWith,
    OWL.complementOf,
    OWL.someValuesFrom,
    OWL.allValuesFrom,
    OWL.onClass,
    PRO.needsWhole,
    PRO.unless,
}
"""Predicates whose objects are classes."""
_PROPERTY_PREDICATES = {
    *(OWL.onProperty, RDFS.subPropertyOf, OWL.inverseOf),
    *(PRO.of, PRO.over, PRO.countedBy, PRO.atLeast, PRO.atMost),
}
"""Predicates whose objects are properties."""


def may_be_named(
    predicate: Node | None, classes: Mapping[str, Collection[str]], vocabulary: Vocabulary
) -> Collection[str]:
    """Return the individuals that a relation may name, by its range; all but kinds of shape if that does not tell.

    Args:
        predicate: The relation.
        classes: The told classes of each individual.
        vocabulary: Classes and properties.
    """
    entry = vocabulary.properties.get(local_name(predicate)) if isinstance(predicate, URIRef) else None
    wanted = None if entry is None else vocabulary.classes.get(entry.range)
    if wanted is None or wanted.defined:
        return [n for n, told in classes.items() if "ShapeKind" not in told]
    return [n for n, told in classes.items() if wanted.name in vocabulary.told_classes(tuple(sorted(told)))]


def refuse_unknown_names(documents: tuple[Document, ...], vocabulary: Vocabulary) -> None:
    """Check every name in the files that do not belong to the package.

    Raises:
        UnknownNameError: With file and line, and the nearest known name.
    """
    declared = {s for d in documents for s in d.graph.subjects(RDF.type, None) if isinstance(s, URIRef)}
    individuals: dict[str, set[str]] = {}
    for document in documents:
        for s, kind in document.graph.subject_objects(RDF.type):
            if isinstance(s, URIRef) and isinstance(kind, URIRef) and not str(kind).startswith(str(OWL)):
                individuals.setdefault(local_name(s), set()).add(local_name(kind))

    def refuse(what: str, iri: URIRef, document: Document, predicate: Node | None = None) -> UnknownNameError:
        names = {"class": vocabulary.classes, "property": vocabulary.properties}
        known = names.get(what) or may_be_named(predicate, individuals, vocabulary)
        if local_name(iri) in known:
            meant = f"{NAMESPACE}{brief(local_name(iri))}"
            return UnknownNameError(f"{document.where(iri)}: no {what} {brief(str(iri))}; did you mean {meant}?")
        return UnknownNameError.of(what, local_name(iri), known, document.where(iri))

    for document in documents:
        if document.built_in:
            continue
        refuse_unusable_names(document)
        for _, predicate, node in sorted(document.graph, key=str):
            if isinstance(predicate, URIRef) and predicate not in declared and not str(predicate).startswith(_COMMON):
                raise refuse("property", predicate, document)
            if not isinstance(node, URIRef) or node in declared or str(node).startswith(_COMMON):
                continue
            if predicate == RDF.type or str(node).startswith(NAMESPACE):
                raise refuse(_role(predicate), node, document, predicate)


def _role(predicate: Node) -> str:
    if predicate in _CLASS_PREDICATES:
        return "class"
    return "property" if predicate in _PROPERTY_PREDICATES else "individual"

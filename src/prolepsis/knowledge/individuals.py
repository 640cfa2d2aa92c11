"""Individuals as the Turtle files tell of them, checked name by name and value by value."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

from rdflib import OWL, RDF, RDFS, BNode, URIRef

from prolepsis.knowledge.situation import INVERSES, Situation, Statement
from prolepsis.knowledge.sources import NAMESPACE
from prolepsis.knowledge.spelling import may_be_named
from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.knowledge.vocabulary import DefaultPart, Vocabulary
from prolepsis.knowledge.written import read_value
from prolepsis.terms.errors import KnowledgeError, UnknownNameError


def read_situation(documents: tuple[Document, ...], vocabulary: Vocabulary, most: int | None = None) -> Situation:
    """Return what ``documents`` say of individuals, with the default parts made.

    Args:
        documents: The ontology, and what a situation consists of.
        vocabulary: Its classes and properties.
        most: How many individuals a situation may have; any number if None.

    Raises:
        UnknownNameError: If an individual has no class, or a relation names one that is not there.
        KnowledgeError: If a value is wrong, or the parts are no trees, or there are too many individuals.
    """
    classes: dict[str, tuple[str, ...]] = {}
    locations: dict[str, str] = {}
    iris: dict[str, URIRef] = {}
    built_in: set[str] = set()
    for document in documents:
        if not document.built_in:
            _refuse_misplaced(document, vocabulary)
        individuals = _individuals(document, vocabulary)
        if most is not None and len(individuals) > most:
            raise KnowledgeError(f"{document.path}: has {len(individuals)} individuals; allowed: {most}")
        for iri in individuals:
            name = local_name(iri)
            if iris.setdefault(name, iri) != iri:
                raise KnowledgeError(
                    f"{document.where(iri)}: two individuals are called {name}: <{iris[name]}> and <{iri}>"
                )
            told = [
                local_name(t)
                for t in document.graph.objects(iri, RDF.type)
                if isinstance(t, URIRef) and t not in (OWL.NamedIndividual, OWL.Thing)
            ]
            if name in built_in and not {*told} <= {*classes[name]}:
                taken = f"{name} is a {classes[name][0]} of the ontology"
                raise KnowledgeError(f"{document.where(iri)}: {taken}; name the individual otherwise, such as {name}1")
            if document.built_in:
                built_in.add(name)
            if told or name not in classes:
                classes[name] = tuple(sorted({*classes.get(name, ()), *told}))
                locations.setdefault(name, document.where(iri))
    for name, told in sorted(classes.items()):
        for unknown in sorted({*told} - {*vocabulary.classes}):
            raise UnknownNameError.of("class", unknown, vocabulary.classes, where=locations[name])
        if not told:
            known = [n for n, t in classes.items() if t]
            raise UnknownNameError.of("individual", name, known, where=f"{locations[name]}: it has no class")
    statements = [s for document in documents for s in _statements(document, vocabulary, classes)]
    _refuse_second_values(statements, vocabulary)
    situation = Situation(
        classes=dict(sorted(classes.items())),
        iris={name: str(iri) for name, iri in iris.items()},
        statements=tuple(statements),
        locations=locations,
        wholes=_wholes(statements),
    )
    situation = _with_default_parts(situation, vocabulary)
    _refuse_loose_parts(situation, vocabulary)
    return situation


def _refuse_misplaced(document: Document, vocabulary: Vocabulary) -> None:
    """Refuse what would otherwise have no effect: nameless individuals, values of classes, and equal names."""
    known = {entry.iri for entry in vocabulary.classes.values()}
    for subject, predicate, node in sorted(document.graph, key=str):
        name = local_name(URIRef(str(predicate)))
        if isinstance(subject, BNode) and predicate == RDF.type and str(node) in known:
            raise KnowledgeError(f"{document.path}: a nameless {local_name(URIRef(str(node)))}: give it a name")
        entry = vocabulary.properties.get(name)
        if isinstance(subject, URIRef) and str(subject) in known and entry is not None and entry.iri == str(predicate):
            where = document.where(subject)
            raise KnowledgeError(
                f"{where}: {local_name(subject)} is a class: write [ :of :{name} ; ... ] as a :default of it"
            )
        if isinstance(subject, URIRef) and predicate == OWL.sameAs:
            raise KnowledgeError(f"{document.where(subject)}: owl:sameAs is not supported: two names are two things")


def _individuals(document: Document, vocabulary: Vocabulary) -> list[URIRef]:
    graph = document.graph
    terms = {OWL.Class, OWL.ObjectProperty, OWL.DatatypeProperty, OWL.AnnotationProperty, OWL.Ontology, RDFS.Datatype}
    found: set[URIRef] = set()
    for subject in set(graph.subjects()):
        if not isinstance(subject, URIRef):
            continue
        types = set(graph.objects(subject, RDF.type))
        name = local_name(subject)
        taken = "class" if name in vocabulary.classes else "property" if name in vocabulary.properties else ""
        if types and not types & terms and taken:
            raise KnowledgeError(
                f"{document.where(subject)}: {name} is the name of a {taken}; name the individual otherwise"
            )
        if not types & terms and not taken:
            found.add(subject)
    return sorted(found)


def _statements(document: Document, vocabulary: Vocabulary, classes: Mapping[str, tuple[str, ...]]) -> list[Statement]:
    found: list[Statement] = []
    for iri in _individuals(document, vocabulary):
        subject = local_name(iri)
        for predicate, node in sorted(document.graph.predicate_objects(iri), key=str):
            name = local_name(predicate) if isinstance(predicate, URIRef) else ""
            entry = vocabulary.properties.get(name)
            if entry is None or entry.iri != str(predicate) or isinstance(node, BNode):
                continue
            where = document.where(iri)
            value = read_value(entry, node, where=f"{where}: {subject}")
            if name == "file":
                value = str(document.path.parent / str(value))
            if entry.kind == "relation" and value not in classes:
                known = may_be_named(predicate, classes, vocabulary)
                raise UnknownNameError.of("individual", str(value), known, where=f"{where}: {subject} {name}")
            found.append(Statement(subject=subject, property=name, value=value, where=where))
    return [_upright(s) for s in found]


def _upright(statement: Statement) -> Statement:
    """Return a statement with an inverse property the other way round."""
    upright = INVERSES.get(statement.property)
    if upright is None:
        return statement
    return replace(statement, subject=str(statement.value), property=upright, value=statement.subject)


def _refuse_second_values(statements: list[Statement], vocabulary: Vocabulary) -> None:
    seen: dict[tuple[str, str], Statement] = {}
    for s in statements:
        if not vocabulary.properties[s.property].functional:
            continue
        first = seen.setdefault((s.subject, s.property), s)
        if first.value != s.value:
            raise KnowledgeError(f"{s.where}: {s.subject} has two values of {s.property}: {first.value} and {s.value}")


def _wholes(statements: list[Statement]) -> dict[str, str]:
    wholes: dict[str, str] = {}
    for s in statements:
        if s.property != "hasPart":
            continue
        part = str(s.value)
        if wholes.setdefault(part, s.subject) != s.subject:
            raise KnowledgeError(f"{s.where}: {part} has two wholes: {wholes[part]} and {s.subject}")
    for part in sorted(wholes):
        chain = [part]
        while chain[-1] in wholes:
            chain.append(wholes[chain[-1]])
            if chain[-1] == part:
                locations = {str(s.value): s.where for s in statements if s.property == "hasPart"}
                raise KnowledgeError(f"{locations[part]}: {part} is a part of itself: {' is part of '.join(chain)}")
    return wholes


def _with_default_parts(situation: Situation, vocabulary: Vocabulary) -> Situation:
    """Return the situation with the parts that its classes give where the files say nothing else."""
    classes, locations, wholes = dict(situation.classes), dict(situation.locations), dict(situation.wholes)
    iris = dict(situation.iris)
    statements = list(situation.statements)
    for whole, told in situation.classes.items():
        stated = {c for part in situation.parts.get(whole, ()) for c in vocabulary.told_classes(classes[part])}
        # The most specific class comes first: a quail's egg has a quail's shell, so no hen's one by default.
        above = vocabulary.told_classes(told)
        for name in sorted(
            (each for each in above if vocabulary.classes[each].parts),
            key=lambda each: -len(vocabulary.told_classes((each,))),
        ):
            missing = [part for part in vocabulary.classes[name].parts if part.unless not in stated]
            stated |= {c for part in missing for c in vocabulary.told_classes((part.kind,))}
            for part, part_name in _named(situation, whole, above, missing, vocabulary):
                if wholes.get(part_name) == whole:
                    both = " and ".join(told)
                    raise KnowledgeError(
                        f"{locations[whole]}: {whole} is of {both}, which give it different parts called {part_name}; "
                        "allowed: one of them"
                    )
                if part_name in classes:
                    raise KnowledgeError(
                        f"{locations[part_name]}: {part_name} is part of nothing, and {whole} would have a part of "
                        f"that name by default; say '{whole} hasPart {part_name}' or name it otherwise"
                    )
                classes[part_name] = (part.kind,)
                locations[part_name] = f"default part of {name}: {part.source}"
                wholes[part_name] = whole
                iris[part_name] = NAMESPACE + part_name
                statements.append(
                    Statement(
                        subject=whole, property="hasPart", value=part_name, where=locations[part_name], derived=True
                    )
                )
    return Situation(
        classes=dict(sorted(classes.items())),
        iris=iris,
        statements=tuple(statements),
        locations=locations,
        wholes=wholes,
    )


def _named(
    situation: Situation, whole: str, above: Collection[str], parts: list[DefaultPart], vocabulary: Vocabulary
) -> Iterator[tuple[DefaultPart, str]]:
    """Yield default parts of a whole with their names; those that are counted are numbered, as ``beads1/bead3``."""
    for part in parts:
        name = part_name_of(whole, above, part.kind, vocabulary)
        if not part.counted_by:
            yield part, name
            continue
        said = [s.value for s in situation.said.get((whole, part.counted_by), ())]
        # The most specific class comes first.
        classes = sorted(above, key=lambda each: -len(vocabulary.told_classes((each,))))
        defaults = [default for each in classes for default in vocabulary.classes[each].defaults]
        said += [default.value for default in defaults if default.property == part.counted_by]
        count = next((value for value in said if isinstance(value, float)), 0.0)
        yield from ((part, f"{name}{k}") for k in range(1, int(count) + 1))


def part_name_of(whole: str, above: Collection[str], kind: str, vocabulary: Vocabulary) -> str:
    """Return the name of a default part: ``eggshell1`` of the egg ``egg1``, ``breakfast/shell`` of ``breakfast``.

    Args:
        whole: What it is a part of.
        above: The classes of that.
        kind: Its own class.
        vocabulary: What these classes say.
    """
    entries = [vocabulary.classes[name] for name in vocabulary.told_classes((kind,))]
    called = next((entry.called for entry in entries if entry.called), "")
    owners = {owner for entry in entries for owner in entry.needs_whole} & {*above}
    word = whole.rstrip("0123456789")
    # Two wholes of one class differ in their numbers, and so do parts of the class that need such a whole.
    if called and word in {owner[0].lower() + owner[1:] for owner in owners}:
        return f"{called}{whole[len(word) :]}"
    return f"{whole}/{re.findall('[A-Z]?[^A-Z]+', kind)[-1].lower()}"


def _refuse_loose_parts(situation: Situation, vocabulary: Vocabulary) -> None:
    for name, told in situation.classes.items():
        needed = {n for c in vocabulary.told_classes(told) for n in vocabulary.classes[c].needs_whole}
        if not needed:
            continue
        whole = situation.wholes.get(name)
        kind = " or ".join(sorted(needed))
        if whole is None:
            raise KnowledgeError(
                f"{situation.locations[name]}: {name} is part of nothing: {' and '.join(told)} must be a part of "
                f"a {kind}"
            )
        if not needed & set(vocabulary.told_classes(situation.classes[whole])):
            raise KnowledgeError(
                f"{situation.locations[name]}: {name} is a part of {whole}, which is no {kind}: "
                f"{' and '.join(told)} must be a part of a {kind}"
            )

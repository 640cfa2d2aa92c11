"""OWL DL reasoning: is the knowledge base consistent, and which classes does each individual belong to?

Importing the reasoner takes longer than all the rest of loading a knowledge base, so an answer is kept under
the hash of the axioms, and read back from there.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version

from rdflib import OWL, RDF

from prolepsis.errors import InconsistentError, UndecidedError
from prolepsis.knowledge.axioms import Axiom, assertions, terminology
from prolepsis.knowledge.chaining import chain, clashes
from prolepsis.knowledge.conflict import smallest_conflict
from prolepsis.knowledge.kept import keep_answer, read_answer
from prolepsis.knowledge.reasoner import LIMIT_VARIABLE, is_consistent
from prolepsis.knowledge.situation import Situation
from prolepsis.knowledge.turtle import Document
from prolepsis.knowledge.vocabulary import Vocabulary

INCONSISTENT = "inconsistent"
EMPTY_CLASS = "empty class"
_TOKEN = re.compile(r"<[^<>]*>")


@dataclass(frozen=True, slots=True)
class Probe:
    """A question: does the individual belong to the class?"""

    individual: str
    """IRI."""
    class_iri: str
    """IRI."""
    above: frozenset[str]
    """IRIs of the class and its told superclasses."""


def denials(probes: tuple[Probe, ...]) -> tuple[Axiom, ...]:
    """Return axioms that deny all probes.

    pyhermit 0.2.3 searches for minutes when a complement is asserted of an individual, and for milliseconds when
    a named class that is disjoint with the denied one is.
    """
    # Who does not belong to a class does not belong to its subclasses either.
    denied = {(p.individual, p.class_iri) for p in probes}
    probes = tuple(p for p in probes if not any((p.individual, c) in denied for c in p.above - {p.class_iri}))
    classes = sorted({probe.class_iri for probe in probes})
    names = [Axiom(f"Declaration(Class(<{c}/not>))") for c in classes]
    names += [Axiom(f"DisjointClasses(<{c}> <{c}/not>)") for c in classes]
    return (*names, *(Axiom(f"ClassAssertion(<{p.class_iri}/not> <{p.individual}>)") for p in probes))


@dataclass(frozen=True, kw_only=True, slots=True)
class Types:
    """What the reasoner found out."""

    classes: Mapping[str, tuple[str, ...]]
    """Individual to its named classes, sorted."""
    parents: Mapping[str, tuple[str, ...]]
    """Class to its named proper superclasses, sorted."""

    def superclasses(self, name: str) -> tuple[str, ...]:
        """Return the named classes that are more general than ``name``."""
        return self.parents.get(name, ())

    def kind(self, classes: tuple[str, ...], vocabulary: Vocabulary) -> str:
        """Return the most specific of ``classes`` that is not defined, or else the most specific one."""
        plain = [c for c in classes if not vocabulary.classes[c].defined] or list(classes)
        lowest = [c for c in plain if not any(c in self.superclasses(o) for o in plain)]
        return sorted(lowest or plain)[0]


def infer_types(documents: tuple[Document, ...], vocabulary: Vocabulary, situation: Situation, *, check: bool) -> Types:
    """Return the inferred classes of every individual, and the named superclasses of every class.

    Args:
        documents: The Turtle files.
        vocabulary: Their classes and properties.
        situation: Their individuals.
        check: Whether to refuse contradictions; if not, an inconsistent knowledge base has its told classes.

    Raises:
        InconsistentError: If the axioms contradict each other, or a class can have no individual.
        UndecidedError: If the reasoner runs out of time. What it did not decide is never taken as answered.
    """
    terms, cells = terminology(documents, vocabulary)
    facts = assertions(situation, vocabulary, cells, terms)
    told = {name: vocabulary.told_classes(classes) for name, classes in situation.classes.items()}
    probes = tuple(
        Probe(
            situation.iris[name],
            entry.iri,
            frozenset(vocabulary.classes[c].iri for c in vocabulary.told_classes((class_name,))),
        )
        for name in representatives(situation, facts)
        for class_name, entry in vocabulary.classes.items()
        if class_name not in told[name]
    )
    own = {str(iri) for d in documents if not d.built_in for iri in d.graph.subjects(RDF.type, OWL.Class)}
    witnesses = tuple(
        Axiom(f"ClassAssertion(<{entry.iri}> <{entry.iri}/witness>)", f"there can be a {name}", "asked")
        for name, entry in vocabulary.classes.items()
        if entry.iri in own
    )
    entailed = kept_answer(terms, about(facts, situation, representatives(situation, facts)), witnesses, probes)
    if isinstance(entailed, str):
        if check:
            axioms = terms + (facts if entailed == INCONSISTENT else witnesses)
            raise InconsistentError(f"the knowledge base contradicts itself: {explain(axioms)}")
        entailed = ()
    inferred = {(probe.individual, probe.class_iri) for probe in entailed}
    alike = representatives(situation, facts)
    classes: dict[str, tuple[str, ...]] = {}
    for name in situation.classes:
        iri = situation.iris[next(r for r, members in alike.items() if name in members)]
        found = {c for c, entry in vocabulary.classes.items() if (iri, entry.iri) in inferred}
        classes[name] = tuple(sorted({*told[name], *found}))
    parents = {c: tuple(p for p in vocabulary.told_classes((c,)) if p != c) for c in vocabulary.classes}
    return Types(classes=classes, parents=parents)


def representatives(situation: Situation, facts: tuple[Axiom, ...]) -> Mapping[str, tuple[str, ...]]:
    """Return groups of individuals of which exactly the same is said, but nothing that relates them to others.

    The reasoner is asked about the first of each group only.
    """
    names = {f"<{iri}>": name for name, iri in situation.iris.items()}
    said: dict[str, list[str]] = {name: [] for name in situation.classes}
    related: set[str] = set()
    for axiom in facts:
        if axiom.text.startswith("DifferentIndividuals"):
            continue
        mentioned = [names[token] for token in _TOKEN.findall(axiom.text) if token in names]
        if len(mentioned) > 1:
            related.update(mentioned)
        for name in mentioned:
            said[name].append(axiom.text.replace(f"<{situation.iris[name]}>", "<it>"))
    groups: dict[str, list[str]] = {}
    for name in situation.classes:
        key = name if name in related else "\n".join(sorted(said[name]))
        groups.setdefault(key, []).append(name)
    return {members[0]: tuple(members) for members in groups.values()}


def about(facts: tuple[Axiom, ...], situation: Situation, alike: Mapping[str, tuple[str, ...]]) -> tuple[Axiom, ...]:
    """Return the facts without the individuals that another one stands for."""
    left_out = {f"<{situation.iris[name]}>" for members in alike.values() for name in members[1:]}
    kept = [
        a for a in facts if not a.text.startswith("DifferentIndividuals") and not left_out & set(_TOKEN.findall(a.text))
    ]
    names = [f"<{situation.iris[name]}>" for name in alike]
    different = [Axiom(f"DifferentIndividuals({' '.join(names)})")] if len(names) > 1 else []
    return (*kept, *different)


def kept_answer(
    terms: tuple[Axiom, ...], facts: tuple[Axiom, ...], witnesses: tuple[Axiom, ...], probes: tuple[Probe, ...]
) -> tuple[Probe, ...] | str:
    """Return the probes that follow from the axioms, or ``INCONSISTENT`` or ``EMPTY_CLASS``.

    The answer is read from the cache if it is there.
    """
    asked = "\n".join(a.text for a in (*terms, *facts, *witnesses, *denials(probes)))
    key = hashlib.sha256(f"1 pyhermit {version('pyhermit')}\n{asked}".encode()).hexdigest()
    kept = read_answer(key)
    if kept is not None:
        return kept if isinstance(kept, str) else tuple(probes[i] for i in kept)
    answer = entailed_probes(terms, facts, witnesses, probes)
    keep_answer(key, answer if isinstance(answer, str) else [probes.index(probe) for probe in answer])
    return answer


def entailed_probes(
    terms: tuple[Axiom, ...], facts: tuple[Axiom, ...], witnesses: tuple[Axiom, ...], probes: tuple[Probe, ...]
) -> tuple[Probe, ...] | str:
    """Return the probes that follow, or ``INCONSISTENT`` or ``EMPTY_CLASS``.

    Forward chaining finds what follows step by step. One consistency check then certifies that nothing else
    does: all other probes can be denied together, and every class can have an individual. If it fails, the
    reasoner looks for what else follows by denying halves. (pyhermit 0.2.3 answers such a check in
    milliseconds, but its own realization does not end on this ontology.)
    """
    axioms = terms + facts
    found = chain(axioms)
    follows = tuple(probe for probe in probes if f"<{probe.class_iri}>" in found.get(f"<{probe.individual}>", ()))
    others = tuple(probe for probe in probes if probe not in follows)
    if any(not is_consistent((*terms, witness)) for witness in witnesses):
        return EMPTY_CLASS
    if is_consistent((*axioms, *denials(others))):
        return follows
    if not is_consistent(axioms):
        return INCONSISTENT

    def search(part: tuple[Probe, ...]) -> tuple[Probe, ...]:
        if not part or is_consistent((*axioms, *denials(part))):
            return ()
        if len(part) == 1:
            return part
        half = len(part) // 2
        return search(part[:half]) + search(part[half:])

    return follows + search(others)


def explain(axioms: tuple[Axiom, ...]) -> str:
    """Return the few axioms that cannot hold together, as a person would say them, with the files they come from."""
    background, doubted = tuple(a for a in axioms if not a.where), tuple(a for a in axioms if a.where)
    if clashes(axioms):
        # Chaining is a hundred times quicker than the reasoner, and leaves it only a few axioms.
        doubted = smallest_conflict(background, doubted, lambda some: not clashes(some))
    try:
        conflict = smallest_conflict(background, doubted, is_consistent)
    except UndecidedError:
        return f"which axioms clash was not found in time; allow more with the environment variable {LIMIT_VARIABLE}"
    if not conflict:
        return "two names are given to one thing"
    return "; ".join(f"{axiom.reading} ({axiom.where})" for axiom in conflict)

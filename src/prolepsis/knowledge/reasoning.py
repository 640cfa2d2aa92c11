"""OWL DL reasoning: is the knowledge base consistent, and which classes does each individual belong to?

Importing the reasoner takes longer than all the rest of loading a knowledge base, so an answer is kept under
the hash of the axioms, and read back from there.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from importlib.metadata import version

from rdflib import OWL, RDF, URIRef

from prolepsis.knowledge.alike import alike, counts_along_chains
from prolepsis.knowledge.axioms import Axiom, assertions, terminology, with_article
from prolepsis.knowledge.chaining import MOST_STEPS, Chaining, StepsError, chain, clashes, clashing, is_whole
from prolepsis.knowledge.conflict import smallest_conflict
from prolepsis.knowledge.inferred import Types
from prolepsis.knowledge.kept import keep_answer, read_answer
from prolepsis.knowledge.reasoner import Budget, is_consistent
from prolepsis.knowledge.situation import Situation
from prolepsis.knowledge.sources import ONTOLOGY_FOLDER
from prolepsis.knowledge.time_limit import LIMIT_VARIABLE
from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.knowledge.vocabulary import Vocabulary
from prolepsis.terms.errors import LONGEST_LINE, InconsistentError, UndecidedError, error_line

Answer = list[int] | str
"""What is kept of the reasoner: numbers of what follows, or one of these words."""
INCONSISTENT, EMPTY, POSSIBLE = "inconsistent", "empty class", "no class is empty"
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


def infer_types(documents: tuple[Document, ...], vocabulary: Vocabulary, situation: Situation, *, check: bool) -> Types:
    """Return the inferred classes of every individual, and the named superclasses of every class.

    Args:
        documents: The Turtle files.
        vocabulary: Their classes and properties.
        situation: Their individuals.
        check: Whether to refuse contradictions; if not, an inconsistent knowledge base has its told classes.

    Raises:
        InconsistentError: If the axioms contradict each other, or a class can have no individual.
    """
    terms, cells = terminology(documents, vocabulary)
    facts = assertions(situation, vocabulary, cells, terms)
    own = {str(iri) for d in documents if not d.built_in for iri in d.graph.subjects(RDF.type, OWL.Class)}
    witnesses, budget, unchecked = _witnesses(vocabulary, own), Budget(), ""
    inferred: Mapping[str, frozenset[str]] = {}
    try:
        try:
            if witnesses and not can_be(terms, witnesses, budget):
                raise contradiction(terms + witnesses)
        except UndecidedError as error:
            unchecked = str(error)
        try:
            inferred = entailed_types(terms, facts, vocabulary, budget)
        except UndecidedError as error:
            unchecked, inferred = str(error), step_by_step(terms, facts)
    except InconsistentError:
        if check:
            raise
    names = {f"<{entry.iri}>": name for name, entry in vocabulary.classes.items()}
    classes: dict[str, tuple[str, ...]] = {}
    for name, told in situation.classes.items():
        found = {names[c] for c in inferred.get(f"<{situation.iris[name]}>", ()) if c in names}
        classes[name] = tuple(sorted({*vocabulary.told_classes(told), *found}))
    return Types(classes=classes, vocabulary=vocabulary, unchecked=unchecked)


def _witnesses(vocabulary: Vocabulary, own: set[str]) -> tuple[Axiom, ...]:
    """Return that there is one of each of the user's own classes but those that have a subclass among them."""
    above = {p for entry in vocabulary.classes.values() if entry.iri in own for p in entry.parents}
    return tuple(
        Axiom(f"ClassAssertion(<{entry.iri}> <{entry.iri}/witness>)", f"there can be a {name}", "asked")
        for name, entry in vocabulary.classes.items()
        if entry.iri in own and name not in above
    )


def can_be(terms: tuple[Axiom, ...], witnesses: tuple[Axiom, ...], budget: Budget) -> bool:
    """Return whether there can be an individual of each class.

    Raises:
        UndecidedError: If the reasoner runs out of time.
    """
    chaining = _chained((*terms, *witnesses))
    if chaining is not None:
        if clashing(chaining) is not None:
            return False
        if not counts_along_chains(terms) and is_whole(chaining):
            return True

    def answer() -> Answer:
        together = is_consistent((*terms, *witnesses), budget)
        possible = together or all(is_consistent((*terms, witness), budget) for witness in witnesses)
        return POSSIBLE if possible else EMPTY

    return _kept((*terms, *witnesses), answer) == POSSIBLE


def step_by_step(terms: tuple[Axiom, ...], facts: tuple[Axiom, ...]) -> Mapping[str, frozenset[str]]:
    """Return individual to classes, both as bracketed IRIs, as far as chaining finds them."""
    chaining = _chained((*terms, *facts))
    return {} if chaining is None else chaining.named()


def _chained(axioms: tuple[Axiom, ...]) -> Chaining | None:
    try:
        return chain(axioms)
    except StepsError:
        return None


def entailed_types(
    terms: tuple[Axiom, ...], facts: tuple[Axiom, ...], vocabulary: Vocabulary, budget: Budget
) -> Mapping[str, frozenset[str]]:
    """Return individual to the classes to which it must belong, both as bracketed IRIs.

    Args:
        terms: Axioms of classes and properties.
        facts: Axioms of individuals.
        vocabulary: The classes.
        budget: What the reasoner may spend.

    Forward chaining finds what follows step by step. Where what it found is a model, nothing else does. Elsewhere the
    reasoner is asked, of those that are alike about one, and about those that are related together by themselves.

    Raises:
        InconsistentError: If the axioms contradict each other.
        UndecidedError: If the reasoner runs out of time.
    """
    chaining = _chained((*terms, *facts))
    if chaining is None:
        raise UndecidedError(f"forward chaining did not end within {MOST_STEPS} steps")
    node = clashing(chaining)
    if node is not None:
        raise contradiction((*terms, *_around(node, terms, facts)))
    found = chaining.named()
    if not counts_along_chains(terms) and is_whole(chaining):
        return found
    groups = alike(facts, terms)
    above = {
        entry.iri: frozenset(vocabulary.classes[c].iri for c in vocabulary.told_classes((name,)))
        for name, entry in vocabulary.classes.items()
    }
    for members in groups.components:
        here = _about(facts, members)
        part = _chained((*terms, *here))
        if part is not None and not counts_along_chains(terms) and is_whole(part):
            continue
        probes = tuple(
            Probe(member[1:-1], iri, higher)
            for member in members
            for iri, higher in above.items()
            if f"<{iri}>" not in found[member]
        )
        answer = _kept_probes(terms, here, members, probes, budget)
        if answer is None:
            raise contradiction((*terms, *here))
        for probe in answer:
            found[f"<{probe.individual}>"] |= {f"<{probe.class_iri}>"}
    return {name: found[groups.stands_for[name]] for name in groups.stands_for}


def _around(node: str, terms: tuple[Axiom, ...], facts: tuple[Axiom, ...]) -> tuple[Axiom, ...]:
    """Return facts about a thing that clashes and those around it, as few as show it."""
    members, size = {node}, 0
    mentions = {axiom: frozenset(_TOKEN.findall(axiom.text)) for axiom in facts}
    people = {token for axiom in facts if axiom.text.startswith("Different") for token in mentions[axiom]}
    members &= people
    while len(members) > size:
        here = _about(facts, tuple(sorted(members)))
        if here and clashes((*terms, *here)):
            return here
        size = len(members)
        related = [m & people for a, m in mentions.items() if a.text.startswith("ObjectProp") and m & members]
        members |= set[str]().union(*related)
    return facts


def _about(facts: tuple[Axiom, ...], members: tuple[str, ...]) -> tuple[Axiom, ...]:
    """Return what is said of some individuals alone."""
    people = {t for a in facts if a.text.startswith("Different") for t in _TOKEN.findall(a.text)}
    others = people - {*members}
    kept = [a for a in facts if a.text[:9] != "Different" and others.isdisjoint(_TOKEN.findall(a.text))]
    different = [Axiom(f"DifferentIndividuals({' '.join(members)})", "two names are two things")]
    return (*kept, *(different if len(members) > 1 else []))


def _kept_probes(
    terms: tuple[Axiom, ...],
    facts: tuple[Axiom, ...],
    members: tuple[str, ...],
    probes: tuple[Probe, ...],
    budget: Budget,
) -> tuple[Probe, ...] | None:
    """Return the probes that follow from the axioms, or None if these contradict each other.

    An answer is kept under what is said of the individuals, whatever they are called.
    """
    names = {member: f"<urn:{k}>" for k, member in enumerate(members)}

    def renamed(axiom: Axiom) -> Axiom:
        return Axiom(_TOKEN.sub(lambda token: names.get(token.group(), token.group()), axiom.text))

    asked = tuple(sorted(renamed(axiom) for axiom in facts))
    questions = tuple(replace(probe, individual=names[f"<{probe.individual}>"][1:-1]) for probe in probes)

    def answer() -> list[int] | str:
        found = entailed_probes(terms, asked, questions, budget)
        return INCONSISTENT if found is None else [questions.index(probe) for probe in found]

    kept = _kept((*terms, *asked, *denials(questions)), answer)
    return None if isinstance(kept, str) else tuple(probes[k] for k in kept)


def _kept(axioms: tuple[Axiom, ...], answer: Callable[[], Answer]) -> Answer:
    """Return an answer about axioms, read from the cache if it is there."""
    asked = "\n".join(axiom.text for axiom in axioms)
    key = hashlib.sha256(f"2 pyhermit {version('pyhermit')}\n{asked}".encode()).hexdigest()
    kept = read_answer(key)
    if kept is None:
        kept = answer()
        keep_answer(key, kept)
    return kept


def entailed_probes(
    terms: tuple[Axiom, ...], facts: tuple[Axiom, ...], probes: tuple[Probe, ...], budget: Budget
) -> tuple[Probe, ...] | None:
    """Return the probes that follow, or None if the axioms contradict each other.

    One consistency check certifies that none does: all can be denied together. If it fails, the reasoner looks for
    what follows by denying halves. (pyhermit 0.2.3 answers such a check in milliseconds, but its own realization
    does not end on this ontology.)
    """
    axioms = terms + facts
    if is_consistent((*axioms, *denials(probes)), budget):
        return ()
    if not is_consistent(axioms, budget):
        return None

    def search(part: tuple[Probe, ...]) -> tuple[Probe, ...]:
        if not part or is_consistent((*axioms, *denials(part)), budget):
            return ()
        if len(part) == 1:
            return part
        half = len(part) // 2
        return search(part[:half]) + search(part[half:])

    return search(probes)


def contradiction(axioms: tuple[Axiom, ...]) -> InconsistentError:
    """Return the error for axioms that contradict each other: the few that do, as a person would say them.

    Those of a user's own files come first; where the line has no room for all and their files, these are told by their
    names, and the ontology's are not.
    """
    told = "the knowledge base contradicts itself: "
    try:
        found = explain(axioms)
    except UndecidedError:
        why = f"which axioms clash was not found in time; allow more with the environment variable {LIMIT_VARIABLE}"
        return InconsistentError(f"{told}{why}")
    if not found:
        return InconsistentError(f"{told}two names are given to one thing")
    own, built_in = ([axiom for axiom in found if _is_built_in(axiom) == whose] for whose in (False, True))
    found = tuple(_two_of_many(axiom, found) for axiom in (*own, *built_in))
    whole = tuple(f"{axiom.reading} ({axiom.where})" for axiom in found)
    line = f"{told}{'; '.join(whole)}"
    if len(line) <= LONGEST_LINE:
        return InconsistentError(line, whole)
    shown = [f"{axiom.reading} ({axiom.where.rpartition('/')[2]})" for axiom in found[: len(own)]]
    texts = [*shown, *(axiom.reading for axiom in found[len(own) :])]
    kept = len(texts)
    while kept > 1 and len(line := _few(told, texts, kept)) > LONGEST_LINE:
        kept -= 1
    return InconsistentError(error_line(line), whole)


def _two_of_many(axiom: Axiom, found: tuple[Axiom, ...]) -> Axiom:
    """Return of many classes that exclude each other only the two about which the other axioms speak."""
    told, _, classes = axiom.text.partition("(")
    others = {token for other in found if other is not axiom for token in _TOKEN.findall(other.text)}
    both = [name for name in _TOKEN.findall(classes) if name in others]
    if told != "DisjointClasses" or len(both) != 2:
        return axiom
    one, other = (local_name(URIRef(name[1:-1])) for name in both)
    return replace(axiom, reading=f"no {one} is {with_article(other)}")


def _few(told: str, texts: list[str], kept: int) -> str:
    rest = f"; and {len(texts) - kept} more" if kept < len(texts) else ""
    return f"{told}{'; '.join(texts[:kept])}{rest}"


def _is_built_in(axiom: Axiom) -> bool:
    return axiom.where.startswith(f"{ONTOLOGY_FOLDER}/")


def explain(axioms: tuple[Axiom, ...]) -> tuple[Axiom, ...]:
    """Return the few axioms that cannot hold together; none if those that are not in doubt cannot.

    Raises:
        UndecidedError: If the reasoner runs out of time.
    """
    background, doubted = tuple(a for a in axioms if not a.where), tuple(a for a in axioms if a.where)
    if clashes(axioms):
        # Chaining is a hundred times quicker than the reasoner, and leaves it only a few axioms.
        doubted = smallest_conflict(background, doubted, lambda some: not clashes(some))
    budget = Budget()
    return smallest_conflict(background, doubted, lambda some: is_consistent(some, budget))

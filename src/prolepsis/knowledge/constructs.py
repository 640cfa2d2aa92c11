"""Every statement of a file is one that something here reads, or it is refused by name: what were passed over without a
word would be certified although nobody had looked at it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rdflib import OWL, RDF, RDFS, XSD, BNode, Literal, URIRef
from rdflib.collection import Collection
from rdflib.term import Node

from prolepsis.knowledge.declarations import HAS_UNIT, PRO, is_aligned
from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.terms.errors import KnowledgeError, UnknownNameError, brief, brief_list, did_you_mean

Words = frozenset[Node]

CLASS, RELATION, VALUES, NOTE, ONTOLOGY, INDIVIDUAL = (
    "class",
    "relation",
    "property of values",
    "annotation",
    "ontology",
    "individual",
)
_DECLARED = {
    OWL.Class: CLASS,
    OWL.ObjectProperty: RELATION,
    OWL.DatatypeProperty: VALUES,
    OWL.AnnotationProperty: NOTE,
    OWL.Ontology: ONTOLOGY,
}
_TYPES: Mapping[str, Words] = {
    CLASS: frozenset({OWL.Class}),
    RELATION: frozenset(
        {
            OWL.ObjectProperty,
            OWL.FunctionalProperty,
            OWL.InverseFunctionalProperty,
            OWL.TransitiveProperty,
            OWL.SymmetricProperty,
            OWL.AsymmetricProperty,
            OWL.ReflexiveProperty,
            OWL.IrreflexiveProperty,
        }
    ),
    VALUES: frozenset({OWL.DatatypeProperty, OWL.FunctionalProperty}),
    NOTE: frozenset({OWL.AnnotationProperty}),
    ONTOLOGY: frozenset({OWL.Ontology}),
}
"""What each may be besides, by ``rdf:type``."""

_CONNECTIVES = frozenset({OWL.intersectionOf, OWL.unionOf, OWL.complementOf, OWL.oneOf})
_OF_CLASSES = frozenset({RDFS.subClassOf, OWL.equivalentClass, OWL.disjointWith})
_SAID: Mapping[str, Words] = {
    CLASS: frozenset({*_OF_CLASSES, OWL.disjointUnionOf, *_CONNECTIVES})
    | {PRO.default, PRO.defaultPart, PRO.curve, PRO.limit, PRO.needsWhole, PRO.called, PRO.alignedWith},
    RELATION: frozenset({RDFS.subPropertyOf, OWL.inverseOf, OWL.equivalentProperty, OWL.propertyDisjointWith})
    | {RDFS.domain, RDFS.range, OWL.propertyChainAxiom, PRO.alignedWith},
    VALUES: frozenset({RDFS.domain, RDFS.range, HAS_UNIT})
    | {PRO.above, PRO.atLeast, PRO.atMost, PRO.whole, PRO.ofParts, PRO.alignedWith},
    NOTE: frozenset({RDFS.subPropertyOf, RDFS.domain, RDFS.range}),
    ONTOLOGY: frozenset({OWL.imports, OWL.versionIRI, OWL.priorVersion, OWL.backwardCompatibleWith})
    | {OWL.incompatibleWith},
    INDIVIDUAL: frozenset({OWL.differentFrom}),
}
"""What is read of each, besides its type, notes and, of an individual, values and relations."""
_NOTES = frozenset({RDFS.label, RDFS.comment, RDFS.seeAlso, RDFS.isDefinedBy, OWL.versionInfo, OWL.deprecated})
"""Words of OWL that say nothing that could be true or false of things."""
_LOGICAL = (str(OWL), str(RDF), str(RDFS), str(XSD), str(PRO))
"""Namespaces each word of which is read or refused; undeclared words of others, such as dcterms, are notes."""

_QUALIFIED = (OWL.minQualifiedCardinality, OWL.maxQualifiedCardinality, OWL.qualifiedCardinality)
_PLAIN = (OWL.someValuesFrom, OWL.allValuesFrom, OWL.hasValue, OWL.minCardinality, OWL.maxCardinality, OWL.cardinality)
_EXPRESSIONS: frozenset[Words] = frozenset(
    {
        *(frozenset({each}) for each in (*_CONNECTIVES, OWL.datatypeComplementOf)),
        frozenset({OWL.onDatatype, OWL.withRestrictions}),
        *(frozenset({OWL.onProperty, each}) for each in _PLAIN),
        *(frozenset({OWL.onProperty, each, of}) for each in _QUALIFIED for of in (OWL.onClass, OWL.onDataRange)),
    }
)
"""Class expressions and data ranges, by the words that they are written with."""
_INVERSE, _LIST = frozenset({frozenset({OWL.inverseOf})}), frozenset({frozenset({RDF.first, RDF.rest})})
_FACETS = frozenset(
    frozenset({each}) for each in (XSD.minInclusive, XSD.minExclusive, XSD.maxInclusive, XSD.maxExclusive)
)
_AXIOMS: Mapping[Node, frozenset[Words]] = {
    OWL.AllDisjointClasses: frozenset({frozenset({OWL.members})}),
    OWL.AllDisjointProperties: frozenset({frozenset({OWL.members})}),
    OWL.AllDifferent: frozenset({frozenset({OWL.members}), frozenset({OWL.distinctMembers})}),
    OWL.NegativePropertyAssertion: frozenset(
        frozenset({OWL.sourceIndividual, OWL.assertionProperty, target})
        for target in (OWL.targetIndividual, OWL.targetValue)
    ),
    OWL.Axiom: frozenset({frozenset({OWL.annotatedSource, OWL.annotatedProperty, OWL.annotatedTarget})}),
}
"""Axioms that are nodes without a name, by their type."""
_NODE_TYPES = frozenset({OWL.Class, OWL.Restriction, OWL.ObjectProperty, RDFS.Datatype, RDF.List, *_AXIOMS})
_PROVENANCE = frozenset({PRO.source, PRO.certainty})
_OWN_NODES: Mapping[Node, Words] = {
    PRO.default: frozenset({PRO.of, PRO.value, PRO.deviation, PRO.batchDeviation}) | _PROVENANCE,
    PRO.defaultPart: frozenset({PRO.of, PRO.unless, PRO.countedBy}) | _PROVENANCE,
    PRO.curve: frozenset({PRO.of, PRO.over, PRO.point}) | _PROVENANCE,
    PRO.point: frozenset({PRO.at, PRO.value}),
    PRO.limit: frozenset({PRO.of, PRO.above, PRO.atLeast, PRO.atMost, PRO.among}) | _PROVENANCE,
}
"""What is read of a node without a name behind one of our own words."""
_OWN_WORDS = frozenset({HAS_UNIT, *(each for some in (*_SAID.values(), *_OWN_NODES.values()) for each in some)})
"""Words that are no mere notes, although some are declared as such."""
_LISTS: Mapping[Node, frozenset[Words]] = {
    OWL.intersectionOf: _EXPRESSIONS,
    OWL.unionOf: _EXPRESSIONS,
    OWL.disjointUnionOf: _EXPRESSIONS,
    OWL.oneOf: frozenset(),
    OWL.members: _EXPRESSIONS,
    OWL.distinctMembers: frozenset(),
    OWL.propertyChainAxiom: _INVERSE,
    OWL.withRestrictions: _FACETS,
}
"""Words behind which a list stands, and what may stand in it without a name."""
_NODES: Mapping[Node, frozenset[Words]] = {
    **dict.fromkeys((RDF.type, RDFS.domain, RDFS.range, *_OF_CLASSES, OWL.complementOf), _EXPRESSIONS),
    **dict.fromkeys((OWL.someValuesFrom, OWL.allValuesFrom, OWL.onClass, OWL.onDataRange), _EXPRESSIONS),
    OWL.datatypeComplementOf: _EXPRESSIONS,
    OWL.onProperty: _INVERSE,
}
"""Words behind which a node without a name may stand, and what it may be."""
_NAMED: Mapping[Node, tuple[str, ...]] = {
    **dict.fromkeys((RDF.type, *_OF_CLASSES, RDFS.domain, OWL.complementOf, OWL.onClass), (CLASS,)),
    **dict.fromkeys((OWL.disjointUnionOf, PRO.unless, PRO.needsWhole), (CLASS,)),
    **dict.fromkeys((OWL.inverseOf, OWL.equivalentProperty, OWL.propertyDisjointWith), (RELATION,)),
    OWL.propertyChainAxiom: (RELATION,),
    RDFS.subPropertyOf: (RELATION, NOTE),
    **dict.fromkeys((OWL.onProperty, OWL.assertionProperty), (RELATION, VALUES)),
    **dict.fromkeys((OWL.differentFrom, OWL.distinctMembers, OWL.oneOf, OWL.hasValue), (INDIVIDUAL,)),
    **dict.fromkeys((OWL.sourceIndividual, OWL.targetIndividual), (INDIVIDUAL,)),
    PRO.of: (CLASS, RELATION, VALUES),
    **dict.fromkeys((PRO.over, PRO.countedBy), (VALUES,)),
    **dict.fromkeys((OWL.someValuesFrom, OWL.allValuesFrom, OWL.intersectionOf, OWL.unionOf), (CLASS, "data range")),
    RDFS.range: (CLASS, "data range"),
    **dict.fromkeys((OWL.onDatatype, OWL.onDataRange, OWL.datatypeComplementOf), ("data range",)),
}
"""Words, and of which kind that is whose name stands behind them, itself or in a list."""


def refuse_unread(documents: tuple[Document, ...], *, built_in: bool = False) -> None:
    """Check that everything in the files that do not belong to the package is read.

    Args:
        documents: All files.
        built_in: Whether to check those that belong to the package, too.

    Raises:
        UnknownNameError: If something is named that nothing declares, or declares as something else.
        KnowledgeError: If a word is not read where it stands.
    """
    kinds = _kinds(documents)
    ontologies = {iri for iri, kind in kinds.items() if kind == ONTOLOGY}
    for document in documents:
        if built_in or not document.built_in:
            _File.of(document, kinds, ontologies).refuse()


def _kinds(documents: tuple[Document, ...]) -> Mapping[URIRef, str]:
    kinds: dict[URIRef, str] = {}
    for document in documents:
        for subject, declared in document.graph.subject_objects(RDF.type):
            if not isinstance(subject, URIRef):
                continue
            if declared == RDFS.Datatype:
                raise KnowledgeError(
                    f"{document.where(subject)}: a data range with a name, {local_name(subject)}, is not read"
                )
            kind = _DECLARED.get(URIRef(str(declared)))
            if kind is not None and kinds.setdefault(subject, kind) != kind:
                both = " and ".join(sorted((kind, kinds[subject])))
                raise KnowledgeError(
                    f"{document.where(subject)}: {local_name(subject)} is declared as {both}; name one otherwise"
                )
    for document in documents:
        for subject in document.graph.subjects(RDF.type, None):
            if isinstance(subject, URIRef):
                kinds.setdefault(subject, INDIVIDUAL)
    return kinds


@dataclass(frozen=True, slots=True)
class _File:
    """One file, with all that is declared."""

    document: Document
    kinds: Mapping[URIRef, str]
    ontologies: set[URIRef]
    used: Mapping[Node, tuple[tuple[Node, Node], ...]]
    """Node without a name to what it stands behind: subject and word."""

    @classmethod
    def of(cls, document: Document, kinds: Mapping[URIRef, str], ontologies: set[URIRef]) -> _File:
        used: dict[Node, tuple[tuple[Node, Node], ...]] = {}
        for subject, word, node in document.graph:
            if isinstance(node, BNode):
                used[node] = (*used.get(node, ()), (subject, word))
        return cls(document, kinds, ontologies, used)

    def refuse(self) -> None:
        for subject, word, node in sorted(self.document.graph, key=str):
            if isinstance(subject, URIRef):
                self._refuse_said(subject, word, node)
            self._refuse_object(subject, word, node)
        nodes = {subject for subject in self.document.graph.subjects() if isinstance(subject, BNode)}
        for node in sorted(nodes):
            self._refuse_node(node)

    def _root(self, node: Node) -> Node | None:
        """Return what a node without a name belongs to in the end, itself if that is nothing; None if it goes round."""
        seen: set[Node] = set()
        while isinstance(node, BNode) and node in self.used:
            if node in seen:
                return None
            seen.add(node)
            node = self.used[node][0][0]
        return node

    def _where(self, node: Node) -> str:
        root = self._root(node)
        return str(self.document.path) if root is None else self.document.where(root)

    def _is_note(self, word: Node) -> bool:
        kind = self.kinds.get(URIRef(str(word)), NOTE)
        own = word in _OWN_WORDS or (str(word).startswith(_LOGICAL) and word not in self.kinds)
        return word in _NOTES or (kind == NOTE and not own)

    def _refuse_said(self, subject: URIRef, word: Node, node: Node) -> None:
        kind = self.kinds.get(subject, INDIVIDUAL)
        if word == RDF.type:
            if kind != INDIVIDUAL and node not in _TYPES[kind]:
                raise self._unread(subject, f"the {kind} {local_name(subject)} is of type {_word(node)}", _TYPES[kind])
            return
        if self._is_note(word) or word in _SAID[kind]:
            return
        if self.kinds.get(URIRef(str(word))) in (RELATION, VALUES) and kind in (INDIVIDUAL, CLASS):
            return  # Of a class, it is refused where it can be told how to write a default.
        raise self._unread(subject, f"{_word(word)} of the {kind} {local_name(subject)}", _SAID[kind], word)

    def _unread(self, subject: Node, what: str, allowed: Words, word: Node | None = None) -> KnowledgeError:
        near = did_you_mean(_word(word), map(_word, allowed)) if word is not None else ""
        known = brief_list(sorted(map(_word, allowed), key=lambda each: (each[0] in ":<", each)))
        return KnowledgeError(f"{self._where(subject)}: {what} is not read{near}; read: {known}")

    def _refuse_object(self, subject: Node, word: Node, node: Node) -> None:
        if word == OWL.imports and node not in self.ontologies:
            raise KnowledgeError(
                f"{self._where(subject)}: owl:imports {brief(node)} is not followed; give its file, or leave it out"
            )
        if word in _LISTS:
            for member in self._members(subject, word, node):
                self._refuse_name(subject, word, member)
        elif not (
            word == RDF.type and (isinstance(subject, BNode) or self.kinds.get(URIRef(str(subject))) != INDIVIDUAL)
        ):
            self._refuse_name(subject, word, node)

    def _members(self, subject: Node, word: Node, node: Node) -> Iterator[Node]:
        graph = self.document.graph
        if node != RDF.nil and (node, RDF.first, None) not in graph:
            raise KnowledgeError(f"{self._where(subject)}: {_word(word)} needs a list, ( ... ), of what it is of")
        yield from Collection(graph, node)

    def _refuse_name(self, subject: Node, word: Node, node: Node) -> None:
        wanted = _NAMED.get(word)
        relation = self.kinds.get(URIRef(str(word))) == RELATION
        if relation:
            wanted = (INDIVIDUAL,)
        if word == OWL.members:
            kinds = {OWL.AllDisjointClasses: CLASS, OWL.AllDisjointProperties: RELATION}
            types = list(self.document.graph.objects(subject, RDF.type))
            wanted = (next((kinds[each] for each in kinds if each in types), INDIVIDUAL),)
        if wanted is None or isinstance(node, BNode):
            return
        if isinstance(node, Literal):
            if word in (OWL.hasValue, OWL.oneOf) or relation:
                return
        elif self._kind(node) in wanted:
            return
        names = sorted(local_name(iri) for iri, kind in self.kinds.items() if kind in wanted)
        where, what = f"{self._where(subject)}: {_word(word)}", " or ".join(wanted)
        iri = URIRef(str(node))
        if local_name(iri) in names:
            raise KnowledgeError(f"{where}: <{brief(node)}> is no {what}, though another is called {local_name(iri)}")
        raise UnknownNameError.of(what, local_name(iri), names, where)

    def _kind(self, node: Node) -> str:
        if node in (OWL.Thing, OWL.Nothing, OWL.NamedIndividual) or is_aligned(node):
            return CLASS
        if str(node).startswith(str(XSD)) or node == RDFS.Literal:
            return "data range"
        return self.kinds.get(URIRef(str(node)), "")

    def _refuse_node(self, node: BNode) -> None:
        graph, uses = self.document.graph, self.used.get(node, ())
        words = [word for word in graph.predicates(node) if word != RDF.type and not self._is_note(word)]
        types = set(graph.objects(node, RDF.type))
        shown = brief_list(sorted({_word(word) for word in words} | {_word(each) for each in types}))
        if len(uses) > 1 or self._root(node) is None:
            raise KnowledgeError(f"{self._where(node)}: a node without a name is used twice: {shown}; write it twice")
        use = next((word for _, word in uses), None)
        if use is not None and self._is_note(use):
            return
        if use is not None and use in _OWN_NODES:
            own = _OWN_NODES[use]
            for word in words:
                if word not in own:
                    raise self._unread(node, f"{_word(word)} in {_word(use)}", own, word)
            return
        allowed = self._allowed(node, types)
        said = frozenset(words) - (_OF_CLASSES if allowed == _EXPRESSIONS else frozenset())
        once = len(said) == sum(word in said for word in words)
        if said in allowed and once and (use or allowed != _EXPRESSIONS or frozenset(words) & _OF_CLASSES):
            foreign = sorted(_word(each) for each in types - _NODE_TYPES)
            if not foreign:
                return
            shown = ", ".join(foreign)
        known: Words = frozenset({word for some in allowed for word in some})
        near = "".join(did_you_mean(_word(word), map(_word, known)) for word in words if word not in known)
        behind = f" behind {_word(use)}" if use else ""
        raise KnowledgeError(f"{self._where(node)}: a node without a name{behind} is not read: {shown}{near}")

    def _allowed(self, node: BNode, types: set[Node]) -> frozenset[Words]:
        """Return by which words a node without a name may be written where it stands."""
        axioms = [shapes for kind, shapes in _AXIOMS.items() if kind in types]
        uses = self.used.get(node, ())
        if not uses:
            return axioms[0] if axioms else _EXPRESSIONS
        subject, word = uses[0]
        if axioms:
            return frozenset()
        if word in _LISTS or word == RDF.rest:
            return _LIST
        while word in (RDF.first, RDF.rest) and subject in self.used:
            subject, word = self.used[subject][0]
            if word in _LISTS:
                return _LISTS[word]
        return _NODES.get(word, frozenset())


def _word(node: Node) -> str:
    """Return a word as a file usually writes it."""
    for prefix, namespace in (("owl", OWL), ("rdf", RDF), ("rdfs", RDFS), ("xsd", XSD)):
        if str(node).startswith(str(namespace)):
            return f"{prefix}:{local_name(URIRef(str(node)))}"
    return f":{local_name(URIRef(str(node)))}" if str(node).startswith(str(PRO)) else f"<{brief(node)}>"

"""What is written in OWL is read, or refused by name: nothing is passed over without a word."""

from __future__ import annotations

from pathlib import Path

import pytest
from situations import load

from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.constructs import refuse_unread
from prolepsis.knowledge.turtle import built_in_documents
from prolepsis.terms.errors import InconsistentError, InputError

MORE = """@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix dcterms: <http://purl.org/dc/terms/> .
@prefix qudt: <http://qudt.org/schema/qudt/> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix ex: <http://example.org/> .
:a a :Block . :t a :Table .
"""
HEAVY = "[ a rdfs:Datatype ; owl:onDatatype xsd:double ; owl:withRestrictions ( [ xsd:minInclusive 2.0 ] ) ]"


def loaded(folder: Path, text: str) -> KnowledgeBase:
    return load(folder, MORE + text)


def restriction(about: str, said: str) -> str:
    return f"[ a owl:Restriction ; owl:onProperty {about} ; {said} ]"


def test_all_of_the_built_in_ontology_is_read() -> None:
    refuse_unread(built_in_documents(), built_in=True)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        (":D a owl:Class ; owl:equivelentClass :Block .", "owl:equivelentClass .*did you mean 'owl:equivalentClass'"),
        (":D a owl:Class ; owl:hasKey ( :mass ) .", "owl:hasKey of the class D"),
        ("<http://example.org/o> a owl:Ontology ; owl:imports <http://example.org/p> .", "owl:imports http://exa"),
        (":D a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :on ; owl:hasSelf true ] .", "hasSelf"),
        (":D a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :on ; owl:some :Block ] .", "owl:some"),
        (
            ":D a owl:Class ; owl:equivalentClass [ owl:unionOf ( :Block :Ball ) ; owl:complementOf :Block ] .",
            "unionOf",
        ),
        (":D a owl:Class ; owl:equivalentClass [ owl:unionOf :Block ] .", "owl:unionOf needs a list"),
        ("_:x owl:complementOf _:x .", "used twice"),
        ("_:x owl:complementOf :Block . :D a owl:Class ; rdfs:subClassOf _:x ; owl:disjointWith _:x .", "used twice"),
        ("[ a owl:Class ; owl:unionOf ( :Block :Ball ) ] rdfs:label 'nothing' .", "a node without a name is not read"),
        (f":Heavy a rdfs:Datatype ; owl:equivalentClass {HEAVY} .", "a data range with a name, Heavy"),
        (":a rdfs:subClassOf :Ball .", "rdfs:subClassOf of the individual a"),
        (":a :default [ :of :mass ; :value 1.0 ] .", ":default of the individual a"),
        (":p a owl:ObjectProperty . :a :p [ :mass 3.0 ] .", "a node without a name behind :p"),
        (":p a owl:ObjectProperty ; rdfs:subPropertyOf :mass .", "no relation or annotation named 'mass'"),
        (":w a owl:DatatypeProperty ; rdfs:subPropertyOf :colour .", "rdfs:subPropertyOf of the property of values w"),
        (":p a owl:ObjectProperty , owl:DatatypeProperty .", "p is declared as property of values and relation"),
        (":D a owl:Class ; rdfs:subClassOf ex:Egg .", "<http://example.org/Egg> is no class, though"),
        ("ex:Egg a owl:Class .", "two things are called Egg: <https.*#Egg> and <http://example.org/Egg>"),
        ("ex:mass a owl:DatatypeProperty .", "two things are called mass"),
        ("ex:Egg a owl:ObjectProperty .", "two things are called Egg"),
        (":b a :Block ; :on ex:t .", "<http://example.org/t> is no individual, though another is called t"),
        (":D a owl:Class ; rdfs:subClassOf ex:Unknown .", "no class named 'Unknown'"),
        (f":D a owl:Class ; rdfs:subClassOf {restriction(':mass', 'owl:someValuesFrom xsd:string')} .", "is no string"),
        (f":D a owl:Class ; rdfs:subClassOf {restriction(':on', 'owl:minCardinality -1')} .", "a whole number of at"),
        (
            f":w a owl:DatatypeProperty . :Block rdfs:subClassOf {restriction(':w', 'owl:minCardinality 2')} .",
            "a count of 2 of w, which may have several values",
        ),
    ],
)
def test_what_is_not_read_is_refused_by_name(tmp_path: Path, text: str, named: str) -> None:
    with pytest.raises(InputError, match=named):
        loaded(tmp_path, text)


@pytest.mark.parametrize("word", ["intersectionOf", "unionOf", "oneOf", "members", "disjointUnionOf"])
@pytest.mark.parametrize(
    "links",
    [
        "rdf:first :Block ; rdf:rest _:l .",
        "rdf:first :Block ; rdf:rest _:m . _:m rdf:first :Ball ; rdf:rest _:l .",
        "rdf:first :Block ; rdf:rest :Ball .",
        "rdf:first :Block .",
        "rdf:rest () .",
        "rdf:first :Block , :Ball ; rdf:rest () .",
        "rdf:first :Block ; rdf:rest () , ( :Ball ) .",
    ],
)
def test_a_list_that_is_none_is_refused_wherever_one_is_read(tmp_path: Path, word: str, links: str) -> None:
    meant = f":D a owl:Class ; owl:equivalentClass [ owl:{word} _:l ] ." if "Of" in word else f"[] owl:{word} _:l ."
    with pytest.raises(InputError, match="a list that is written with rdf:first and rdf:rest has no end or no member"):
        loaded(tmp_path, f"{meant} _:l {links}")


@pytest.mark.parametrize(
    "text",
    [
        ":D a owl:Class ; rdfs:label 'd' ; rdfs:seeAlso ex:D ; owl:deprecated true ; dcterms:creator 'me' .",
        ":note a owl:AnnotationProperty ; rdfs:comment 'n'. :a :note [ dcterms:extent ( 1 2 ) ] ; dcterms:hasPart :t.",
        "<http://example.org/o> a owl:Ontology ; owl:versionInfo '1' ; owl:imports <https://w3id.org/prolepsis> .",
        "[] a owl:Axiom ; owl:annotatedSource :Block ; owl:annotatedProperty rdfs:subClassOf ;"
        " owl:annotatedTarget :Solid ; rdfs:comment 'so it is' .",
        ":a owl:differentFrom :t . [] a owl:AllDifferent ; owl:distinctMembers ( :a :t ) .",
        ":a a owl:Thing , owl:NamedIndividual .",
    ],
)
def test_what_says_nothing_that_could_be_false_is_taken(tmp_path: Path, text: str) -> None:
    base = loaded(tmp_path, text)
    assert base.kind("a") == "Block" and not base.unchecked and not base.is_a("t", "Part")


@pytest.mark.parametrize(
    "text",
    [
        "[ owl:intersectionOf ( :Block :Solid ) ] rdfs:subClassOf :Ball . :Ball owl:disjointWith :Block .",
        ":D a owl:Class ; owl:disjointUnionOf ( :Block :Ball ) . :a a :Ball .",
        ":D a owl:Class ; owl:complementOf :Block . :a a :D .",
        ":a :on :t . [] a owl:NegativePropertyAssertion ; owl:sourceIndividual :a ; owl:assertionProperty :on ;"
        " owl:targetIndividual :t .",
        ":a :mass 2.0 . [] a owl:NegativePropertyAssertion ; owl:sourceIndividual :a ; owl:assertionProperty :mass ;"
        " owl:targetValue 2.0 .",
        ":p a owl:ObjectProperty . :q a owl:ObjectProperty . :a :p :t ; :q :t ."
        " [] a owl:AllDisjointProperties ; owl:members ( :p :q ) .",
        f":w a owl:DatatypeProperty ; qudt:hasUnit unit:KiloGM ; rdfs:range {HEAVY} . :a :w 1.0 .",
        f":a :mass 2.0 . :Block rdfs:subClassOf {restriction(':mass', 'owl:maxCardinality 0')} .",
        # Whatever the value, it is on one side of 2 or the other.
        f":w a owl:DatatypeProperty ; qudt:hasUnit unit:KiloGM . :Block rdfs:subClassOf"
        f" {restriction(':w', 'owl:someValuesFrom xsd:double')} , {restriction(':w', f'owl:allValuesFrom {HEAVY}')} ,"
        f" [ owl:complementOf {restriction(':w', f'owl:someValuesFrom {HEAVY}')} ] .",
    ],
)
def test_every_kind_of_axiom_can_contradict(tmp_path: Path, text: str) -> None:
    with pytest.raises(InconsistentError, match="the knowledge base contradicts itself: "):
        loaded(tmp_path, text)


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (":mass 2.0", restriction(":mass", "owl:someValuesFrom xsd:double")),
        (":mass 2.0", restriction(":mass", "owl:minCardinality 1")),
        (":note '1'", restriction(":note", "owl:someValuesFrom xsd:string")),
        (":ripe false", restriction(":ripe", "owl:someValuesFrom xsd:boolean")),
        (":ripe 1", restriction(":ripe", "owl:hasValue true")),
    ],
)
def test_a_stated_value_is_a_value(tmp_path: Path, value: str, said: str) -> None:
    declared = ":note a owl:DatatypeProperty . :ripe a owl:DatatypeProperty ; rdfs:range xsd:boolean ."
    base = loaded(tmp_path, f"{declared} :D a owl:Class ; owl:equivalentClass {said} . :b a :Block ; {value} .")
    assert base.is_a("b", "D") and not base.is_a("t", "D") and not base.unchecked

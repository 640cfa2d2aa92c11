"""Bad classes and properties of one's own are refused in one line; what would have no effect is refused too."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import InputError, KnowledgeError

PREFIX = """\
@prefix : <https://w3id.org/prolepsis#> . @prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> . @prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix qudt: <http://qudt.org/schema/qudt/> . @prefix unit: <http://qudt.org/vocab/unit/> .
"""
LENGTH = (
    ":Q a owl:Class ; rdfs:subClassOf :Egg ; :default [ :of :length ; :value 0.03 ; :source 's' ; :certainty 'D' ] ."
)
OWN = ":p a owl:DatatypeProperty ; rdfs:range xsd:double ; qudt:hasUnit unit:M ; :above 0 . :e a :Egg ; :p 1 ."
RANGE = """:H a owl:Class ; owl:equivalentClass [ a owl:Restriction ; owl:onProperty :mass ; owl:someValuesFrom
 [ a rdfs:Datatype ; owl:onDatatype xsd:double ; owl:withRestrictions ( [ xsd:minInclusive 2.0 ] ) ] ] ."""


def refusal(folder: Path, text: str) -> str:
    """Return the message with which a file is refused."""
    path = folder / "s.ttl"
    path.write_text(PREFIX + text)
    with pytest.raises(InputError) as caught:
        KnowledgeBase.load(path)
    message = str(caught.value)
    assert "\n" not in message
    return message.replace(f"{folder}/", "")


@pytest.mark.parametrize(
    ("good", "old", "new", "message"),
    [
        (LENGTH, "0.03", "0.03 ; :deviation 'x'", "s.ttl:4: the default length of Q: the deviation must be a finite"),
        (LENGTH, "0.03", "0.03 ; :deviation -1", "s.ttl:4: the default length of Q: the deviation must be a finite"),
        (
            LENGTH,
            "0.03",
            "-0.03",
            "s.ttl:4: the default length of Q: length = -0.03: must be finite and at least 1e-05",
        ),
        (LENGTH, "0.03", "'3 kg'", "unit 'kg' does not fit"),
        (LENGTH, ":value 0.03 ;", "", "s.ttl:4: the default length of Q has no :value"),
        (LENGTH, ":source 's' ;", "", "s.ttl:4: the default length of Q has no :source"),
        (LENGTH, "'D'", "'Z'", "s.ttl:4: the default length of Q has the certainty 'Z'; known: T (seen in a text)"),
        (LENGTH, ":length", ":lenth", "s.ttl:4: the default lenth of Q is of no known property"),
        (LENGTH, ":Egg", ":Eg", "s.ttl:4: no class named 'Eg'; did you mean 'Egg'?"),
        (OWN, "above 0", "above 'x'", "s.ttl:4: above must be a number, not 'x'"),
        (
            OWN,
            "unit:M",
            "unit:FURLONG",
            "s.ttl:4: property p has the unknown unit <http://qudt.org/vocab/unit/FURLONG>",
        ),
        (RANGE, "2.0", "'x'", "s.ttl: a restriction on mass must name a number, not 'x'"),
        (RANGE, ":mass", ":masss", "s.ttl:4: no property named 'masss'; did you mean 'mass'?"),
    ],
)
def test_a_bad_declaration(tmp_path: Path, good: str, old: str, new: str, message: str) -> None:
    path = tmp_path / "good.ttl"
    path.write_text(PREFIX + good)
    KnowledgeBase.load(path)
    assert message in refusal(tmp_path, good.replace(old, new))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[ a :Egg ] .", "s.ttl: a nameless Egg: give it a name"),
        (":e a :Egg ; :hasPart [ a :EggShell ] .", "s.ttl: a nameless EggShell: give it a name"),
        (":Egg :mass 3 .", "s.ttl:4: Egg is a class: write [ :of :mass ; ... ] as a :default of it"),
        (":a a :Egg ; owl:sameAs :b . :b a :Egg .", "s.ttl:4: owl:sameAs is not supported: two names are two things"),
        (":e a :hasPart .", "s.ttl:4: no class named 'hasPart'; did you mean 'Part'?"),
        (":e :mass 3 .", "s.ttl:4: it has no class: no individual named 'e'"),
    ],
)
def test_what_would_have_no_effect(tmp_path: Path, text: str, message: str) -> None:
    assert message in refusal(tmp_path, text)


def test_axioms_outside_owl_2_dl(tmp_path: Path) -> None:
    text = """:p a owl:TransitiveProperty , owl:ObjectProperty . :H a owl:Class ; rdfs:subClassOf
      [ a owl:Restriction ; owl:onProperty :p ; owl:maxCardinality 1 ] . :e a :Egg ."""
    assert refusal(tmp_path, text).startswith("the reasoner refuses the axioms: ontology is outside OWL 2 DL")


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeError, match=r"absent\.ttl: cannot read the Turtle file: No such file"):
        KnowledgeBase.load(tmp_path / "absent.ttl")

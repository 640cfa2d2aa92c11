"""What the code relies on of pyhermit, which is young: a new version that behaves otherwise is noticed here."""

from __future__ import annotations

import pytest

from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.chaining import clashes
from prolepsis.knowledge.reasoner import is_consistent
from prolepsis.terms.errors import KnowledgeError, UndecidedError

DECLARED = tuple(f"Declaration(Class(<c:{name}>))" for name in "ABN") + ("Declaration(ObjectProperty(<r:r>))",)


def consistent(*texts: str) -> bool:
    """Return whether the axioms have a model."""
    return is_consistent(tuple(Axiom(text) for text in (*DECLARED, *texts)))


def test_disjoint_classes_clash_on_an_individual() -> None:
    disjoint, one = "DisjointClasses(<c:A> <c:B>)", "ClassAssertion(<c:A> <i:i>)"
    assert consistent(disjoint, one)
    assert not consistent(disjoint, one, "ClassAssertion(<c:B> <i:i>)")
    assert clashes([Axiom(disjoint), Axiom(one), Axiom("ClassAssertion(<c:B> <i:i>)")])
    assert not clashes([Axiom(disjoint), Axiom(one)])


def test_a_denial_by_a_disjoint_name_shows_what_follows_by_cases() -> None:
    # Chaining cannot find that one of two cases holds; the reasoner must.
    texts = (
        "SubClassOf(<c:A> <c:N>)",
        "SubClassOf(<c:B> <c:N>)",
        "ClassAssertion(ObjectUnionOf(<c:A> <c:B>) <i:i>)",
        "Declaration(Class(<c:N/not>))",
        "DisjointClasses(<c:N> <c:N/not>)",
    )
    assert consistent(*texts)
    assert not consistent(*texts, "ClassAssertion(<c:N/not> <i:i>)")
    assert not clashes([Axiom(text) for text in (*texts, "ClassAssertion(<c:N/not> <i:i>)")])


def test_functional_roles_merge_their_values() -> None:
    texts = ("FunctionalObjectProperty(<r:r>)", "DisjointClasses(<c:A> <c:B>)")
    some_a, some_b = "ObjectSomeValuesFrom(<r:r> <c:A>)", "ObjectSomeValuesFrom(<r:r> <c:B>)"
    both = f"ClassAssertion(ObjectIntersectionOf({some_a} {some_b}) <i:i>)"
    assert consistent(texts[1], both)
    assert not consistent(*texts, both)


def test_individuals_may_be_the_same_unless_they_are_said_to_differ() -> None:
    texts = ("FunctionalObjectProperty(<r:r>)", *(f"ObjectPropertyAssertion(<r:r> <i:i> <i:{x}>)" for x in "xy"))
    assert consistent(*texts)
    assert not consistent(*texts, "DifferentIndividuals(<i:x> <i:y>)")


def test_an_undeclared_class_is_refused_and_not_taken_for_empty() -> None:
    with pytest.raises(KnowledgeError, match="the reasoner refuses the axioms: .*DECLARATION"):
        consistent("SubClassOf(<c:A> <c:Unknown>)")


def test_where_the_reasoner_overlooks_contradictions_it_decides_none() -> None:
    # Three values of one thing would all be the one individual.
    three = "ObjectSomeValuesFrom(ObjectInverseOf(<r:r>) ObjectMinCardinality(3 <r:r> <c:B>))"
    texts = ("EquivalentClasses(<c:A> ObjectOneOf(<i:1>))", f"EquivalentClasses(<c:A> {three})")
    with pytest.raises(UndecidedError, match="counts, inverses and individuals"):
        consistent(*texts)
    assert not consistent(*texts, "ClassAssertion(<c:N> <i:1>)", "DisjointClasses(<c:A> <c:N>)")

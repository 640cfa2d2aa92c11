"""What forward chaining decides without the reasoner is what the reasoner decides, on axioms drawn at random."""

from __future__ import annotations

from itertools import product

import pytest
from finite_models import has_model
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

from prolepsis.knowledge.alike import alike
from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.chaining import chain, clashing, is_whole
from prolepsis.knowledge.reasoner import is_consistent
from prolepsis.knowledge.reasoning import Probe, denials
from prolepsis.terms.errors import KnowledgeError

SLOW = (HealthCheck.too_slow, HealthCheck.filter_too_much)
CLASSES = [f"<c:{name}>" for name in "ABCD"]
ROLES = ["<r:p>", "<r:q>"]
PEOPLE = [f"<i:{k}>" for k in range(4)]
DECLARED = [
    *(f"Declaration(Class({name}))" for name in CLASSES),
    *(f"Declaration(ObjectProperty({role}))" for role in ROLES),
]

classes, roles, people = st.sampled_from(CLASSES), st.sampled_from(ROLES), st.sampled_from(PEOPLE)
ways = roles | st.builds("ObjectInverseOf({})".format, roles)
expressions = st.recursive(
    classes,
    lambda inner: st.one_of(
        st.builds("ObjectIntersectionOf({} {})".format, inner, inner),
        st.builds("ObjectUnionOf({} {})".format, inner, inner),
        st.builds("ObjectSomeValuesFrom({} {})".format, ways, inner),
        st.builds("ObjectAllValuesFrom({} {})".format, ways, inner),
        st.builds("ObjectComplementOf({})".format, inner),
        st.builds("ObjectMaxCardinality(1 {} {})".format, ways, inner),
        st.builds("ObjectMinCardinality(2 {} {})".format, ways, inner),
        st.builds("ObjectExactCardinality({} {} {})".format, st.integers(0, 2), ways, inner),
        st.builds("ObjectHasValue({} {})".format, ways, people),
        st.builds("ObjectOneOf({})".format, people),
    ),
    max_leaves=3,
)
terms = st.one_of(
    st.builds("SubClassOf({} {})".format, expressions, expressions),
    st.builds("EquivalentClasses({} {})".format, classes, expressions),
    st.builds("DisjointClasses({} {})".format, classes, expressions),
    st.builds("ObjectPropertyDomain({} {})".format, roles, classes),
    st.builds("ObjectPropertyRange({} {})".format, roles, classes),
    st.builds("FunctionalObjectProperty({})".format, roles),
    st.builds("InverseFunctionalObjectProperty({})".format, roles),
    st.builds("SymmetricObjectProperty({})".format, roles),
    st.just("SubObjectPropertyOf(<r:p> <r:q>)"),
    st.just("InverseObjectProperties(<r:p> <r:q>)"),
)
facts = st.one_of(
    st.builds("ClassAssertion({} {})".format, classes, people),
    st.builds("ObjectPropertyAssertion({} {} {})".format, roles, people, people),
)


def axioms(texts: list[str]) -> tuple[Axiom, ...]:
    return tuple(Axiom(text) for text in dict.fromkeys(texts))


def consistent(some: tuple[Axiom, ...]) -> bool:
    """Return what the reasoner says; what it refuses (a class that is to differ from itself) is drawn anew."""
    try:
        return is_consistent(some)
    except KnowledgeError:
        reject()


@pytest.mark.laws
@settings(max_examples=300, deadline=None, derandomize=True, suppress_health_check=SLOW)
@given(st.lists(terms, min_size=1, max_size=5), st.lists(facts, min_size=1, max_size=8))
def test_what_chaining_decides_is_right(said: list[str], told: list[str]) -> None:
    different = [f"DifferentIndividuals({' '.join(PEOPLE)})"]
    background, people_said = axioms([*DECLARED, *said]), axioms([*told, *different])
    everything = background + people_said
    found = chain(everything)
    if clashing(found) is not None:
        assert not consistent(everything)
        return
    follows = found.named()
    whole = is_whole(chain(everything))
    if whole:
        others = tuple(
            Probe(person[1:-1], name[1:-1], frozenset({name[1:-1]}))
            for person, name in product(PEOPLE, CLASSES)
            if name not in follows[person]
        )
        assert consistent((*everything, *denials(others)))
    for person, name in product(PEOPLE, CLASSES):
        if name in follows[person] and name not in told:
            denied = denials((Probe(person[1:-1], name[1:-1], frozenset({name[1:-1]})),))
            assert not consistent((*everything, *denied))
            break


@pytest.mark.laws
@settings(max_examples=150, deadline=None, derandomize=True, suppress_health_check=SLOW)
@given(st.lists(terms, min_size=1, max_size=4), st.lists(facts, min_size=2, max_size=7))
def test_chaining_and_the_reasoner_are_right_of_all_finite_models(said: list[str], told: list[str]) -> None:
    # The reasoner is young: it overlooks counts in conditions, which another judge does not.
    everything = axioms([*DECLARED, *said, *told, f"DifferentIndividuals({' '.join(PEOPLE)})"])
    decided = consistent(everything)
    texts = [axiom.text for axiom in everything]
    if has_model(texts, tuple(PEOPLE), 2):
        assert decided
    elif not any("Inverse" in text or "Symmetric" in text for text in texts):
        # Without inverses what has a model has a finite one, and so few counts of two need few things.
        assert decided == has_model(texts, tuple(PEOPLE), 5)
    found = chain(everything)
    if clashing(found) is not None:
        assert not decided
    elif is_whole(found):
        assert decided


@pytest.mark.laws
@settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=SLOW)
@given(st.lists(terms, min_size=1, max_size=4), st.lists(facts, min_size=1, max_size=5), st.integers(2, 4))
def test_one_of_those_that_are_alike_is_enough(said: list[str], told: list[str], count: int) -> None:
    # Each individual but the first, to whom all may be related, is there several times.
    copies = [
        text.replace("<i:1>", f"<i:1-{k}>").replace("<i:2>", f"<i:2-{k}>").replace("<i:3>", f"<i:3-{k}>")
        for k in range(count)
        for text in told
    ]
    names = ["<i:0>", *(f"<i:{n}-{k}>" for n in (1, 2, 3) for k in range(count))]
    everyone = axioms([*copies, f"DifferentIndividuals({' '.join(names)})"])
    background = axioms([*DECLARED, *said])
    groups = alike(everyone, background)
    left = {name for members in groups.components for name in members}
    kept = [a.text for a in everyone if not any(name in a.text for name in set(names) - left)]
    some = axioms([*kept, *([f"DifferentIndividuals({' '.join(sorted(left))})"] if len(left) > 1 else [])])
    assert consistent(background + everyone) == consistent(background + some)

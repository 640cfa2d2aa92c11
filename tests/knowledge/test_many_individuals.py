"""The reasoner's work grows like the situation: by a model where chaining finds one, by what is alike where not."""

from __future__ import annotations

from pathlib import Path

import pytest
from situations import load

from prolepsis.knowledge.alike import alike, counts_along_chains
from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.chaining import chain, clashes, clashing, is_whole
from prolepsis.terms.errors import InconsistentError


def axioms(*texts: str) -> tuple[Axiom, ...]:
    return tuple(Axiom(text) for text in texts)


def blocks(count: int) -> tuple[Axiom, ...]:
    """Return facts: as many blocks on one table, in pairs on each other."""
    names = [f"<i:{k}>" for k in range(count)]
    said = [f"ClassAssertion(<c:Block> {name})" for name in names]
    said += [f"ObjectPropertyAssertion(<r:on> {name} <i:table>)" for name in names[::2]]
    said += [
        f"ObjectPropertyAssertion(<r:on> {high} {low})" for low, high in zip(names[::2], names[1::2], strict=False)
    ]
    return axioms(*said, "ClassAssertion(<c:Table> <i:table>)", f"DifferentIndividuals({' '.join(names)} <i:table>)")


TERMS = axioms(
    "SubClassOf(<c:Block> <c:Solid>)",
    "SubClassOf(<c:Table> <c:Solid>)",
    "ObjectPropertyDomain(<r:on> <c:Solid>)",
    "InverseObjectProperties(<r:on> <r:under>)",
    "EquivalentClasses(<c:Loaded> ObjectSomeValuesFrom(<r:under> ObjectSomeValuesFrom(<r:under> <c:Solid>)))",
    "SubClassOf(<c:Solid> ObjectSomeValuesFrom(<r:of> <c:Stuff>))",
)


def test_steps_grow_like_the_individuals() -> None:
    steps = [chain(TERMS + blocks(count)).steps for count in (100, 1000)]
    assert 9.0 < steps[1] / steps[0] < 11.0


def test_steps_grow_like_a_chain_of_classes(tmp_path: Path) -> None:
    def told(count: int) -> int:
        classes = [f"SubClassOf(<c:{k + 1}> <c:{k}>)" for k in range(count)]
        return chain(axioms(*classes, f"ClassAssertion(<c:{count}> <i:i>)")).steps

    assert told(3000) < 11 * told(300)
    text = ":C0 a owl:Class ; rdfs:subClassOf :Block ." + "".join(
        f":C{k + 1} a owl:Class ; rdfs:subClassOf :C{k} ." for k in range(600)
    )
    assert load(tmp_path, f"{text} :b a :C600 .").kind("b") == "C600"


def test_what_chaining_finds_is_a_model_where_nothing_needs_cases() -> None:
    found = chain(TERMS + blocks(10))
    assert "<c:Loaded>" in found.named()["<i:table>"] and "<c:Loaded>" not in found.named()["<i:0>"]
    assert clashing(found) is None and is_whole(found)


@pytest.mark.parametrize(
    "text",
    [
        "SubClassOf(<c:Block> ObjectUnionOf(<c:Wood> <c:Stone>))",
        "SubClassOf(<c:Table> ObjectMaxCardinality(3 <r:under> <c:Block>))",
        "SubClassOf(<c:Table> ObjectMinCardinality(21 <r:of> <c:Wood>))",
        "SubClassOf(ObjectComplementOf(<c:Loaded>) <c:Light>)",
        "ReflexiveObjectProperty(<r:on>)",
        "SubObjectPropertyOf(ObjectPropertyChain(<r:on> <r:on>) <r:above>)",
        "EquivalentClasses(<c:Block> <c:Brick> <c:Cube>)",
    ],
)
def test_what_chaining_cannot_show_is_not_taken_for_shown(text: str) -> None:
    assert not is_whole(chain((*TERMS, *blocks(10), Axiom(text))))


@pytest.mark.parametrize(
    "text",
    [
        "DisjointClasses(<c:Block> <c:Solid>)",
        "SubClassOf(<c:Block> ObjectComplementOf(<c:Solid>))",
        "SubClassOf(<c:Loaded> <http://www.w3.org/2002/07/owl#Nothing>)",
        "FunctionalObjectProperty(<r:under>)",
    ],
)
def test_what_cannot_be_is_seen_without_the_reasoner(text: str) -> None:
    assert clashes((*TERMS, *blocks(10), Axiom(text)))
    assert not clashes((*TERMS, *blocks(10)))


def test_values_without_end_end() -> None:
    endless = axioms("SubClassOf(<c:Block> ObjectSomeValuesFrom(<r:of> <c:Block>))", "ClassAssertion(<c:Block> <i:i>)")
    found = chain(endless)
    assert is_whole(found) and len(found.structure.types) < 20


def test_what_only_a_shared_value_would_show_is_not_taken_for_shown() -> None:
    # A value that is shared has two subjects, which this forbids.
    endless = axioms(
        "SubClassOf(<c:Block> ObjectSomeValuesFrom(<r:of> <c:Block>))",
        "InverseFunctionalObjectProperty(<r:of>)",
        "ClassAssertion(<c:Block> <i:i>)",
    )
    assert not is_whole(chain(endless))


def test_pairs_of_blocks_on_one_table_are_alike() -> None:
    found = alike(blocks(40), TERMS)
    assert sorted(map(len, found.components)) == [3]
    assert {found.stands_for[f"<i:{k}>"] for k in range(0, 40, 2)} == {found.stands_for["<i:0>"]}
    assert {found.stands_for[f"<i:{k}>"] for k in range(1, 40, 2)} == {found.stands_for["<i:1>"]}


@pytest.mark.parametrize(
    "text",
    [
        "SubClassOf(<c:Table> ObjectMaxCardinality(3 <r:under> <c:Block>))",
        "InverseFunctionalObjectProperty(<r:on>)",
        "EquivalentClasses(<c:Full> ObjectMinCardinality(5 <r:under> <c:Block>))",
        "SubClassOf(<c:Block> ObjectHasValue(<r:on> <i:table>))",
    ],
)
def test_those_who_are_counted_or_named_are_all_asked_about(text: str) -> None:
    found = alike(blocks(8), (*TERMS, Axiom(text)))
    assert sum(map(len, found.components)) == 9
    assert all(name == other for name, other in found.stands_for.items())


def test_a_count_of_what_stands_on_one_does_not_keep_those_apart_that_stand_on_it() -> None:
    found = alike(blocks(8), (*TERMS, Axiom("FunctionalObjectProperty(<r:on>)")))
    assert sum(map(len, found.components)) == 3


def test_names_do_not_decide_the_order_of_what_is_alike() -> None:
    renamed = tuple(Axiom(a.text.replace("<i:0>", "<i:z>").replace("<i:1>", "<i:a>")) for a in blocks(2))
    (one,), (other,) = alike(blocks(2), TERMS).components, alike(renamed, TERMS).components
    assert [{"<i:0>": "<i:z>", "<i:1>": "<i:a>"}.get(name, name) for name in one] == list(other)


def test_counting_along_a_chain_is_outside_owl_2_dl() -> None:
    counted = Axiom("FunctionalObjectProperty(<r:under>)")
    assert not counts_along_chains((*TERMS, counted))
    assert counts_along_chains((*TERMS, counted, Axiom("TransitiveObjectProperty(<r:on>)")))


def test_a_contradiction_among_many_is_told_by_the_few_that_clash(tmp_path: Path) -> None:
    many = " ".join(f":b{k} a :Block ; :on :t ." for k in range(300))
    with pytest.raises(InconsistentError) as caught:
        load(tmp_path, f":t a :Table . {many} :b7 a :Liquid .")
    message = str(caught.value)
    assert "b7 is a Block" in message and "b7 is a Liquid" in message and "b8" not in message


def test_twelve_eggs_on_a_table_are_checked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PROLEPSIS_CACHE", "")
    monkeypatch.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    base = load(tmp_path, ":t a :Table . " + " ".join(f":egg{k} a :Egg ; :on :t ." for k in range(12)))
    assert base.unchecked == "" and all(base.is_a(f"egg{k}", "Fragile") for k in range(12))

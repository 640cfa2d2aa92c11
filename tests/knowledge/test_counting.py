"""Counting, nothing and cases: contradictions and types that are easily overlooked."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import InconsistentError

HEAD = """
@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
:table1 a :Table . :table2 a :Table .
"""


def loaded(tmp_path: Path, text: str) -> KnowledgeBase:
    file = tmp_path / "situation.ttl"
    file.write_text(HEAD + text)
    return KnowledgeBase.load(file)


ON_TWO = ":b1 a :Block ; :on :table1 , :table2 . :b2 a :Block ; :on :table1 , :table2 ."


@pytest.mark.parametrize(
    "count",
    [
        'owl:onProperty :on ; owl:maxQualifiedCardinality "1"^^<http://www.w3.org/2001/XMLSchema#nonNegativeInteger> ;'
        " owl:onClass :Table",
    ],
)
def test_those_on_whom_somebody_is_are_counted_one_by_one(tmp_path: Path, count: str) -> None:
    with pytest.raises(InconsistentError):
        loaded(tmp_path, f":Block rdfs:subClassOf [ a owl:Restriction ; {count} ] . {ON_TWO}")


@pytest.mark.parametrize("steps", [1, 2, 3, 4, 6])
def test_a_contradiction_is_found_however_many_steps_away(tmp_path: Path, steps: int) -> None:
    likes = "[ a owl:Restriction ; owl:onProperty :likes ; owl:{} {} ]"
    wish = "[ a owl:Class ; owl:intersectionOf ( {} {} ) ]".format(
        likes.format("allValuesFrom", "owl:Nothing"), likes.format("someValuesFrom", ":Block")
    )
    for _ in range(steps):
        wish = likes.format("someValuesFrom", wish)
    with pytest.raises(InconsistentError):
        loaded(tmp_path, f":likes a owl:ObjectProperty . :Block rdfs:subClassOf {wish} . :b1 a :Block .")


def test_a_definition_by_a_count_finds_who_meets_it(tmp_path: Path) -> None:
    two = (
        "[ a owl:Restriction ; owl:onProperty :on ; owl:minQualifiedCardinality "
        '"2"^^<http://www.w3.org/2001/XMLSchema#nonNegativeInteger> ; owl:onClass :Table ]'
    )
    bridge = f":Bridge a owl:Class ; owl:equivalentClass [ a owl:Class ; owl:intersectionOf ( :Block {two} ) ] ."
    base = loaded(tmp_path, f"{bridge} :b1 a :Block ; :on :table1 , :table2 . :b2 a :Block ; :on :table1 .")
    assert not base.unchecked
    assert base.is_a("b1", "Bridge") and not base.is_a("b2", "Bridge")


def counted(word: str, number: int, of: str = ":Block") -> str:
    return (
        f"[ a owl:Restriction ; owl:onProperty :bears ; owl:{word} "
        f'"{number}"^^<http://www.w3.org/2001/XMLSchema#nonNegativeInteger> ; owl:onClass {of} ]'
    )


@pytest.mark.parametrize(
    "meaning",
    [
        counted("minQualifiedCardinality", 2),
        f"[ a owl:Class ; owl:complementOf {counted('maxQualifiedCardinality', 1)} ]",
    ],
)
def test_two_stated_things_are_two_however_it_is_said(tmp_path: Path, meaning: str) -> None:
    told = ":bears a owl:ObjectProperty . :b1 a :Block ; :bears :b2 , :b3 . :b2 a :Block ; :bears :b3 . :b3 a :Block ."
    base = loaded(tmp_path, f"{told} :Loaded a owl:Class ; owl:equivalentClass {meaning} .")
    assert [base.is_a(name, "Loaded") for name in ("b1", "b2")] == [True, False] and not base.unchecked
    for clash in (
        f"{told} {meaning} rdfs:subClassOf :Ball . :Ball owl:disjointWith :Block .",
        f"{told} :Loaded a owl:Class ; owl:equivalentClass {meaning} ; owl:disjointWith :Block .",
    ):
        with pytest.raises(InconsistentError, match=r"situation\.ttl:\d") as caught:
            loaded(tmp_path, clash)
        assert any(each.startswith("b1 bears b2 (") for each in caught.value.conflict)


@pytest.mark.parametrize(("most", "clash"), [(1, True), (2, False)])
def test_not_at_most_one_is_at_least_two(tmp_path: Path, most: int, clash: bool) -> None:
    many = f"[ a owl:Class ; owl:complementOf {counted('maxQualifiedCardinality', 1)} ]"
    told = f":Loaded a owl:Class ; rdfs:subClassOf {many} . :Light a owl:Class ; rdfs:subClassOf "
    told += (
        f"{counted('maxQualifiedCardinality', most)} . :bears a owl:ObjectProperty . :b1 a :Block , :Loaded , :Light ."
    )
    if clash:
        with pytest.raises(InconsistentError):
            loaded(tmp_path, told)
    else:
        assert loaded(tmp_path, told).is_a("b1", "Loaded")

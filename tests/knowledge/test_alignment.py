"""Correspondence with other ontologies: the IRIs that the design states are there, and nothing is imported."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase

DUL, SOMA = "http://www.ontologydesignpatterns.org/ont/dul/DUL.owl#", "http://www.ease-crc.org/ont/SOMA.owl#"


@pytest.fixture(scope="module")
def base() -> KnowledgeBase:
    """The built-in ontology."""
    return KnowledgeBase.load()


@pytest.mark.parametrize(
    ("name", "iri"),
    [
        ("PhysicalObject", DUL + "PhysicalObject"),
        ("Container", SOMA + "DesignedContainer"),
        ("Liquid", SOMA + "Fluid"),
        ("Pouring", SOMA + "Pouring"),
        ("Event", DUL + "Event"),
        ("Gripper", SOMA + "Gripper"),
        ("Table", SOMA + "Table"),
        ("Bowl", SOMA + "Bowl"),
        ("Cup", SOMA + "Cup"),
    ],
)
def test_a_class_tells_what_it_corresponds_to(base: KnowledgeBase, name: str, iri: str) -> None:
    assert base.vocabulary.classes[name].alignments == (iri,)
    assert f"  corresponds to: {iri}" in base.describe(name)


@pytest.mark.parametrize(
    ("name", "iri"), [("supports", SOMA + "SupportState"), ("contains", SOMA + "ContainmentState")]
)
def test_a_relation_tells_what_it_corresponds_to(base: KnowledgeBase, name: str, iri: str) -> None:
    entry = base.vocabulary.properties[name]
    assert entry.alignments == (iri,)
    assert entry.comment and f"  corresponds to: {iri}" in base.describe(name)


def test_what_the_others_lack_has_no_correspondence_and_nothing_foreign_is_declared(base: KnowledgeBase) -> None:
    for name in ("Egg", "EggShell", "EggYolk", "Fragile", "BrokenThing", "Sponge"):
        assert base.vocabulary.classes[name].alignments == ()
    for entry in (*base.vocabulary.classes.values(), *base.vocabulary.properties.values()):
        assert entry.iri.startswith("https://w3id.org/prolepsis#")


def test_supporting_is_resting_seen_from_below(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    path.write_text("@prefix : <https://w3id.org/prolepsis#> . :t a :Table ; :supports :egg1 . :egg1 a :Egg .")
    assert KnowledgeBase.load(path).relations() == (("on", "egg1", "t"),)


def test_a_hand_is_a_gripper_and_an_obstacle_stands_still(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(
        "@prefix : <https://w3id.org/prolepsis#> . :h a :Hand ; :wet true . :g a :Gripper . :o a :Obstacle ."
    )
    base = KnowledgeBase.load(path)
    assert base.kind("h") == base.kind("g") == "Gripper"
    assert base.is_a("h", "WetGripper") and base.is_a("g", "Hand")
    assert base.quantity("h", "friction") < base.quantity("g", "friction")
    assert base.kind("o") == "Obstacle" and base.is_a("o", "Furniture")

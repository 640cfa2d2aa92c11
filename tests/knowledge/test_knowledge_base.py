"""The knowledge base: inferred types, values with their origin, and what changes them."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.vocabulary import CERTAINTIES
from prolepsis.terms.errors import KnowledgeError

PREFIX = "@prefix : <https://w3id.org/prolepsis#> .\n"
PAPER = """
:floor a :Floor . :table1 a :Table .
:egg3 a :Egg ; :on :table1 ; :hasPart :eggshell3 , :yolk3 .
:eggshell3 a :EggShell ; :mass 0.01 .
:yolk3 a :EggYolk ; :mass 0.04 .
:hand1 a :Gripper .
"""


def load(folder: Path, text: str) -> KnowledgeBase:
    """Return the knowledge base of one situation."""
    path = folder / "situation.ttl"
    path.write_text(PREFIX + text)
    return KnowledgeBase.load(path)


@pytest.fixture(scope="module")
def paper(tmp_path_factory: pytest.TempPathFactory) -> KnowledgeBase:
    """The situation of the paper."""
    return load(tmp_path_factory.mktemp("paper"), PAPER)


def test_an_egg_is_inferred_breakable_fragile_and_a_container_of_liquid(paper: KnowledgeBase) -> None:
    assert {"Breakable", "Fragile", "Container", "LiquidContainer"} <= set(paper.classes("egg3"))
    assert paper.kind("egg3") == "Egg"
    assert not paper.is_a("table1", "Breakable")
    assert not paper.is_a("yolk3", "Container")


def test_asserted_values_are_kept_and_the_rest_comes_from_class_defaults(paper: KnowledgeBase) -> None:
    assert paper.value("eggshell3", "mass").origin == "asserted"
    assert paper.quantity("eggshell3", "mass") == 0.01
    strength = paper.value("eggshell3", "breakingForce")
    assert (strength.value, strength.unit, strength.origin, strength.deviation) == (45.0, "N", "class default", 7.0)
    assert paper.value("egg3", "mass").origin == "derived"
    assert paper.quantity("egg3", "mass") == pytest.approx(0.05)
    assert paper.parts("egg3") == ("eggshell3", "yolk3")


def test_an_egg_alone_has_its_default_parts(tmp_path: Path) -> None:
    base = load(tmp_path, ":egg1 a :Egg . :breakfast a :Egg .")
    assert base.parts("egg1") == ("eggshell1", "white1", "yolk1")
    assert base.parts("breakfast") == ("breakfast/shell", "breakfast/white", "breakfast/yolk")
    assert base.whole("yolk1") == "egg1"


def test_parts_are_named_by_the_class_of_their_whole_and_not_by_its_name(tmp_path: Path) -> None:
    base = load(
        tmp_path,
        ":egg1 a :MandM . :egg2 a :QuailEgg . :egg a :HardBoiledEgg . :eggs3 a :Egg . :quailEgg2 a :QuailEgg .",
    )
    assert base.parts("egg1") == ("egg1/kernel", "egg1/shell")
    assert base.parts("egg2") == ("eggshell2", "white2", "yolk2")
    assert base.parts("egg") == ("eggshell", "kernel")
    assert base.parts("eggs3") == ("eggs3/shell", "eggs3/white", "eggs3/yolk")
    assert base.parts("quailEgg2") == ("quailEgg2/shell", "quailEgg2/white", "quailEgg2/yolk")


def test_a_class_says_what_its_default_parts_are_called(tmp_path: Path) -> None:
    lamp = """@prefix owl: <http://www.w3.org/2002/07/owl#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
    :Lamp a owl:Class ; rdfs:subClassOf :Solid ;
        :defaultPart [ :of :LampShade ; :source "a test" ; :certainty "D" ] .
    :LampShade a owl:Class ; :needsWhole :Lamp ; rdfs:subClassOf :Solid ; :called "%s" .
    :lamp7 a :Lamp . :b a :Lamp . """
    base = load(tmp_path, lamp % "shade")
    assert (base.parts("lamp7"), base.parts("b")) == (("shade7",), ("b/shade",))
    with pytest.raises(
        KnowledgeError, match="parts of class LampShade are called 'Lamp shade'; allowed: small letters"
    ):
        load(tmp_path, lamp % "Lamp shade")


def test_one_triple_makes_the_hand_wet_and_lowers_its_friction(tmp_path: Path) -> None:
    dry = load(tmp_path, ":hand1 a :Gripper .")
    wet = load(tmp_path, ":hand1 a :Gripper . :hand1 :wet true .")
    assert wet.is_a("hand1", "WetGripper") and not dry.is_a("hand1", "WetGripper")
    assert wet.quantity("hand1", "friction") < dry.quantity("hand1", "friction")
    assert wet.kind("hand1") == "Gripper"


def test_an_override_is_marked_and_leaves_the_old_knowledge_base_as_it_was(paper: KnowledgeBase) -> None:
    changed = paper.with_values({"eggshell3.mass": "12 g", "eggshell3.friction": 0.4})
    assert changed.value("eggshell3", "mass").origin == "override"
    assert changed.quantity("egg3", "mass") == pytest.approx(0.052)
    assert paper.quantity("eggshell3", "mass") == 0.01


def test_a_stronger_shell_is_breakable_but_not_fragile(paper: KnowledgeBase) -> None:
    strong = paper.with_values({"eggshell3.breakingForce": "4 kN"})
    assert strong.is_a("egg3", "Breakable") and not strong.is_a("egg3", "Fragile")


def test_every_default_has_a_source_a_certainty_and_a_unit(paper: KnowledgeBase) -> None:
    defaults = [d for entry in paper.vocabulary.classes.values() for d in entry.defaults]
    assert len(defaults) > 50
    for default in defaults:
        entry = paper.vocabulary.properties[default.property]
        assert default.source and default.certainty in CERTAINTIES
        assert isinstance(default.value, str) or entry.si_unit


def test_relations_and_domain_are_plain_rows(paper: KnowledgeBase) -> None:
    assert paper.relations() == (("on", "egg3", "table1"),)
    domain = paper.domain()
    assert ("egg3", "Breakable") in domain.instances
    assert ("egg3", "yolk3") in domain.parts
    assert ("yolk3", "mass", 0.04) in domain.values

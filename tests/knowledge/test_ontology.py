"""The built-in ontology: every number has a unit, a source and a certainty, and every name says what it means."""

from __future__ import annotations

import re

import pytest
from rdflib import OWL, RDF, URIRef

from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.turtle import built_in_documents, local_name
from prolepsis.terms.errors import UnknownNameError

HAS_UNIT = URIRef("http://qudt.org/schema/qudt/hasUnit")
PRO = "https://w3id.org/prolepsis#"


@pytest.fixture(scope="module")
def base() -> KnowledgeBase:
    """The built-in ontology."""
    return KnowledgeBase.load()


def test_certainties_in_the_files_are_only_the_five_letters() -> None:
    letters = [str(o) for d in built_in_documents() for o in d.graph.objects(None, URIRef(PRO + "certainty"))]
    assert len(letters) > 70
    assert set(letters) <= set("TRCMD")


def test_every_default_and_default_part_has_a_source_and_a_certainty(base: KnowledgeBase) -> None:
    defaults = [d for entry in base.vocabulary.classes.values() for d in (*entry.defaults, *entry.parts)]
    assert len(defaults) > 70
    for default in defaults:
        assert len(default.source) > 3 and default.certainty in tuple("TRCMD")


def test_what_was_chosen_is_told_to_be_decided(base: KnowledgeBase) -> None:
    defaults = {name: (*entry.defaults, *entry.parts) for name, entry in base.vocabulary.classes.items()}
    chosen = re.compile(r"\b(chosen|decided|assumed|fitted|adjusted)\b")
    said = [(name, each) for name, known in defaults.items() for each in known if chosen.search(each.source)]
    assert len(said) >= 4
    assert [(name, each.source) for name, each in said if each.certainty != "D"] == []


def test_every_number_has_a_qudt_unit_and_bounds() -> None:
    declared = [
        (iri, set(d.graph.objects(iri, HAS_UNIT)), d.graph)
        for d in built_in_documents()
        for iri in d.graph.subjects(RDF.type, OWL.DatatypeProperty)
    ]
    assert len(declared) > 30
    for iri, units, graph in declared:
        kind = next(graph.objects(iri, URIRef("http://www.w3.org/2000/01/rdf-schema#range")))
        if str(kind).endswith("double"):
            assert len(units) == 1 and str(next(iter(units))).startswith("http://qudt.org/vocab/unit/"), iri
            bounds = {local_name(p) for p in graph.predicates(iri) if isinstance(p, URIRef)}
            assert "atMost" in bounds and bounds & {"above", "atLeast"}, iri


def test_the_issue_s_quantities_are_all_there(base: KnowledgeBase) -> None:
    units = {
        "mass": "kg",
        "density": "kg/m3",
        "friction": "1",
        "breakingForce": "N",
        "plateStiffness": "N/m",
        "viscosity": "Pa s",
        "surfaceTension": "N/m",
        "temperature": "K",
        "length": "m",
        "x": "m",
        "pitch": "rad",
    }
    for name, unit in units.items():
        assert base.vocabulary.properties[name].si_unit == unit


def test_every_class_and_property_says_what_it_means(base: KnowledgeBase) -> None:
    for entry in (*base.vocabulary.classes.values(), *base.vocabulary.properties.values()):
        assert len(entry.comment) > 5, entry.name
        assert base.describe(entry.name)[0].endswith(entry.comment)


def test_twelve_force_levels_rise(base: KnowledgeBase) -> None:
    forces = [base.quantity(f"force{i}", "force") for i in range(1, 13)]
    assert forces == sorted(set(forces))
    assert all(base.kind(f"force{i}") == "ForceLevel" for i in range(1, 13))


def test_four_levels_are_too_low_three_hold_and_five_crush_the_default_egg(base: KnowledgeBase) -> None:
    shell, gripper = base.vocabulary.classes["EggShell"], base.vocabulary.classes["Gripper"]
    defaults = {d.property: d.value for entry in (gripper, shell) for d in entry.defaults}
    mass = sum(
        float(d.value)
        for name in ("EggShell", "EggWhite", "EggYolk")
        for d in base.vocabulary.classes[name].defaults
        if d.property == "mass"
    )
    least = mass * 9.81 / (2.0 * float(defaults["friction"]))
    greatest = float(defaults["breakingForce"])
    forces = [base.quantity(f"force{i}", "force") for i in range(1, 13)]
    assert sum(f < least for f in forces) == 4
    assert sum(least < f < greatest for f in forces) == 3
    assert sum(f > greatest for f in forces) == 5
    wet = next(d for d in base.vocabulary.classes["WetGripper"].defaults if d.property == "friction")
    # A wet hand holds the still egg with force5; at 1 m/s^2 it no longer does.
    assert mass * 9.81 / (2.0 * float(wet.value)) < forces[4] < mass * 10.81 / (2.0 * float(wet.value))


def test_an_egg_shell_is_described_with_its_defaults_sources_and_superclasses(base: KnowledgeBase) -> None:
    lines = base.describe("EggShell")
    assert lines[0] == "EggShell: class. The rigid but fragile shell of an egg."
    assert "  is a: Enclosure, PhysicalObject, Shell, Solid" in lines
    assert "  must be part of: Egg" in lines
    assert any(line.startswith("  breakingForce = 45 +- 7 (6 in a batch) N (T, seen in a text: slow") for line in lines)
    assert any(line.startswith("  temperature = 293.15 K (D, decided here: room") for line in lines)


def test_properties_and_individuals_are_described(base: KnowledgeBase) -> None:
    assert "  unit: deg (SI rad)" in base.describe("pitch")
    assert "  values: at least 1e-09 and at most 100000 kg" in base.describe("mass")
    assert any(line.startswith("  force = 15 N (asserted: ") for line in base.describe("force7"))
    assert base.describe("Hand")[0].startswith("Hand: defined class.")


def test_a_name_that_nothing_has_is_refused_with_the_nearest(base: KnowledgeBase) -> None:
    with pytest.raises(UnknownNameError, match="or individual named 'EgShell'; did you mean 'EggShell'"):
        base.describe("EgShell")

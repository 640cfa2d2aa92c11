"""Classes above a class, and units: of the built-in ontology and of one's own."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.saved import read_timeline_files, write_timeline_files
from prolepsis.log.timeline import Timeline, make_timeline
from prolepsis.terms.errors import GoalError

OWN = """@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix qudt: <http://qudt.org/schema/qudt/> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
:GooseEgg a owl:Class ; rdfs:subClassOf :Egg ; rdfs:comment "A large egg." .
:twist a owl:DatatypeProperty , owl:FunctionalProperty ; rdfs:range xsd:double ; qudt:hasUnit unit:DEG ;
  rdfs:comment "How far it is turned in itself." .
:floor a :Floor .
"""


def timeline(tmp_path: Path) -> Timeline:
    """Return a timeline of one's own ontology, saved and read again."""
    (tmp_path / "own.ttl").write_text(OWN)
    made = make_timeline([], dt=0.001, duration=1.0, domain=KnowledgeBase.load(tmp_path / "own.ttl").domain())
    write_timeline_files(made, tmp_path)
    return read_timeline_files(tmp_path)


def test_classes_of_ones_own_stand_below_the_built_in_ones(tmp_path: Path) -> None:
    own = timeline(tmp_path)
    above = [answer["A"] for answer in own.ask("subclass_of('GooseEgg', A)")]
    assert above[0] == "Egg" and {"Shelled", "PhysicalObject"} < {*above} and len({*above}) == len(above)
    assert own.ask("subclass_of('GooseEgg', 'PhysicalObject'), \\+ subclass_of('PhysicalObject', 'GooseEgg')") == [{}]
    assert {"C": "GooseEgg"} in own.ask("subclass_of(C, 'Egg')")
    assert {"C": "GooseEgg", "A": "Shelled"} in own.ask("subclass_of(C, A)")
    with pytest.raises(GoalError, match="no class named 'GoseEgg' .*; did you mean 'GooseEgg'"):
        own.ask("subclass_of('GoseEgg', A)")


def test_units_are_those_of_the_values(tmp_path: Path) -> None:
    own = timeline(tmp_path)
    assert own.ask("unit(twist, U)") == [{"U": "rad"}]
    assert own.ask("unit(breakingForce, U)") == [{"U": "N"}]
    assert own.ask("unit(peak_force, U)") == [{"U": "N"}]
    assert own.ask("unit(colour, U)") == []
    assert {"N": "mass"} in own.ask("unit(N, kg)")
    with pytest.raises(GoalError, match="no property or evidence named twits .*; did you mean twist"):
        own.ask("unit(twits, U)")


def test_a_log_from_elsewhere_has_the_built_in_ones() -> None:
    bare = make_timeline([], dt=0.001, duration=1.0)
    assert bare.ask("subclass_of('EggYolk', 'Stuff'), unit(mass, kg)") == [{}]

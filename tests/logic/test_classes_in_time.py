"""A class is asked at a time: what makes an individual one of a class comes and goes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.domain import Domain
from prolepsis.log.saved import read_timeline_files, write_timeline_files
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.errors import GoalError

SITUATION = """@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
:WetEgg a owl:Class ; rdfs:comment "An egg that is wet." ;
  owl:equivalentClass [ a owl:Class ; owl:intersectionOf ( :Egg :WetThing ) ] .
:Slippery a owl:Class ; rdfs:comment "What slips." .
:WetThing rdfs:subClassOf :Slippery .
:Ruined a owl:Class ; rdfs:comment "What is broken." ;
  owl:equivalentClass [ a owl:Restriction ; owl:onProperty :broken ; owl:hasValue true ] .
:keeps a owl:ObjectProperty ; rdfs:subPropertyOf :carries ; rdfs:comment "Has in it." .
:carries a owl:ObjectProperty ; rdfs:subPropertyOf :keeps ; rdfs:comment "Has in it." .
:contains rdfs:subPropertyOf :keeps .
:Keeper a owl:Class ; rdfs:comment "A cup that has something in it." ;
  owl:equivalentClass [ a owl:Class ; owl:intersectionOf ( :Cup
    [ a owl:Restriction ; owl:onProperty :carries ; owl:someValuesFrom owl:Thing ] ) ] .
:Bare a owl:Class ; rdfs:comment "Nothing is said of it." .
:likes a owl:ObjectProperty ; rdfs:comment "Nothing has it." .
:polished a owl:DatatypeProperty ; rdfs:range xsd:boolean ; rdfs:comment "Nothing has it." .
:Wreck a owl:Class ; owl:equivalentClass :BrokenThing ; rdfs:comment "The same by another name." .
:inside a owl:ObjectProperty ; owl:inverseOf :contains ; rdfs:comment "The other way round." .
:within a owl:ObjectProperty ; owl:equivalentProperty :inside ; rdfs:comment "The same." .
:touches a owl:ObjectProperty , owl:SymmetricProperty ; rdfs:comment "Comes against." .
:reaches rdfs:subPropertyOf :touches .
:reaches a owl:ObjectProperty ; rdfs:comment "Comes against, of a hand." .
:is a owl:DatatypeProperty ; rdfs:range xsd:boolean ; rdfs:comment "A name like any other." .
:true a owl:Class ; rdfs:subClassOf :Egg ; rdfs:comment "A name like any other." .
:Within a owl:Class ; owl:equivalentClass
  [ a owl:Restriction ; owl:onProperty :within ; owl:someValuesFrom :Cup ] .
:Unnamed a owl:Class ; owl:equivalentClass
  [ a owl:Restriction ; owl:onProperty [ owl:inverseOf :contains ] ; owl:someValuesFrom :Cup ] .
:Touched a owl:Class ; owl:equivalentClass
  [ a owl:Restriction ; owl:onProperty :touches ; owl:someValuesFrom owl:Thing ] .
:HoldsWreck a owl:Class ; owl:equivalentClass
  [ a owl:Restriction ; owl:onProperty :contains ; owl:someValuesFrom :Wreck ] .
:Being a owl:Class ; owl:equivalentClass
  [ a owl:Class ; owl:intersectionOf ( :Egg [ a owl:Restriction ; owl:onProperty :is ; owl:hasValue true ] ) ] .
:HoldsTrue a owl:Class ; owl:equivalentClass
  [ a owl:Restriction ; owl:onProperty :contains ; owl:someValuesFrom :true ] .
:table1 a :Table . :egg1 a :Egg ; :on :table1 . :cup1 a :Cup ; :on :table1 ; :x 0.2 .
:liq1 a :Water . :egg2 a :true ; :on :table1 ; :x -0.2 .
:hand1 a :Gripper ; :wet true ; :z 1.0 . :hand2 a :Gripper ; :wet true ; :z 1.5 .
"""


def fluent(type_: str, *args: str, start: float, end: float) -> Fact:
    """Return a fluent without evidence."""
    return Fact(kind="fluent", type=type_, args=args, start=start, end=end)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Timeline:
    """Return a timeline, saved and read again, in which an egg breaks and things become wet and dry."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "situation.ttl").write_text(SITUATION)
    facts = [
        fluent("broken", "egg1", start=0.5, end=2.0),
        fluent("wet", "egg1", start=0.6, end=1.0),
        fluent("wet", "egg1", start=1.5, end=2.0),
        fluent("wet", "hand1", start=0.0, end=0.8),
        fluent("contains", "cup1", "liq1", start=0.2, end=0.9),
        fluent("contains", "cup1", "egg1", start=1.2, end=1.4),
        fluent("contains", "cup1", "egg2", start=1.6, end=1.8),
        fluent("contains", "cup2", "egg1", start=0.3, end=0.7),
        fluent("is", "egg2", start=0.4, end=0.5),
        fluent("reaches", "hand1", "egg2", start=0.7, end=0.8),
    ]
    domain = KnowledgeBase.load(folder / "situation.ttl").domain()
    write_timeline_files(make_timeline(facts, dt=0.001, duration=2.0, domain=domain), folder)
    return read_timeline_files(folder)


def when(run: Timeline, individual: str, kind: str) -> list[str]:
    """Return the intervals over which an individual is of a class."""
    return [str(answer["T"]) for answer in run.ask(f"instance_of({individual}, '{kind}', T)")]


def test_an_egg_is_a_broken_thing_from_when_it_breaks(run: Timeline) -> None:
    assert when(run, "egg1", "BrokenThing") == ["0.5-2.0"]
    assert run.ask("instance_of(egg1, 'BrokenThing', 1)") and not run.ask("instance_of(egg1, 'BrokenThing', 0.499)")
    assert run.ask("instance_of(egg1, 'BrokenThing')"), "whatever it is at any time is no 'no'"
    assert not run.ask("instance_of(cup1, 'BrokenThing')")


def test_what_it_is_for_good_it_is_from_start_to_end(run: Timeline) -> None:
    assert when(run, "egg1", "Egg") == when(run, "egg1", "PhysicalObject") == ["0.0-2.0"]


def test_a_class_that_asks_for_two_holds_while_both_are_so(run: Timeline) -> None:
    assert when(run, "egg1", "WetEgg") == ["0.6-1.0", "1.5-2.0"]
    assert when(run, "hand1", "WetEgg") == []


def test_a_container_of_liquid_is_one_while_a_liquid_is_in_it(run: Timeline) -> None:
    assert when(run, "cup1", "LiquidContainer") == ["0.2-0.9"]
    assert when(run, "cup1", "Container") == ["0.0-2.0"]


def test_what_was_told_ends_where_a_fluent_ends_and_stays_where_none_tells_of_it(run: Timeline) -> None:
    assert when(run, "hand1", "WetGripper") == when(run, "hand1", "WetThing") == ["0.0-0.8"]
    assert when(run, "hand2", "WetGripper") == ["0.0-2.0"]


def test_a_class_of_one_s_own_that_nothing_else_names_is_known(run: Timeline) -> None:
    assert when(run, "egg1", "Ruined") == ["0.5-2.0"] and not run.ask("instance_of(cup1, 'Ruined')")


def test_a_relation_to_anything_is_met_by_what_is_told_below_it(run: Timeline) -> None:
    assert when(run, "cup1", "Keeper") == ["0.2-0.9", "1.2-1.4", "1.6-1.8"]


def test_classes_above_come_and_go_with_it(run: Timeline) -> None:
    assert when(run, "egg1", "Slippery") == ["0.6-1.0", "1.5-2.0"]
    assert when(run, "hand1", "Slippery") == ["0.0-0.8"]


def test_each_pair_comes_once_and_intervals_can_be_related(run: Timeline) -> None:
    answers = [(str(a["C"]), str(a["T"])) for a in run.ask("instance_of(egg1, C, T)")]
    assert len(answers) == len({*answers}) and ("BrokenThing", "0.5-2.0") in answers
    assert run.ask("instance_of(egg1, 'WetThing', T), during(T, B), instance_of(egg1, 'BrokenThing', B)")
    assert run.ask("after(T, B), instance_of(egg1, 'WetThing', T), instance_of(hand1, 'WetThing', B)")


def test_a_typo_in_it_is_no_no(run: Timeline) -> None:
    with pytest.raises(GoalError, match="did you mean 'BrokenThing'"):
        run.ask("instance_of(egg1, 'BrokenTing', T)")
    with pytest.raises(GoalError, match="did you mean egg1"):
        run.ask("instance_of(eggg1, 'BrokenThing', 1.0)")


def test_a_log_from_elsewhere_has_the_built_in_classes() -> None:
    bare = make_timeline([fluent("broken", "jar", start=0.5, end=1.0)], dt=0.001, duration=1.0)
    assert bare.ask("instance_of(jar, 'BrokenThing', T)") == []
    assert not bare.ask("instance_of(jar, 'Container')"), "nothing says that it is a physical object"


def test_a_class_of_which_nothing_is_said_is_no_unknown_name(run: Timeline) -> None:
    assert run.ask("instance_of(X, 'Bare')") == run.ask("instance_of(X, 'Bare', T)") == []
    assert run.ask("subclass_of('Bare', Above)") == []
    assert run.ask("value(egg1, polished, V)") == run.ask("holds(likes(egg1, X), T)") == []
    with pytest.raises(GoalError, match="did you mean 'Bare'"):
        run.ask("instance_of(X, 'Baer')")


@pytest.mark.parametrize("kind", ["Within", "Unnamed"])
def test_what_a_property_says_from_the_other_end_counts(run: Timeline, kind: str) -> None:
    assert when(run, "egg1", kind) == ["1.2-1.4"] and when(run, "liq1", kind) == ["0.2-0.9"]
    assert when(run, "cup1", kind) == []


def test_a_symmetric_property_counts_for_both(run: Timeline) -> None:
    assert when(run, "hand1", "Touched") == when(run, "egg2", "Touched") == ["0.7-0.8"]


def test_a_class_by_another_name_is_the_same(run: Timeline) -> None:
    assert when(run, "egg1", "Wreck") == when(run, "egg1", "BrokenThing")


def test_what_it_is_related_to_may_come_to_be_of_the_class(run: Timeline) -> None:
    assert when(run, "cup2", "HoldsWreck") == ["0.5-0.7"]


def test_properties_and_classes_may_be_called_as_we_call_parts_of_definitions(run: Timeline) -> None:
    assert when(run, "egg2", "Being") == ["0.4-0.5"] and when(run, "egg1", "Being") == []
    assert when(run, "cup1", "HoldsTrue") == ["1.6-1.8"]


def shared_definitions(levels: int) -> list[tuple[str, str, str]]:
    """Return definitions of two classes a level, each by both of the level below: 2^levels ways to the bottom."""
    rows = [("A0", "broken", "is true"), ("B0", "wet", "is true")]
    return rows + [(f"{a}{k}", "is a", f"{b}{k - 1}") for k in range(1, levels) for a in "AB" for b in "AB"]


def chained_definitions(classes: int) -> list[tuple[str, str, str]]:
    """Return definitions of classes, each by the one before."""
    return [("A0", "broken", "is true"), *((f"A{k}", "is a", f"A{k - 1}") for k in range(1, classes))]


@pytest.mark.parametrize(
    ("rows", "top", "expected"),
    [(shared_definitions(18), "A17", "0.6-1.0"), (chained_definitions(300), "A299", "0.5-2.0")],
)
def test_many_definitions_that_share_parts_are_answered(
    rows: list[tuple[str, str, str]], top: str, expected: str
) -> None:
    names = [f"egg{k}" for k in range(10)]
    facts = [fluent("broken", name, start=0.5, end=2.0) for name in names]
    facts += [fluent("wet", name, start=0.6, end=1.0) for name in names]
    domain = Domain(
        instances=tuple((name, "Egg") for name in names),
        definitions=tuple(rows),
        subclasses=tuple((name, above) for name, asked, above in rows if asked == "is a"),
    )
    run = make_timeline(facts, dt=0.001, duration=2.0, domain=domain)
    assert when(run, "egg9", top) == [expected]
    classes = {name for name, *_ in rows}
    found = [(answer["X"], answer["C"]) for answer in run.ask("instance_of(X, C)") if answer["C"] in classes]
    assert len(found) == len({*found}) == len(names) * len(classes)


def test_older_folders_name_parts_of_definitions_otherwise(run: Timeline, tmp_path: Path) -> None:
    write_timeline_files(run, tmp_path)
    table = json.loads((tmp_path / "domain.json").read_text())
    for later in ("inverses", "declared"):
        del table[later]
    table["definitions"] = [["WetThing", "is", "PhysicalObject"], ["WetThing", "wet", "true"]]
    (tmp_path / "domain.json").write_text(json.dumps(table))
    assert when(read_timeline_files(tmp_path), "egg1", "WetThing") == ["0.6-1.0", "1.5-2.0"]


def test_what_a_definition_asks_for_does_not_end_with_it() -> None:
    kinds = ("Container", "LiquidContainer", "PhysicalObject")
    domain = Domain(instances=(("liq1", "Liquid"), *(("jar1", kind) for kind in kinds)))
    facts = [fluent("contains", "jar1", "liq1", start=0.0, end=0.5)]
    run = make_timeline(facts, dt=0.001, duration=2.0, domain=domain)
    assert when(run, "jar1", "LiquidContainer") == ["0.0-0.5"]
    assert when(run, "jar1", "Container") == when(run, "jar1", "PhysicalObject") == ["0.0-2.0"]

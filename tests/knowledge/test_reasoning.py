"""Types are inferred, not listed; answers are kept safely, and do not depend on the order of a hash."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from situations import PREFIX, load

from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import InconsistentError, KnowledgeError

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
EGG = ":egg1 a :Egg ."
TOY = ":Toy a owl:Class ; rdfs:subClassOf [ a owl:Class ; owl:unionOf ( :Block :Ball ) ] . " + EGG
"""A toy is one of two things: only the reasoner shows that there can be one, and only its answers are kept."""
SHOW = """
import hashlib, sys
from dataclasses import asdict
from prolepsis.knowledge import KnowledgeBase
base = KnowledgeBase.load(sys.argv[1])
print(hashlib.sha256(repr((asdict(base.domain()), base.individuals, base.describe("egg1"))).encode()).hexdigest())
"""


def test_two_hash_seeds_give_the_same_domain_without_a_cache(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(PREFIX + ":t a :Table . :egg1 a :Egg ; :on :t ; :mass 0.06 . :h a :Hand ; :wet true .")
    shown: set[str] = set()
    for seed in ("1", "31337"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PROLEPSIS_CACHE": ""}
        command = [sys.executable, "-c", SHOW, str(path)]
        shown.add(subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout)
    assert len(shown) == 1 and len(shown.pop()) == 65


def test_a_kept_answer_is_used_and_an_altered_one_is_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache = tmp_path / "cache"
    monkeypatch.setenv("PROLEPSIS_CACHE", str(cache))
    right = load(tmp_path, TOY).classes("egg1")
    (kept,) = cache.glob("*.json")
    whole = kept.read_text()
    seal, body = whole.split("\n", 1)
    for wrong in (f'{seal}\n"empty class"', seal, "", f"{'0' * 64}\n{body}"):
        kept.write_text(wrong)
        shutil.rmtree(cache / "read")
        assert load(tmp_path, TOY).classes("egg1") == right
        assert kept.read_text() == whole
    monkeypatch.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    shutil.rmtree(cache / "read")
    assert load(tmp_path, TOY).unchecked == ""


def test_a_kept_answer_of_another_question_is_not_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache = tmp_path / "cache"
    monkeypatch.setenv("PROLEPSIS_CACHE", str(cache))
    load(tmp_path, TOY)
    (first,) = cache.glob("*.json")
    other = TOY.replace(":Ball", ":Sponge")
    load(tmp_path, other)
    (second,) = (path for path in cache.glob("*.json") if path != first)
    right = second.read_text()
    second.write_text(first.read_text())
    shutil.rmtree(cache / "read")
    load(tmp_path, other)
    assert second.read_text() == right != first.read_text()


def test_a_cache_that_cannot_be_written_only_costs_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("mine")
    monkeypatch.setenv("PROLEPSIS_CACHE", str(tmp_path / "file" / "cache"))
    assert load(tmp_path, TOY).is_a("egg1", "Fragile")
    assert (tmp_path / "file").read_text() == "mine"


def test_a_class_that_can_have_no_individual_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(InconsistentError) as caught:
        load(tmp_path, EGG + ":LiquidStone a owl:Class ; rdfs:subClassOf :Solid , :Liquid .")
    message = str(caught.value)
    assert "every LiquidStone is a Solid" in message and "every LiquidStone is a Liquid" in message
    assert "there can be a LiquidStone" in message and "situation.ttl:4" in message and "\n" not in message
    assert len(caught.value.conflict) > 3


def test_an_unused_class_that_can_have_individuals_is_taken(tmp_path: Path) -> None:
    assert load(tmp_path, EGG + ":Stone a owl:Class ; rdfs:subClassOf :Solid .").is_a("egg1", "Egg")


def test_a_new_definition_sorts_individuals_by_their_numbers(tmp_path: Path) -> None:
    text = """:Heavy a owl:Class ; owl:equivalentClass [ a owl:Class ; owl:intersectionOf ( :Block
      [ a owl:Restriction ; owl:onProperty :mass ; owl:someValuesFrom [ a rdfs:Datatype ;
        owl:onDatatype xsd:double ; owl:withRestrictions ( [ xsd:minInclusive 2.0 ] ) ] ] ) ] ."""
    prefix = "@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n"
    base = load(tmp_path, f"{prefix}{text} :a a :Block ; :mass 2 . :b a :Block ; :mass '1999 g' . :c a :Egg .")
    assert [base.is_a(name, "Heavy") for name in "abc"] == [True, False, False]
    assert base.with_values({"b.mass": 3.0}).is_a("b", "Heavy")


def test_two_defaults_of_which_neither_is_the_more_special_are_refused(tmp_path: Path) -> None:
    classes = "".join(
        f":{name} a owl:Class ; rdfs:subClassOf :Block ; "
        f":default [ :of :friction ; :value {value} ; :source 's' ; :certainty 'D' ] . "
        for name, value in (("Waxed", 0.1), ("Sanded", 0.9))
    )
    base = load(tmp_path, classes + ":b a :Waxed , :Sanded .")
    with pytest.raises(KnowledgeError, match=r"\.ttl:\d+: b: Sanded and Waxed give different defaults of friction"):
        base.value("b", "friction")
    stated = load(tmp_path, classes + ":b a :Waxed , :Sanded ; :friction 0.4 .")
    assert stated.quantity("b", "friction") == 0.4


@pytest.mark.parametrize("path", EXAMPLES, ids=[path.stem for path in EXAMPLES])
def test_every_example_situation_loads(path: Path) -> None:
    base = Scenario.load(path).knowledge_base()
    assert base.objects
    solids = [name for name in base.objects if not base.is_a(name, "Liquid")]
    assert all(base.quantity(name, "friction") > 0.0 for name in solids)


def test_all_that_follows_of_one_of_two_things_is_found(tmp_path: Path) -> None:
    classes = ":Red a owl:Class . :Soft a owl:Class . :Block rdfs:subClassOf :Red , :Soft . "
    base = load(tmp_path, classes + ":Ball rdfs:subClassOf :Red , :Soft . :toy1 a :Toy . " + TOY)
    assert not base.unchecked
    assert [base.is_a("toy1", name) for name in ("Red", "Soft", "Block", "Ball")] == [True, True, False, False]

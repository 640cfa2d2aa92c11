"""What the reasoner does not decide in time is told to be unchecked, never taken as free of contradiction."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.cli import main
from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.reasoning import contradiction
from prolepsis.projection import Projection
from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import InconsistentError

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def no_cache(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """Environment in which every answer is sought anew."""
    monkeypatch.setenv("PROLEPSIS_CACHE", "")
    return monkeypatch


CASES = """
@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
:Toy a owl:Class ; rdfs:subClassOf [ a owl:Class ; owl:unionOf ( :Block :Ball ) ] .
:floor a :Floor . :table1 a :Table . :toy1 a :Toy , :Block ; :on :table1 .
"""
"""A toy is one of two things: forward chaining does not reason by cases."""
SCENARIO = 'situation = "toy.ttl"\nplan = "wait(0.01)"\nduration = 0.02\n'


@pytest.fixture
def toy(tmp_path: Path) -> Path:
    """A situation that the reasoner must look at."""
    (tmp_path / "toy.ttl").write_text(CASES.replace(":Toy , :Block", ":Toy"))
    return tmp_path / "toy.ttl"


@pytest.mark.parametrize("solid, word", [("10", ""), ("0.0001", "unchecked")])
def test_what_follows_by_cases_is_found_if_there_is_time(
    no_cache: pytest.MonkeyPatch, toy: Path, solid: str, word: str
) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", solid)
    base = KnowledgeBase.load(toy)
    assert base.is_a("toy1", "Toy")
    assert base.is_a("toy1", "Solid") == (not word)
    assert bool(base.unchecked) == bool(word)


def test_an_undecided_check_is_told_with_the_limit_and_how_to_raise_it(no_cache: pytest.MonkeyPatch, toy: Path) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    base = KnowledgeBase.load(toy)
    assert "not decide within 0.0001 s" in base.unchecked and "variable PROLEPSIS_REASONER_SECONDS" in base.unchecked
    assert base.domain().unchecked == base.unchecked


def test_an_unchecked_projection_says_so_on_standard_error_and_wherever_it_is_opened(
    no_cache: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    (tmp_path / "toy.ttl").write_text(CASES)
    (tmp_path / "toy.toml").write_text(SCENARIO)
    assert main(["project", str(tmp_path / "toy.toml"), "--out", str(tmp_path / "out")]) == 0
    for command in (["timeline", str(tmp_path / "out")], ["ask", str(tmp_path / "out"), "instance_of(toy1, 'Toy')"]):
        said = capfd.readouterr().err
        assert said.startswith("prolepsis: note: unchecked: the reasoner") and said.count("\n") == 1
        assert len(said) <= 300
        assert main(command) == 0
    assert Projection.load(tmp_path / "out").timeline.domain.unchecked in said


def test_a_contradiction_that_chaining_shows_is_refused_whatever_the_limit(
    no_cache: pytest.MonkeyPatch, toy: Path
) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    toy.write_text(CASES + ":egg1 a :Egg , :Liquid , :Solid .")
    with pytest.raises(InconsistentError):
        KnowledgeBase.load(toy)


def test_what_forward_chaining_decides_asks_no_reasoner(no_cache: pytest.MonkeyPatch) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    for path in sorted(EXAMPLES.glob("*.toml")):
        assert Scenario.load(path).knowledge_base().unchecked == ""


def test_an_undecided_check_is_not_kept(no_cache: pytest.MonkeyPatch, toy: Path, tmp_path: Path) -> None:
    no_cache.setenv("PROLEPSIS_CACHE", str(tmp_path / "kept"))
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    KnowledgeBase.load(toy)
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize("text", ["soon", "0", "-3", "nan", "inf"])
def test_a_limit_that_is_no_time_is_refused(
    no_cache: pytest.MonkeyPatch, text: str, capfd: pytest.CaptureFixture[str]
) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", text)
    assert main(["project", str(EXAMPLES / "dropped_egg.toml")]) == 2
    assert capfd.readouterr().err == (
        f"prolepsis: PROLEPSIS_REASONER_SECONDS must be a number of seconds greater than 0, not '{text}'\n"
    )


def test_an_explanation_that_is_not_found_in_time_says_so(no_cache: pytest.MonkeyPatch) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    axioms = tuple(Axiom(f"SubClassOf(<c:{i}> <c:{i + 1}>)", f"every {i} is {i + 1}", "file") for i in range(3))
    assert "not found in time" in str(contradiction(axioms))

"""What the reasoner does not decide in time is refused, never taken as free of contradiction."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.cli import main
from prolepsis.errors import UndecidedError
from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.reasoning import explain

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def no_cache(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """Environment in which every answer is sought anew."""
    monkeypatch.setenv("PROLEPSIS_CACHE", "")
    return monkeypatch


def test_an_undecided_check_is_refused_with_the_limit_and_how_to_raise_it(no_cache: pytest.MonkeyPatch) -> None:
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    with pytest.raises(UndecidedError, match=r"not decide within 0\.0001 s .*variable PROLEPSIS_REASONER_SECONDS"):
        KnowledgeBase.load(EXAMPLES / "dropped_egg.ttl")


def test_an_undecided_check_is_not_kept(no_cache: pytest.MonkeyPatch, tmp_path: Path) -> None:
    no_cache.setenv("PROLEPSIS_CACHE", str(tmp_path))
    no_cache.setenv("PROLEPSIS_REASONER_SECONDS", "0.0001")
    with pytest.raises(UndecidedError):
        KnowledgeBase.load(EXAMPLES / "dropped_egg.ttl")
    assert list(tmp_path.iterdir()) == []


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
    assert "not found in time" in explain(axioms)

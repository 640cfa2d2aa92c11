"""What a run has drawn is saved with it, is what queries answer, and gives the same run when it is given as values."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from prolepsis.cli import main
from prolepsis.projection import Projection, project
from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import ScenarioError

EXAMPLES = Path(__file__).parent.parent / "examples"
SHORT = 'situation = "dropped_egg.ttl"\nplan = "wait(0.3)"\nduration = 0.3\nseed = 3\n'
FORCE = "eggshell1.breakingForce"


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    """A short scenario in which an egg falls on the floor and breaks."""
    shutil.copy(EXAMPLES / "dropped_egg.ttl", tmp_path)
    path = tmp_path / "short.toml"
    path.write_text(SHORT)
    return path


def test_a_run_answers_with_what_it_has_drawn_and_keeps_it(scenario: Path, tmp_path: Path) -> None:
    made = project(scenario, out=tmp_path / "run", settings={"draw": True})
    force = made.drawn[FORCE]
    assert force != 45.0
    assert made.ask("value(eggshell1, breakingForce, F)") == [{"F": force}]
    assert made.scene.thing("eggshell1").quantities["breakingForce"] == force
    assert made.scenario.knowledge_base().value("eggshell1", "breakingForce").origin == "drawn"
    loaded = Projection.load(tmp_path / "run")
    assert loaded.drawn == made.drawn and loaded.scenario.draw is True
    assert loaded.ask("value(eggshell1, breakingForce, F)") == [{"F": force}]


def test_what_was_drawn_replays_the_run_when_it_is_given(scenario: Path, tmp_path: Path) -> None:
    project(scenario, out=tmp_path / "run", settings={"draw": "true"})
    first = Projection.load(tmp_path / "run")
    again = project(scenario, settings={**first.drawn, "seed": 8})
    usual = project(scenario)
    assert again.drawn == {} and again.timeline.facts == first.timeline.facts
    assert again.timeline.domain == first.timeline.domain
    assert np.array_equal(again.log.poses, first.log.poses)
    assert {k: v.tobytes() for k, v in again.log.channels.items()} == {
        k: v.tobytes() for k, v in first.log.channels.items()
    }
    assert not np.array_equal(usual.log.poses, first.log.poses)


def test_draw_is_set_on_the_command_line(scenario: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    run = str(tmp_path / "run")
    assert main(["project", str(scenario), "--set", "draw=true", "--set", "seed=5", "--out", run]) == 0
    loaded = Projection.load(run)
    assert (
        loaded.scenario.draw is True
        and loaded.drawn == Scenario.load(scenario, {"draw": True, "seed": 5}).knowledge_base().drawn
    )
    assert main(["project", str(scenario), "--set", "draw=yes"]) == 2
    assert "draw = yes: must be true or false" in capfd.readouterr().err


@pytest.mark.parametrize("value", [True, "true", "True", " TRUE "])
def test_draw_is_a_setting_as_any_other(scenario: Path, value: str | bool) -> None:
    drawing = Scenario.load(scenario, {"draw": value})
    assert drawing.draw is True and drawing.with_settings({"draw": "false"}).draw is False


@pytest.mark.parametrize("value", ["yes", 1, 0.0, "", "1"])
def test_a_draw_that_is_neither_true_nor_false_is_refused(scenario: Path, value: str | float) -> None:
    with pytest.raises(ScenarioError, match=r"short.toml: draw = .*: must be true or false"):
        Scenario.load(scenario, {"draw": value})


def test_another_seed_draws_other_eggs_and_the_same_one_the_same(scenario: Path) -> None:
    def drawn(seed: int) -> dict[str, float | str]:
        return Scenario.load(scenario, {"draw": True, "seed": seed}).knowledge_base().drawn

    assert drawn(1) == drawn(1) and drawn(1)[FORCE] != drawn(2)[FORCE]

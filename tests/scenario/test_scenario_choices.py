"""What a scenario chooses - whether to draw, what is logged - reaches the simulation and comes back from a folder."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from prolepsis.cli import main
from prolepsis.projection import Projection, project
from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import UnknownNameError

EXAMPLES = Path(__file__).parents[2] / "examples"
SHORT = 'situation = "dropped_egg.ttl"\nplan = "wait(0.02)"\nduration = 0.03\nseed = 3\n'


def scenario(folder: Path, more: str = "") -> Path:
    """Return a short scenario file."""
    shutil.copy(EXAMPLES / "dropped_egg.ttl", folder)
    path = folder / "short.toml"
    path.write_text(SHORT + more)
    return path


def test_chosen_monitors_are_logged_and_saved(tmp_path: Path) -> None:
    path = scenario(tmp_path, 'draw = true\n[monitors]\negg1 = ["speed"]\n')
    made = project(path, out=tmp_path / "run")
    assert "egg1.speed" in made.log.channels and "egg1.load" not in made.log.channels
    loaded = Projection.load(tmp_path / "run").scenario
    assert loaded.draw is True
    assert loaded.monitors == {"egg1": ("speed",)} == Scenario.load(path).monitors


def test_without_a_choice_the_usual_is_logged(tmp_path: Path) -> None:
    made = project(scenario(tmp_path), out=tmp_path / "run")
    assert "egg1.load" in made.log.channels and "egg1.speed" not in made.log.channels
    assert Projection.load(tmp_path / "run").scenario.draw is False


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ('[monitors]\negg9 = ["load"]\n', "[monitors]: no object named 'egg9'"),
        ('[monitors]\negg1 = ["weight"]\n', "[monitors] egg1: no monitor named 'weight'"),
    ],
)
def test_a_monitor_or_thing_that_is_not_there_is_refused(
    more: str, message: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = scenario(tmp_path, more)
    with pytest.raises(UnknownNameError):
        project(path)
    assert main(["project", str(path), "--out", str(tmp_path / "run")]) == 2
    assert message in capfd.readouterr().err
    assert not (tmp_path / "run").exists()


def test_a_named_robot_joins_the_situation_and_comes_back(tmp_path: Path) -> None:
    (tmp_path / "s.ttl").write_text(
        "@prefix : <https://w3id.org/prolepsis#> .\n:floor a :Floor .\n"
        ":pr2 a :PR2 ; :x -0.5 ; :hasPart :rightGripper .\n:rightGripper a :Gripper ; :wet true .\n"
    )
    path = tmp_path / "short.toml"
    path.write_text('situation = "s.ttl"\nplan = "wait(0.02)"\nduration = 0.03\nrobot = "pr2"\n')
    made = project(path, out=tmp_path / "run")
    assert made.scene.thing("pr2").position == (-0.5, 0.0, 0.0)
    assert {"rightGripper", "leftGripper"} < {thing.name for thing in made.scene.things}
    assert made.ask("instance_of(rightGripper, 'WetGripper')")
    loaded = Projection.load(tmp_path / "run").scenario
    assert loaded.robot == "pr2"
    assert "leftGripper" in loaded.knowledge_base().parts("pr2")

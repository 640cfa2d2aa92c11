"""The examples of docs/how-to.md work as they stand."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.scenes import EGG_IN_HAND, run

from prolepsis.engine.channels import MONITORS
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.fluents import recognize
from prolepsis.knowledge import KnowledgeBase
from prolepsis.matter.kinds import PHENOMENA
from prolepsis.programs import ACTIONS, read_program
from prolepsis.projection import project
from prolepsis.scene.compose import compose
from prolepsis.terms.terms import parse_term

PAGE = (Path(__file__).parents[1] / "docs" / "how-to.md").read_text(encoding="utf-8")


def example(section: str, language: str) -> str:
    found = re.search(rf"^## {section}$.*?```{language}\n(.*?)```", PAGE, re.DOTALL | re.MULTILINE)
    assert found is not None
    return found[1]


@pytest.fixture(autouse=True)
def registries_as_they_were() -> Iterator[None]:
    actions, monitors = dict(ACTIONS), dict(MONITORS)
    yield
    ACTIONS.clear()
    ACTIONS.update(actions)
    MONITORS.clear()
    MONITORS.update(monitors)


def defined(section: str) -> dict[str, Any]:
    names: dict[str, Any] = {"__name__": "example"}
    exec(example(section, "python"), names)
    return names


def test_an_object_is_a_few_lines_of_turtle(tmp_path: Path) -> None:
    file = tmp_path / "plate.ttl"
    file.write_text(example("An object", "turtle"), encoding="utf-8")
    scene = compose(KnowledgeBase.load(file))
    log = simulate(compile_world(scene), read_program(parse_term("wait(0.3)"), scene))
    timeline = recognize(log, domain=scene.domain)
    assert timeline.ask("holds(supports(plate1,block1), T), holds(supports(floor,plate1), T)")


def test_a_robot_is_a_model_and_a_table(tmp_path: Path) -> None:
    shutil.copy(Path(__file__).parents[1] / "examples" / "own_arm.xml", tmp_path / "my_arm.xml")
    (tmp_path / "kitchen.ttl").write_text("@prefix : <https://w3id.org/prolepsis#> . :floor a :Floor .")
    (tmp_path / "scenario.toml").write_text(example("A robot", "toml"), encoding="utf-8")
    log = project(tmp_path / "scenario.toml").log
    palm = log.poses[:, log.index("robot1/palm"), 2]
    assert palm[-1] - palm[0] == pytest.approx(0.05, abs=2e-3)


def test_an_action_is_one_generator() -> None:
    defined("An action")
    log = run(EGG_IN_HAND, "shake(hand1, 2)")
    heights = log.poses[:, log.index("hand1/palm"), 2]
    assert heights.max() - heights[0] == pytest.approx(0.02, abs=2e-3)
    assert [str(action.term) for action in log.actions] == ["shake(hand1,2)"]


def test_a_phenomenon_is_one_controller() -> None:
    attach = defined("A phenomenon")["attach"]
    log = run(
        ":floor a :Floor . :block1 a :Block ; :on :floor ; :temperature 60.0 .",
        duration=0.5,
        phenomena=(*PHENOMENA, attach),
        monitors={"block1": ["temperature"]},
    )
    warmth = log.channels["block1.temperature"] - 293.15
    assert warmth[-1] / warmth[0] == pytest.approx(0.995, abs=2e-4)  # exp(-0.01 * 0.5)


def test_a_monitor_is_one_function() -> None:
    defined("A monitor")
    log = run(":floor a :Floor . :block1 a :Block ; :on :floor .", duration=0.02, monitors={"block1": ["distance"]})
    assert log.channels["block1.distance"][0] == pytest.approx(0.05, abs=1e-4)

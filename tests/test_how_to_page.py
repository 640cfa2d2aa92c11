"""The examples of docs/how-to.md work as they stand."""

from __future__ import annotations

import ast
import math
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.scenes import EGG_IN_HAND, run, scene

import prolepsis
from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.fluents import fact_types, recognize
from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.fact_types import ACTION_EVENTS
from prolepsis.programs import ACTIONS, read_program
from prolepsis.projection import project
from prolepsis.terms.reader import parse_term

PAGE = (Path(__file__).parents[1] / "docs" / "how-to.md").read_text(encoding="utf-8")


def example(section: str, language: str) -> str:
    found = re.search(rf"^## {section}$.*?```{language}\n(.*?)```", PAGE, re.DOTALL | re.MULTILINE)
    assert found is not None
    return found[1]


@pytest.fixture(autouse=True)
def registries_as_they_were() -> Iterator[None]:
    registries: list[dict[str, Any]] = [ACTIONS, ACTION_EVENTS]
    before = [dict(each) for each in registries]
    yield
    for registry, known in zip(registries, before, strict=True):
        registry.clear()
        registry.update(known)


def defined(section: str) -> dict[str, Any]:
    names: dict[str, Any] = {"__name__": "example"}
    exec(example(section, "python"), names)
    return names


def test_an_object_is_a_few_lines_of_turtle(tmp_path: Path) -> None:
    file = tmp_path / "plate.ttl"
    file.write_text(example("An object", "turtle"), encoding="utf-8")
    scene = compose_scene(KnowledgeBase.load(file))
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


def test_an_effector_is_told_by_its_keys(tmp_path: Path) -> None:
    shutil.copy(Path(__file__).parents[1] / "examples" / "own_jaw.xml", tmp_path / "my_jaw.xml")
    block = ":block1 a :Block ; :on :floor ; :x 0.27 ; :length 0.03 ; :width 0.03 ; :height 0.03 ."
    (tmp_path / "kitchen.ttl").write_text(f"@prefix : <https://w3id.org/prolepsis#> . :floor a :Floor . {block}")
    (tmp_path / "scenario.toml").write_text(example("An effector", "toml"), encoding="utf-8")
    made = project(tmp_path / "scenario.toml")
    assert [action.outcome for action in made.log.actions] == ["done"] * 3
    assert made.ask("holds(attached(gripper1, block1), T)")


def test_an_action_is_one_generator() -> None:
    defined("An action")
    assert fact_types()["shaking"].arguments == ("hand", "times")
    log = run(EGG_IN_HAND, "shake(hand1, 2)")
    heights = log.poses[:, log.index("hand1/palm"), 2]
    assert heights.max() - heights[0] == pytest.approx(0.02, abs=2e-3)
    (action,) = log.actions
    assert (str(action.term), action.arguments) == ("shake(hand1,2)", {"hand": "hand1", "times": 2})


COOLED = """
from prolepsis import project
projection = project("scenario.toml")
log = projection.log
print(log.channels["block1.temperature"][-1] - 293.15)
print({type: each.tick.tolist() for type, each in log.happenings.items()})
print(projection.ask("holds(hot(block1), S-E), occurs(coolingDown(block1), _), value(block1, coolingTime, V)"))
"""


def test_a_kind_of_matter_is_three_files_and_no_line_elsewhere(tmp_path: Path) -> None:
    house = tmp_path / "src" / "prolepsis"
    shutil.copytree(Path(prolepsis.__file__).parent, house, ignore=shutil.ignore_patterns("__pycache__"))
    files = re.findall(r"`src/prolepsis/([^`]+/cooling[^`]*)`:\n\n```\w+\n(.*?)```", PAGE, re.DOTALL)
    assert len(files) == 3
    for name, text in files:
        assert not (house / name).exists()
        (house / name).write_text(text, encoding="utf-8")
    turtle = ":floor a :Floor . :block1 a :Block ; :on :floor ; :temperature 55.0 ; :coolingTime 2.0 ."
    (tmp_path / "kitchen.ttl").write_text(f"@prefix : <https://w3id.org/prolepsis#> . {turtle}")
    (tmp_path / "scenario.toml").write_text('situation = "kitchen.ttl"\nplan = "wait(4.0)"\n')
    command = [sys.executable, "-c", COOLED]
    done = subprocess.run(
        command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(house.parent)}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    warmth, happened, answers = done.stdout.splitlines()
    assert float(warmth) == pytest.approx(35.0 * math.exp(-4.5 / 2), rel=1e-3)
    (tick,) = ast.literal_eval(happened)["chill"]
    assert tick == pytest.approx(2000 * math.log(35 / 5), abs=2)  # Newton's law, and a tick to be told
    (answer,) = ast.literal_eval(answers)
    assert answer["V"] == 2.0
    assert answer["E"] == pytest.approx(2 * math.log(35 / 30), abs=0.002)


def test_a_kind_pushes() -> None:
    kind = defined("A kind that pushes")["Draught"]()
    known = scene(":floor a :Floor . :block1 a :Block ; :length 0.1 ; :mass 0.01 ; :z 1.0 .")
    world = compile_world(replace(known, kinds=(*known.kinds, kind)))
    log = simulate(world, read_program(parse_term("wait(0.3)"), known), duration=0.3)
    way = log.poses[-1, log.index("block1"), :3] - log.poses[0, log.index("block1"), :3]
    speed, moved = np.zeros(3), np.zeros(3)
    for _ in range(299):
        past = np.array([4.0, 0, 0]) - speed
        speed = speed + (np.array([0, 0, -9.81]) + 0.66 * 0.1**2 / 0.01 * np.linalg.norm(past) * past) * 1e-3
        moved = moved + speed * 1e-3
    assert way == pytest.approx(moved, abs=2e-3)
    assert way[0] > 0.2


def test_a_channel_is_a_line_of_a_kind() -> None:
    measuring = defined("A channel")["Measuring"]()
    known = scene(":floor a :Floor . :block1 a :Block ; :on :floor .")
    world = compile_world(replace(known, kinds=(*known.kinds, measuring)))
    program = read_program(parse_term("wait(0.02)"), known)
    log = simulate(world, program, duration=0.02, monitors={"block1": ["distance"]})
    assert log.channels["block1.distance"][0] == pytest.approx(0.05, abs=1e-4)

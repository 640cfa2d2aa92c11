"""Bad scenario files are refused with what is wrong, where, and what is allowed."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.projection import project
from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import InputError, UnknownNameError
from prolepsis.terms.terms import Term

GOOD = 'situation = "s.ttl"\nplan = "close(hand1, Force)"\n[parameters]\nForce = { value = 20, unit = "N" }\n'


def write(folder: Path, text: str) -> Path:
    """Return a scenario file beside a situation."""
    (folder / "s.ttl").write_text("@prefix : <https://w3id.org/prolepsis#> . :hand1 a :Gripper .")
    path = folder / "scenario.toml"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("plan =", "plan : ", r"scenario\.toml:2: TOML syntax"),
        (GOOD, "# An egg.\n@prefix : <https://w3id.org/prolepsis#> .\n", r"scenario\.toml:2: .*; this is a situation"),
        ("close(", "Close(", r"only variables begin with a capital letter: write close\(\.\.\.\)"),
        ("close(", "CLOSE(", r"only variables begin with a capital letter: write close"),
        ("hand1, Force)", "hand1, 10 N)", r"numbers are in SI units, without a unit"),
        (
            "[parameters]",
            'duration = "1 s"\n[parameters]',
            r"duration = '1 s': give a number of seconds, without a unit",
        ),
        ("[parameters]", "particles = true\n[parameters]", r"particles = true: must be a whole number"),
        ("plan =", "plam =", r"unknown key 'plam'; known: situation, plan|the key 'plan' is missing"),
        ("s.ttl", "t.ttl", r"there is no file .*t\.ttl"),
        ('"N"', '"stone"', r"parameter Force: no unit 'stone'"),
        ("Force =", "Level =", r"the plan's variable Force has no value"),
        ("hand1, Force", "hand1, 3", r"the plan has no variable Force"),
        ("[parameters]", "duration = 0\n[parameters]", r"duration must be a finite number of seconds greater than 0"),
        ("[parameters]", "monitors = 3\n[parameters]", "monitors = 3: give a table"),
        ("[parameters]", "robot = { file = 'a.xml', grippers = 3 }\n[parameters]", "robot.grippers: give a table"),
        ("[parameters]", "robot = { file = 'a.xml', grippers = { g = 3 } }\n[parameters]", "grippers.g: give a table"),
        ("[parameters]", "seed = 1.5\n[parameters]", r"seed = 1\.5"),
        ("[parameters]", 'draw = "yes"\n[parameters]', r"draw = 'yes': must be true or false"),
        ("[parameters]", "draw = 1\n[parameters]", r"draw = 1: must be true or false"),
        ("[parameters]", 'monitors = ["load"]\n[parameters]', r"monitors = \['load'\]"),
        (
            "[parameters]",
            '[monitors]\negg1 = "load"\n[parameters]',
            r'monitors: egg1: give a list of names, such as \["load"',
        ),
        ("[parameters]", "[monitors]\negg1 = [1]\n[parameters]", r"monitors: egg1: give a list of names"),
        ("20", "nan", r"parameter Force must be finite"),
        ("hand1, Force)", "hand1, Force", r"plan"),
    ],
)
def test_a_bad_scenario_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Scenario.load(write(tmp_path, GOOD.replace(old, new)))


def test_settings_match_without_regard_to_case_and_in_the_units_of_the_file(tmp_path: Path) -> None:
    path = write(tmp_path, GOOD)
    assert Scenario.load(path, {"force": "25"}).bound_plan() == Term("close", ("hand1", 25.0))
    assert Scenario.load(path, {"Force": "0.1 kN"}).bound_plan() == Term("close", ("hand1", 100.0))
    assert Scenario.load(path, {"Force": "force7"}).bound_plan() == Term("close", ("hand1", "force7"))
    assert Scenario.load(path, {"hand1.friction": "0.3"}).knowledge == {"hand1.friction": "0.3"}


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"Fource": "25"}, r"no parameter named 'Fource'; did you mean 'Force'"),
        ({"Force": "25 kg"}, r"unit 'kg' does not fit: a unit such as 'N'"),
    ],
)
def test_a_bad_setting_is_refused(tmp_path: Path, settings: dict[str, str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Scenario.load(write(tmp_path, GOOD), settings)


def test_draw_and_monitors_are_read_and_outlive_settings(tmp_path: Path) -> None:
    text = GOOD.replace(
        "[parameters]", 'draw = true\n[monitors]\nhand1 = ["speed", "height"]\nfloor = []\n[parameters]'
    )
    for scenario in (Scenario.load(write(tmp_path, text)), Scenario.load(write(tmp_path, text), {"force": "3"})):
        assert scenario.draw is True
        assert scenario.monitors == {"hand1": ("speed", "height"), "floor": ()}
    plain = Scenario.load(write(tmp_path, GOOD))
    assert (plain.draw, plain.monitors) == (False, {})


def test_an_unknown_robot_is_refused(tmp_path: Path) -> None:
    (tmp_path / "empty.ttl").write_text(
        "@prefix : <https://w3id.org/prolepsis#> .\n:floor a :Floor .\n", encoding="utf-8"
    )
    file = tmp_path / "robot.toml"
    file.write_text('situation = "empty.ttl"\nplan = "wait(0.1)"\nrobot = "pr3"\n', encoding="utf-8")
    with pytest.raises(UnknownNameError, match="no robot named 'pr3'.*known: hand"):
        project(file)

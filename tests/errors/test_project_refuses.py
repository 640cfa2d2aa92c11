"""``prolepsis project`` refuses bad knowledge and bad scenarios: exit status 2, one line, nothing written."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.cli import main
from prolepsis.engine import simulation
from prolepsis.log import tables as log_tables
from prolepsis.projection import project
from prolepsis.terms.errors import InputError, UnknownNameError, error_line

SITUATION = """\
@prefix : <https://w3id.org/prolepsis#> .
:floor a :Floor .
:table1 a :Table .
:egg1 a :Egg ; :on :table1 ; :mass 0.06 ; :friction 0.6 .
:hand1 a :Gripper ; :z 1.0 .
"""
SCENARIO = """\
situation = "s.ttl"
plan = "close(hand1, Force)"
seed = 1
[parameters]
Force = { value = 5, unit = "N" }
[knowledge]
"egg1.temperature" = 20
"""
EGG = ":egg1 a :Egg ;"
MASS, FRICTION = ":mass 0.06", ":friction 0.6"

IN_SITUATION: list[tuple[str, str, str]] = [
    (":on :table1", ":on :tabel1", "s.ttl:4: no individual named 'tabel1'; did you mean 'table1'?; known: egg1, floor"),
    (EGG, ":egg1 a :Eg ;", "s.ttl:4: no class named 'Eg'; did you mean 'Egg'?"),
    (FRICTION, ":fricton 0.6", "s.ttl:4: no property named 'fricton'; did you mean 'friction'?"),
    (MASS, ':mass "58 N"', "s.ttl:4: egg1: mass = '58 N': unit 'N' does not fit: a unit such as 'kg' is needed"),
    (MASS, ':mass "58 stone"', "s.ttl:4: egg1: mass = '58 stone': no unit 'stone'; known:"),
    (MASS, ":mass -0.06", "s.ttl:4: egg1: mass = -0.06: must be finite and at least 1e-09"),
    (MASS, ":mass 0", "s.ttl:4: egg1: mass = 0: must be finite and at least 1e-09"),
    (MASS, ':mass "NaN"', "s.ttl:4: egg1: mass = NaN: must be finite and at least 1e-09"),
    (MASS, ":mass 1e9", "at most 100000 kg"),
    (FRICTION, ":friction -0.6", "s.ttl:4: egg1: friction = -0.6: must be finite and at least 1e-05"),
    (FRICTION, ":friction 0.0", "s.ttl:4: egg1: friction = 0.0: must be finite and at least 1e-05"),
    (FRICTION, ':friction "nan"', "s.ttl:4: egg1: friction = nan: must be finite and at least 1e-05"),
    (FRICTION, ":friction true", "s.ttl:4: egg1: friction must be a number, with or without a unit, not 'true'"),
    (":floor a", ":y1 a :EggYolk .\n:floor a", "s.ttl:2: y1 is part of nothing: EggYolk must be a part of a Egg"),
    (EGG, ":egg1 a :Egg , :ForceLevel ;", "egg1 is a ForceLevel (s.ttl:4); no ForceLevel is a PhysicalObject"),
    (":table1 a :Table .", ":table1 a :Table", "s.ttl:4: Turtle syntax: "),
    (":floor a :Floor .", ":floor a flor:Floor .", "s.ttl:2: Turtle syntax: "),
]
IN_SCENARIO: list[tuple[str, str, str]] = [
    ('Force = { value = 5, unit = "N" }', 'Force = "force77"', "parameter Force: no individual named 'force77'"),
    ('unit = "N"', 'unit = "stone"', "scenario.toml: parameter Force: no unit 'stone'"),
    ("value = 5", "value = nan", "scenario.toml: parameter Force must be finite, not nan"),
    ("Force = {", "Power = {", "scenario.toml: the plan's variable Force has no value"),
    ("egg1.temperature", "egg9.temperature", "egg9.temperature: no individual named 'egg9'; did you mean 'egg1'?"),
    ("egg1.temperature", "egg1.temprature", "no property named 'temprature'; did you mean 'temperature'?"),
    ('"egg1.temperature" = 20', '"egg1.mass" = "5 s"', "egg1.mass: mass = '5 s': unit 's' does not fit"),
    ('"egg1.temperature" = 20', '"egg1.mass" = nan', "egg1.mass: mass = nan: must be finite and at least 1e-09"),
    ('"egg1.temperature" = 20', '"egg1.friction" = 0', "egg1.friction: friction = 0.0: must be finite"),
    ("seed = 1", "seed = -1", "scenario.toml: seed = -1: "),
    ("seed = 1", "sed = 1", "scenario.toml: unknown key 'sed'; did you mean 'seed'?; known: situation, plan"),
    ("seed = 1", "seed = = 1", "scenario.toml:3: TOML syntax: "),
    ("s.ttl", "t.ttl", "scenario.toml: situation: there is no file "),
]
SETTINGS: list[tuple[str, str]] = [
    ("Fource=5", "no parameter named 'Fource'; did you mean 'Force'?"),
    ("Force=5 kg", "Force = 5 kg: unit 'kg' does not fit: a unit such as 'N' is needed"),
    ("Force=nan", "parameter Force must be finite, not nan"),
    ("Force=force99", "parameter Force: no individual named 'force99'"),
    ("egg1.mass=0", "egg1.mass: mass = 0: must be finite and at least 1e-09"),
    ("egg1.friction=-1", "egg1.friction: friction = -1: must be finite and at least 1e-05"),
    ("egg1.weight=1", "egg1.weight: no property named 'weight'"),
    ("egg1.supports=table1", "egg1.supports: supports cannot be overridden; write it in the situation"),
]


def refused(folder: Path, capfd: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return the one line that the command prints when it refuses."""
    before = sorted(folder.rglob("*"))
    out = folder / "run"
    assert main(["project", str(folder / "scenario.toml"), "--out", str(out), *arguments]) == 2
    printed = capfd.readouterr()
    assert printed.out == ""
    assert sorted(folder.rglob("*")) == before
    (line,) = printed.err.splitlines()
    return line.replace(f"{folder}/", "")


def write(folder: Path, situation: str = SITUATION, scenario: str = SCENARIO) -> None:
    """Write both files."""
    (folder / "s.ttl").write_text(situation)
    (folder / "scenario.toml").write_text(scenario)


@pytest.mark.parametrize(("old", "new", "message"), IN_SITUATION, ids=[new for _, new, _ in IN_SITUATION])
def test_a_bad_situation(tmp_path: Path, capfd: pytest.CaptureFixture[str], old: str, new: str, message: str) -> None:
    assert SITUATION.count(old) == 1
    write(tmp_path, situation=SITUATION.replace(old, new))
    assert message in refused(tmp_path, capfd)


@pytest.mark.parametrize(("old", "new", "message"), IN_SCENARIO, ids=[new for _, new, _ in IN_SCENARIO])
def test_a_bad_scenario(tmp_path: Path, capfd: pytest.CaptureFixture[str], old: str, new: str, message: str) -> None:
    assert SCENARIO.count(old) == 1
    write(tmp_path, scenario=SCENARIO.replace(old, new))
    assert message in refused(tmp_path, capfd)


@pytest.mark.parametrize(("setting", "message"), SETTINGS, ids=[setting for setting, _ in SETTINGS])
def test_a_bad_setting(tmp_path: Path, capfd: pytest.CaptureFixture[str], setting: str, message: str) -> None:
    write(tmp_path)
    assert message in refused(tmp_path, capfd, "--set", setting)


def test_an_unreadable_file(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write(tmp_path)
    (tmp_path / "s.ttl").write_bytes(b"\xff\xfe")
    assert "s.ttl: the Turtle file is not UTF-8 text" in refused(tmp_path, capfd)
    (tmp_path / "scenario.toml").write_bytes(b"\xff\xfe")
    assert "scenario.toml: the scenario is not UTF-8 text" in refused(tmp_path, capfd)


def test_a_run_whose_log_could_not_be_saved_is_not_computed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path, scenario=SCENARIO.replace("seed = 1", "duration = 20.0"))
    monkeypatch.setattr(log_tables, "MOST_BYTES", 2_000_000)
    monkeypatch.setattr(simulation, "simulate", None)
    with pytest.raises(InputError, match=r"the log could not be saved: 20,000 ticks of \d+ things .* shorten the run"):
        project(tmp_path / "scenario.toml", out=tmp_path / "run")
    with pytest.raises(TypeError):  # It would have been computed, to be asked and forgotten.
        project(tmp_path / "scenario.toml")


@pytest.mark.parametrize("length", range(60, 140))
def test_what_is_near_is_told_however_long_the_place_is(length: int) -> None:
    error = UnknownNameError.of("individual", "egg9", ["egg1", *(f"force{k}" for k in range(30))], "x" * length)
    assert "; did you mean 'egg1'?; known: " in error_line(f"prolepsis: {error}")

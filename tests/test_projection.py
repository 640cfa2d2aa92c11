"""A projection comes back from its folder as it was, and equal scenarios give equal bytes."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import prolepsis
from prolepsis.log.files import read_log, write_log
from prolepsis.log.saved import read_timeline
from prolepsis.projection import Projection, project
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError, LogError, UnknownNameError
from prolepsis.terms.terms import format_value

EXAMPLES = Path(__file__).parent.parent / "examples"
SHORT = """\
situation = "dropped_egg.ttl"
plan = "wait(Time)"
duration = 0.12
seed = 7
[parameters]
Time = { value = 50, unit = "ms" }
[knowledge]
"egg1.friction" = 0.4
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("projection")
    shutil.copy(EXAMPLES / "dropped_egg.ttl", folder)
    (folder / "short.toml").write_text(SHORT)
    return folder


@pytest.fixture(scope="module")
def made(place: Path) -> Projection:
    return project(place / "short.toml", out=place / "run", time=0.06)


def test_a_projection_comes_back_without_simulating(made: Projection, place: Path) -> None:
    loaded = Projection.load(place / "run")
    assert loaded.timeline == made.timeline
    # Where the particles were at the start is in the log.
    assert loaded.scene == replace(made.scene, pools=())
    assert loaded.world == made.world
    assert loaded.log.things == made.log.things
    assert loaded.scenario.plan == made.scenario.plan
    assert loaded.scenario.parameters == made.scenario.parameters
    assert dict(loaded.scenario.knowledge) == {"egg1.friction": 0.4}
    assert loaded.scenario.seed == 7
    goal = "holds(supports(hand1, egg1), T)"
    assert loaded.ask(goal) == made.ask(goal) != []


def test_a_loaded_scenario_can_be_projected_again_to_the_same_bytes(place: Path, made: Projection) -> None:
    again = project(Projection.load(place / "run").scenario, out=place / "again")
    assert again.timeline == made.timeline
    for name in ("poses.parquet", "contacts.parquet", "timeline.json", "log.json"):
        assert (place / "again" / name).read_bytes() == (place / "run" / name).read_bytes()


def test_settings_reach_plan_and_knowledge(made: Projection) -> None:
    assert format_value(made.scenario.bound_plan()) == "wait(0.06)"
    assert ("egg1", "friction", 0.4) in made.timeline.domain.values


def test_the_world_file_opens_in_plain_mujoco(made: Projection, place: Path) -> None:
    model = mujoco.MjModel.from_xml_path(str(place / "run" / "world.xml"))  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType, reportAttributeAccessIssue]
    assert model.body("egg1").id > 0


def test_three_processes_with_different_hash_seeds_give_the_same_bytes(place: Path, made: Projection) -> None:
    contents: list[dict[str, bytes]] = []
    for seed in ("0", "1", "4242"):
        out = place / f"seed{seed}"
        command = [sys.executable, "-m", "prolepsis", "project", "short.toml", "--set", "Time=60 ms", "--out", str(out)]
        subprocess.run(
            command, check=True, cwd=place, env={**os.environ, "PYTHONHASHSEED": seed}, stdout=subprocess.DEVNULL
        )
        contents.append({file.name: file.read_bytes() for file in out.iterdir()})
    assert contents[0] == contents[1] == contents[2]


def test_a_log_alone_is_no_projection(made: Projection, tmp_path: Path) -> None:
    write_log(made.log, tmp_path / "log")
    with pytest.raises(LogError, match=r"holds a log but no projection \(it has no timeline\.json\)"):
        Projection.load(tmp_path / "log")


def test_the_log_of_a_projection_can_be_read_by_itself(made: Projection, place: Path) -> None:
    assert read_log(place / "run").things == made.log.things


def test_an_occupied_folder_is_refused_before_simulating(place: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    told: list[str] = []
    with pytest.raises(InputError, match="left alone"):
        project(place / "short.toml", out=tmp_path, progress=told.append)
    assert told == []


def test_it_is_told_when_a_run_has_ended_and_is_checked(place: Path) -> None:
    told: list[str] = []
    project(place / "short.toml", progress=told.append)
    assert [told[-3].partition(":")[0], *told[-2:]] == ["simulating", "checking", "recognizing"]


def test_an_unknown_parameter_is_refused(place: Path) -> None:
    with pytest.raises(UnknownNameError, match="no parameter named 'speed'"):
        project(place / "short.toml", speed=2)


def test_every_public_name_is_there_and_importing_them_is_lazy() -> None:
    for name in prolepsis.__all__:
        assert getattr(prolepsis, name) is not None
    code = "import sys, prolepsis; print(sorted({'mujoco', 'numpy', 'rdflib', 'pyarrow'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = prolepsis.nothing


def test_a_question_needs_no_tables_and_what_it_reads_is_checked(place: Path, made: Projection) -> None:
    folder = place / "asked"
    made.save(folder)
    for name, asks in (("contacts.parquet", True), ("timeline.json", False)):
        content = (folder / name).read_bytes()
        (folder / name).write_bytes(content[:-9] + bytes([content[-9] ^ 1]) + content[-8:])
        with pytest.raises(LogError, match=f"{name}: does not match its SHA-256"):
            Projection.load(folder)
        if asks:
            assert read_timeline(folder) == made.timeline
        else:
            with pytest.raises(LogError, match=f"{name}: does not match"):
                read_timeline(folder)
        (folder / name).write_bytes(content)

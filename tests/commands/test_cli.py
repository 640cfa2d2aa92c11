"""The command line does what its contract says, with the exit status it promises and nothing half-written."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from tests.synthetic import egg_drop_log

from prolepsis.cli import main
from prolepsis.engine.channels import CHANNELS
from prolepsis.fluents import recognize
from prolepsis.log.files import write_log_files
from prolepsis.log.saved import write_timeline_files
from prolepsis.log.sealed import write_sealed
from prolepsis.matter.kinds import known_kinds

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the log and the timeline of the synthetic drop."""
    folder = tmp_path_factory.mktemp("saved") / "drop"
    log = egg_drop_log()
    timeline = recognize(log)

    def write(path: Path) -> None:
        write_log_files(log, path)
        write_timeline_files(timeline, path)

    write_sealed(folder, write)
    return folder


@pytest.fixture
def short_drop(tmp_path: Path) -> Path:
    """A scenario that takes a moment to simulate."""
    file = tmp_path / "short.toml"
    shutil.copy(EXAMPLES / "dropped_egg.ttl", tmp_path)
    file.write_text(
        'situation = "dropped_egg.ttl"\nplan = "wait(Time)"\nduration = 0.1\n'
        '[parameters]\nTime = { value = 0.05, unit = "s" }\n'
    )
    return file


def test_project_saves_a_folder_that_can_be_asked(
    short_drop: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "run"
    assert main(["project", str(short_drop), "--out", str(out), "--set", "time=0.06"]) == 0
    assert capfd.readouterr().out.startswith("0.1 s simulated")
    assert main(["ask", str(out), "holds(supports(hand1, egg1), T)", "--json"]) == 0
    answers = capfd.readouterr().out.splitlines()
    assert len(answers) == 1
    assert json.loads(answers[0])["T"].keys() == {"start", "end"}
    assert (out / "world.xml").read_text().startswith("<mujoco")
    assert main(["ask", str(out), "occurs(waiting(0.06), T)"]) == 0


def test_project_says_when_the_plan_did_not_go_through(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "block.ttl").write_text(
        "@prefix : <https://w3id.org/prolepsis#> .\n:floor a :Floor . :block1 a :Block ; :on :floor ; :length 0.04 ; "
        ":width 0.04 ; :height 0.04 . :hand1 a :Gripper ; :pitch 90.0 ; :z 0.3 ; :opening 0.03 .",
        encoding="utf-8",
    )
    scenario = tmp_path / "block.toml"
    plan = "sequence([press(hand1, block1, floor, 5), wait(0.1)])"
    scenario.write_text(f'situation = "block.ttl"\nplan = "{plan}"\nduration = 0.2\n', encoding="utf-8")
    assert main(["project", str(scenario)]) == 0
    told, summary = capfd.readouterr().out.splitlines()
    assert re.fullmatch(r"the plan ended at [0-9.]+ s: pressing\(hand1,block1,floor,5\) was not_held \(.*\)", told)
    assert summary.startswith("0.2 s simulated")


def test_project_shows_progress_when_asked(short_drop: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["project", str(short_drop), "--progress"]) == 0
    assert "simulating" in capfd.readouterr().err


def test_ask_prints_no_and_exits_1_when_there_is_no_answer(saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["ask", str(saved), "holds(spilled(egg1), T)"]) == 1
    assert capfd.readouterr().out == "no\n"
    assert main(["ask", str(saved), "holds(spilled(egg1), T)", "--json"]) == 1
    assert capfd.readouterr().out == ""


def test_ask_prints_yes_and_an_empty_object(saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["ask", str(saved), "holds(broken(egg1), _)"]) == 0
    assert capfd.readouterr().out == "yes\n"
    assert main(["ask", str(saved), "holds(broken(egg1), _)", "--json"]) == 0
    assert capfd.readouterr().out == "{}\n"


def test_ask_limits_its_answers(saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["ask", str(saved), "holds(F, T)", "--json", "--limit", "1"]) == 0
    assert len(capfd.readouterr().out.splitlines()) == 1
    assert main(["ask", str(saved), "holds(F, T)", "--limit", "0"]) == 2
    assert "at least 1 answer" in capfd.readouterr().err


def test_ask_answers_by_chronicles_of_a_file(saved: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    rules = tmp_path / "own.pl"
    rules.write_text("chronicle(coming_down(X), T) :- occurs(falling(X), T).\n")
    assert main(["ask", str(saved), "occurs(coming_down(X), _)", "--chronicles", str(rules)]) == 0
    assert "X = egg1\n" in capfd.readouterr().out
    rules.write_text("chronicle(splitting(X), T) :- occurs(falling(X), T).\n")
    assert main(["ask", str(saved), "true", "--chronicles", str(rules)]) == 2
    assert "splitting is known without this file" in capfd.readouterr().err
    assert main(["ask", str(saved), "occurs(coming_down(X), _)", "--chronicles", str(tmp_path / "no.pl")]) == 2
    assert "no.pl: cannot read the file: No such file" in capfd.readouterr().err


def test_timeline_prints_facts_as_json(saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["timeline", str(saved), "--json"]) == 0
    rows = [json.loads(line) for line in capfd.readouterr().out.splitlines()]
    assert all(set(row) == {"kind", "type", "args", "start", "end", "evidence"} for row in rows)
    assert ["egg1"] in [row["args"] for row in rows if row["type"] == "falling"]
    assert [row["start"] for row in rows] == sorted(row["start"] for row in rows)


def test_timeline_prints_a_table(saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["timeline", str(saved)]) == 0
    head, *lines = capfd.readouterr().out.splitlines()
    assert head.split() == ["start[s]", "end[s]", "kind", "what", "evidence"]
    assert any("breaking(egg1)" in line for line in lines)


@pytest.mark.parametrize(
    ("options", "types"),
    [
        (["--type", "Breaking", "--type", "broken"], {"breaking", "broken"}),
        (["--about", "yolk1"], {"contains", "moving", "falling", "spilled", "spilling", "supports"}),
        (["--about", "egg1", "--type", "falling", "--from", "0.3", "--to", "0.4"], {"falling"}),
        (["--about", "egg1", "--type", "falling", "--to", "0.1"], set[str]()),
        (["--type", "buckled"], set[str]()),
    ],
)
def test_timeline_selects(options: list[str], types: set[str], saved: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["timeline", str(saved), "--json", *options]) == 0
    found = {json.loads(line)["type"] for line in capfd.readouterr().out.splitlines()}
    assert found <= types and bool(found) == bool(types)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--about", "eg1"], "--about: no thing named 'eg1'; did you mean 'egg1'?; known: egg1"),
        (["--type", "brocken"], "--type: no type named 'brocken'; did you mean 'broken'?"),
        (["--from", "2", "--to", "1"], "--from 2 --to 1: the first must be less than the second"),
        (["--from", "nan"], "--from nan --to inf: the first must be less than the second"),
    ],
)
def test_timeline_refuses_what_selects_nothing(
    options: list[str], message: str, saved: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["timeline", str(saved), *options]) == 2
    assert message in capfd.readouterr().err


@pytest.mark.parametrize("section", ["objects", "actions", "conditions", "fluents", "events", "channels", "examples"])
def test_list_prints_a_line_each(section: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["list", section]) == 0
    lines = capfd.readouterr().out.splitlines()
    expected = {
        "objects": "EggShell",
        "actions": "grasp(",
        "conditions": "pressed(Object, Other, Force) The two are pressed together",
        "fluents": "supports(",
        "events": "breaking(",
        "channels": "load Breakable by default the greatest bond load",
        "examples": "dropped_egg.toml",
    }
    assert any(expected[section] in " ".join(line.split()) for line in lines)
    assert all(line.strip() and len(line.split()) > 1 for line in lines)


def test_list_without_a_section_lists_all(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    out = capfd.readouterr().out
    assert [line for line in out.splitlines() if line.endswith(":") and not line.startswith(" ")] == [
        "objects:",
        "actions:",
        "conditions:",
        "fluents:",
        "events:",
        "channels:",
        "examples:",
    ]


def test_every_channel_of_every_kind_is_listed_and_described(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "channels"]) == 0
    rows = {line.split()[0]: line for line in capfd.readouterr().out.splitlines()}
    known = [*CHANNELS, *(each for kind in known_kinds() for each in kind.channels)]
    assert set(rows) == {each.name for each in known}
    for each in known:
        assert each.doc in rows[each.name]
        assert (each.role or "all") in rows[each.name]
        assert main(["describe", each.name]) == 0
        assert f"{each.name}: channel of each {each.role or 'thing'}, logged" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("EggShell", "breakingForce"),
        ("grasp", "name of a gripper"),
        ("pressed", "condition\n  The two are pressed together with at least a force."),
        ("supports", "fluent"),
        ("Breaking", "event"),
        ("friction", "property (quantity)"),
        ("force7", "ForceLevel"),
    ],
)
def test_describe_tells_what_is_known(name: str, shown: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", name]) == 0
    assert shown in capfd.readouterr().out


def test_doctor_finds_nothing_missing_here(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor"]) == 0
    assert "MISSING" not in capfd.readouterr().out


def test_doctor_names_what_is_missing_and_the_cure(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["doctor"]) == 2
    line = next(line for line in capfd.readouterr().out.splitlines() if "SWI-Prolog" in line)
    assert line.split()[0] == "MISSING"
    assert "apt install swi-prolog-nox" in line


def test_without_swi_prolog_a_question_is_refused_with_the_cure(saved: Path, tmp_path: Path) -> None:
    # A process of its own: this one may already have a session.
    done = run_prolepsis("ask", str(saved), "holds(F, T)", PATH=str(tmp_path))
    assert done.returncode == 2
    assert done.stdout == ""
    assert "swi-prolog-nox" in done.stderr
    assert len(done.stderr.splitlines()) == 1


BAD: list[tuple[list[str], str]] = [
    ([], "required: COMMAND"),
    (["fly"], "invalid choice: 'fly'"),
    (["project"], "required: SCENARIO.toml"),
    (["project", "absent.toml"], "absent.toml"),
    (["project", "{drop}", "--set", "Time"], "'Time': is not of the form NAME=VALUE"),
    (["project", "{drop}", "--set", "Speed=2"], "no parameter named 'Speed'"),
    (["project", "{drop}", "--set", "Time=1", "--set", "Time=2"], "Time: is given twice"),
    (["project", "{drop}", "--set", "Time=5 kg"], "kg"),
    (["project", "{drop}", "--set", "egg9.mass=1"], "no individual named 'egg9'"),
    (["project", "{drop}", "--set", "egg1.mass=nan"], "egg1.mass"),
    (["project", "{drop}", "--out", "{mine}"], "left alone"),
    (["ask", "{mine}", "holds(F, T)"], "no folder that prolepsis wrote"),
    (["ask", "{saved}", "holds(F, T"], "syntax"),
    (["ask", "{saved}", "hold(F, T)"], "hold/2"),
    (["timeline", "absent"], "no such folder"),
    (["sweep", "{drop}", "--over", "Time="], "'Time=': is not of the form NAME=VALUE"),
    (["sweep", "{drop}", "--over", "Time=1,,2"], "between two commas"),
    (["project", "{drop}", "--set", "Time=1", "--set", "time=2"], "time is given twice, also as Time; allowed: once"),
    (["sweep", "{drop}", "--over", "draw=true", "--set", "draw=false"], "draw is given twice; allowed: once"),
    (["sweep", "{drop}", "--over", "Time=1,2", "--set", "time=3"], "Time is given twice, also as time; allowed: once"),
    (["sweep", "{drop}", "--over", "time=1,2", "--over", "TIME=3"], "TIME is given twice, also as time; allowed: once"),
    (["sweep", "{drop}", "--over", "egg1.mass=1", "--set", "egg1.mass=2"], "egg1.mass is given twice; allowed: once"),
    (["sweep", "{drop}", "--over", "Speed=1,2"], "no parameter named 'Speed'"),
    (["render", "{saved}", "--strip", "{saved}/a.png"], "lies in the saved folder"),
    (["timeline", "{drop}"], "is a file; needed: a folder that"),
    (["render", "{saved}"], "nothing to draw"),
    (["render", "{saved}", "--out", "{new}/film.avi"], "ends in .mp4"),
    (["render", "{saved}", "--out", "{new}/film.mp4", "--speed", "0"], "speed 0"),
    (["render", "{saved}", "--frames", "{mine}"], "left alone"),
    (["render", "{saved}", "--strip", "{new}/a.png", "--times", "0,soon"], "'soon' is no number of seconds"),
    (["render", "{saved}", "--frames", "{new}/f", "--size", "10"], "WIDTHxHEIGHT"),
    (["describe", "eggshel1"], "did you mean"),
]


@pytest.mark.parametrize(("arguments", "message"), BAD, ids=[" ".join(arguments) or "nothing" for arguments, _ in BAD])
def test_bad_input_is_one_line_exit_status_2_and_nothing_written(
    arguments: list[str], message: str, short_drop: Path, saved: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "notes.txt").write_text("mine")
    before = sorted(tmp_path.rglob("*"))
    places = {"{drop}": short_drop, "{saved}": saved, "{mine}": mine, "{new}": tmp_path / "new"}
    for name, place in places.items():
        arguments = [argument.replace(name, str(place)) for argument in arguments]
    try:
        status = main(arguments)
    except SystemExit as ended:
        status = ended.code
    captured = capfd.readouterr()
    assert status == 2, captured
    assert captured.out == ""
    assert message.lower() in captured.err.lower()
    assert len(captured.err.splitlines()) == 1
    assert "Traceback" not in captured.err
    assert sorted(tmp_path.rglob("*")) == before


def test_a_damaged_folder_is_refused_by_every_command_that_reads_it(
    saved: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = shutil.copytree(saved, tmp_path / "drop")
    content = bytearray((folder / "timeline.json").read_bytes())
    content[len(content) // 2] ^= 1
    (folder / "timeline.json").write_bytes(content)
    for command in (["ask", str(folder), "true"], ["timeline", str(folder)], ["render", str(folder), "--frames", "f"]):
        assert main(command) == 2
        assert "timeline.json: does not match its SHA-256" in capfd.readouterr().err


def test_render_writes_video_frames_and_strip(saved: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    video, frames, strip = tmp_path / "a.mp4", tmp_path / "frames", tmp_path / "strip.png"
    arguments = ["--out", str(video), "--frames", str(frames), "--count", "3", "--strip", str(strip), "--size", "64x48"]
    assert main(["render", str(saved), *arguments]) == 0
    assert video.read_bytes()[4:8] == b"ftyp"
    assert strip.read_bytes().startswith(b"\x89PNG")
    written = sorted(frames.iterdir())
    assert [file.name for file in written] == ["frame0000_0.000s.png", "frame0001_0.400s.png", "frame0002_0.799s.png"]
    assert capfd.readouterr().out.splitlines() == [str(video), *map(str, written), str(strip)]


def test_render_tells_how_much_of_a_strip_is_drawn(
    saved: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["render", str(saved), "--strip", str(tmp_path / "strip.png"), "--count", "2", "--progress"]) == 0
    told = capfd.readouterr().err
    assert "drawing: 50%" in told
    assert "drawing: 100%" in told


def test_an_interrupted_projection_leaves_nothing(tmp_path: Path) -> None:
    out = tmp_path / "run"
    command = [sys.executable, "-m", "prolepsis", "project", str(EXAMPLES / "dropped_egg.toml"), "--out", str(out)]
    with subprocess.Popen([*command, "--progress"], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if "simulating" in line:
                break
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert list(tmp_path.iterdir()) == []


def test_ask_starts_without_physics_and_ontology(saved: Path) -> None:
    code = (
        "import sys; from prolepsis.cli import main; "
        f"status = main(['ask', {str(saved)!r}, 'holds(broken(egg1), _)']); "
        "print(sorted({'mujoco', 'rdflib', 'pydantic', 'pyarrow', 'scipy', 'numpy'} & set(sys.modules)), status)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "yes\n[] 0\n"


@pytest.mark.parametrize("command", ["project", "ask", "timeline", "sweep", "render", "list", "describe", "doctor"])
def test_every_command_has_help_with_an_example(command: str, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([command, "--help"])
    assert ended.value.code == 0
    assert f"example:\n  prolepsis {command}" in capfd.readouterr().out


def run_prolepsis(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Return what the command line does in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "prolepsis", *arguments],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **environment},
    )

"""Whatever is given to the command line, it answers or refuses: never a traceback, a flood, or a file left behind.

2,000 inputs are valid ones with some mutations: the same each time, unless PROLEPSIS_FUZZ_SEED is set to choose others.
"""

from __future__ import annotations

import os
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Generator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from tests.laws.mutations import mutated

from prolepsis.cli import main
from prolepsis.logic.session import shared_session

pytestmark = [pytest.mark.laws]

EXAMPLES = Path(__file__).parents[2] / "examples"
PERMITTED = {0, 1, 2, 3}
"""Statuses of an input that is answered or refused; 4 is what this looks for."""
LONGEST_LINE = 300
LONGEST_WORK = 20.0
"""Processor time of one input [s]: unlike the clock, it does not depend on what else the machine does."""
MOST_MEMORY = 2 << 30
"""[bytes]"""

PREFIX = """@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
"""
TABLE = """:floor a :Floor .
:table1 a :Table .
:block1 a :Block ; :on :table1 ; :length 0.05 ; :width 0.05 ; :height "5 cm" ; :mass 0.1 .
:hand1 a :Gripper ; :z 1.2 ; :opening 0.08 ; :pitch 90.0 .
"""
TURTLES = {
    "things": TABLE + ':ball1 a :Ball ; :z 0.9 ; :x 0.3 ; :radius 0.03 ; :mass "58 g" ; :friction 0.4 ; :wet true .\n',
    "egg": TABLE
    + """:egg1 a :Egg ; :on :table1 ; :x -0.2 ; :hasPart :eggshell1 , :yolk1 .
:eggshell1 a :EggShell ; :breakingForce 30.0 ; :pieceCount 20.0 .
:yolk1 a :EggYolk ; :mass 0.02 .
""",
    "liquid": TABLE
    + """:cup1 a :Cup ; :on :table1 ; :x 0.2 ; :contains :water1 ; :holeRadius 0.004 ; :holeHeight 0.05 .
:water1 a :Water ; :volume "20 ml" ; :temperature 20.0 .
""",
    "class": TABLE
    + """:Brick a owl:Class ; rdfs:subClassOf :Block ; rdfs:comment "Of clay." ;
  :default [ :of :density ; :value 2000.0 ; :deviation 50.0 ; :source "a table" ; :certainty "M" ] ,
    [ :of :length ; :value 0.2 ; :source "a rule" ; :certainty "D" ] ;
  :limit [ :of :length ; :atLeast 0.01 ; :atMost 0.3 ] .
:brick1 a :Brick ; :on :table1 ; :x 0.2 ; :width 0.1 ; :height 0.05 .
""",
    "sponge": TABLE
    + """:sponge1 a :Sponge ; :on :table1 ; :x 0.2 ; :saturation 0.5 ; :absorbs :water1 .
:water1 a :Water ; :volume "5 ml" .
""",
}
SITUATION = TURTLES["egg"] + TURTLES["liquid"].removeprefix(TABLE)
PLANS = (
    "sequence([wait(0.01), lift(hand1, 0.01), carry(hand1, [0.01, 0.0, 0.01], 1.0, 0.5), wait(Time)])",
    "together([tilt(hand1, 0.2, 1.0), wait(Time)])",
    "sequence([grasp(hand1, egg1, force7), hold(hand1, Time), release(hand1)])",
    "repeat_until(touching(block1, table1), wait(Time))",
    "repeat_until(not(above(egg1, 0.5)), sequence([wait(Time)]))",
    "pour(hand1, cup1, block1, 1.5, 0.5, 0.02, 0.0, Time)",
    "[wait(Time), press(hand1, block1, table1, 1, top, 0.1)]",
    "hit(hand1, egg1, cup1, 0.2, 'edge') % a comment",
)
SCENARIO = """situation = "s.ttl"
plan = "sequence([wait(0.01), lift(hand1, Height), wait(Time)])"
duration = 0.05
seed = 1
draw = true
particles = 300
[parameters]
Time = { value = 10, unit = "ms" }
Height = "1 cm"
[knowledge]
"block1.mass" = "120 g"
"block1.friction" = 0.3
"block1.wet" = true
[monitors]
hand1 = ["gripper"]
"""
GOALS = (
    "holds(F, T), objOf(F, egg1)",
    "occurs(E, T1), after(T2, T1), holds(F, T2)",
    "holds(supports(table1, X), S-E), E > S, \\+ X = egg1",
    "findall(X, holds(contacts(X, table1), _), L), length(L, N), N >= 1",
    "instance_of(X, 'Egg') ; value(X, mass, M), M < 0.1",
    "allen(R, 0.0-1.0, 0.5-2.0), evidence(F, T, Name, Value)",
    "forall(holds(F, T), (argsOf(F, A), is_list(A)))",
)
ARGUMENTS = (
    "project s.toml --set Time=0.02 --set block1.mass=0.2",
    "project s.toml --set 'Height=2 cm' --set seed=3 --out out/run",
    "describe block1",
    "describe EggShell",
    "list actions",
    "ask run 'holds(F, T)' --limit 2 --json",
    "timeline run --json",
    "render run --frames out/frames --count 1 --size 64x48",
    "render run --strip out/strip.png --times 0,0.01",
)


@pytest.fixture(scope="module")
def workplace(tmp_path_factory: pytest.TempPathFactory) -> Generator[Path]:
    """A folder to work in, with a saved projection, and a temporary folder of its own."""
    place = tmp_path_factory.mktemp("fuzz")
    (place / "tmp").mkdir()
    write(place, SCENARIO, PREFIX + SITUATION)
    before = Path.cwd(), os.environ.get("TMPDIR"), tempfile.tempdir
    os.chdir(place)
    os.environ["TMPDIR"] = tempfile.tempdir = str(place / "tmp")
    shared_session().close()
    try:
        # Kernels are compiled and libraries loaded by what is not counted.
        assert main(["project", "s.toml", "--out", "run"]) == 0
        assert main(["ask", "run", "holds(F, T)"]) == 0
        yield place
    finally:
        shared_session().close()
        os.chdir(before[0])
        tempfile.tempdir = before[2]
        os.environ.pop("TMPDIR")
        if before[1] is not None:
            os.environ["TMPDIR"] = before[1]


def write(place: Path, scenario: str, turtle: str) -> None:
    """Write a scenario and its situation; what UTF-8 cannot express is left out."""
    for name, text in (("s.toml", scenario), ("s.ttl", turtle)):
        (place / name).write_bytes(text.encode("utf-8", "ignore"))


def fuzzed(count: int) -> settings:
    """Return the settings of one test."""
    return settings(
        max_examples=count,
        deadline=None,
        database=None,
        derandomize=True,
        phases=[Phase.generate],
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
    )


def check(place: Path, arguments: list[str]) -> None:
    shutil.rmtree(place / "out", ignore_errors=True)
    before, began = listing(place), time.process_time()
    errors = place / "errors"
    with errors.open("w", encoding="utf-8") as stream, open(os.devnull, "w", encoding="utf-8") as nowhere:
        kept = sys.stdout, sys.stderr
        sys.stdout, sys.stderr = nowhere, stream
        try:
            status = main(arguments)
        except SystemExit as ended:
            status = int(ended.code or 0)
        finally:
            sys.stdout, sys.stderr = kept
    work = time.process_time() - began
    look_at(status, errors.read_text(encoding="utf-8"))
    assert work < LONGEST_WORK, f"{work:.0f} s of work"
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 < MOST_MEMORY
    assert listing(place) == before


def look_at(status: int, errors: str) -> None:
    """Check a status and what was said on standard error."""
    assert status in PERMITTED, errors
    assert "Traceback" not in errors
    lines = errors.splitlines()
    assert all(len(line) <= LONGEST_LINE for line in lines)
    assert len([line for line in lines if not line.startswith("prolepsis: note: ")]) == (status in (2, 3)), errors


def listing(place: Path) -> list[str]:
    """Return all files but those in ``out``, and those of the running Prolog."""
    process = shared_session()._process  # pyright: ignore[reportPrivateUsage]
    prolog = "" if process is None else process.folder.name
    files = (str(file.relative_to(place)) for file in place.rglob("*"))
    return sorted(f for f in files if not f.startswith(("out", "errors")) and (not prolog or prolog not in f))


@fuzzed(450)
@given(text=mutated(SCENARIO))
def test_scenario(workplace: Path, text: str) -> None:
    write(workplace, text, PREFIX + TABLE)
    check(workplace, ["project", "s.toml"])


@fuzzed(450)
@given(text=st.one_of([mutated(plan) for plan in PLANS]))
def test_plan(workplace: Path, text: str) -> None:
    plan = "".join(f"\\U{ord(c):08x}" if c in "'\"\\" or not c.isprintable() else c for c in text)
    scenario = f'situation = "s.ttl"\nplan = "{plan}"\nduration = 0.05\nparticles = 300\n'
    scenario += "[parameters]\nTime = 0.02\n" if "Time" in text else ""
    write(workplace, scenario, PREFIX + SITUATION)
    check(workplace, ["project", "s.toml"])


@fuzzed(550)
@given(text=st.one_of([mutated(turtle) for turtle in TURTLES.values()]))
def test_situation(workplace: Path, text: str) -> None:
    write(workplace, 'situation = "s.ttl"\nplan = "wait(0.01)"\nduration = 0.02\nparticles = 200\n', PREFIX + text)
    check(workplace, ["project", "s.toml"])


@fuzzed(250)
@given(text=st.one_of([mutated(goal) for goal in GOALS]))
def test_goal(workplace: Path, text: str) -> None:
    check(workplace, ["ask", "run", "--limit=50", "--", text])


@fuzzed(100)
@given(name=st.sampled_from(["manifest.json", "timeline.json", "scenario.json"]), data=st.data())
def test_saved_folder(workplace: Path, name: str, data: st.DataObject) -> None:
    shutil.rmtree(workplace / "altered", ignore_errors=True)
    shutil.copytree(workplace / "run", workplace / "altered")
    text = data.draw(mutated((workplace / "run" / name).read_text(encoding="utf-8")))
    (workplace / "altered" / name).write_bytes(text.encode("utf-8", "ignore"))
    check(workplace, ["timeline", "altered"])


ROBOT = EXAMPLES / "own_arm.toml"
ROBOT_TABLE = ROBOT.read_text(encoding="utf-8").partition("[robot]")[2]


@fuzzed(100)
@given(
    model=mutated((EXAMPLES / "own_arm.xml").read_text(encoding="utf-8")),
    table=mutated(ROBOT_TABLE),
    which=st.booleans(),
)
def test_robot(workplace: Path, model: str, table: str, which: bool) -> None:
    shutil.copy(EXAMPLES / "own_arm.ttl", workplace)
    shutil.copy(EXAMPLES / "own_arm.xml", workplace)
    scenario = 'situation = "own_arm.ttl"\nplan = "wait(0.01)"\nduration = 0.02\n[robot]'
    write(workplace, scenario + (table if which else ROBOT_TABLE), "")
    if not which:
        (workplace / "own_arm.xml").write_bytes(model.encode("utf-8", "ignore"))
    check(workplace, ["project", "s.toml"])


@fuzzed(100)
@given(line=st.sampled_from(ARGUMENTS), data=st.data())
def test_arguments(workplace: Path, line: str, data: st.DataObject) -> None:
    write(workplace, SCENARIO, PREFIX + TABLE)
    command, *words = shlex.split(line)
    # What is written stays where it is looked for.
    k = data.draw(st.sampled_from([k for k, word in enumerate(words) if not word.startswith("out/")]))
    words[k] = data.draw(mutated(words[k]))
    check(workplace, [command, *words])


@fuzzed(20)
@given(text=mutated(SCENARIO), turtle=mutated(TURTLES["egg"]))
def test_process_of_its_own(workplace: Path, text: str, turtle: str) -> None:
    write(workplace, text, PREFIX + turtle)
    before, began = listing(workplace), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [sys.executable, "-m", "prolepsis", "project", "s.toml"], capture_output=True, timeout=600, check=False
    )
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    look_at(done.returncode, done.stderr.decode())
    assert ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime < LONGEST_WORK
    assert ended.ru_maxrss * 1024 < MOST_MEMORY
    assert listing(workplace) == before

"""Closed and full streams, a terminal that knows no letters, and Ctrl-C: one line, the right status, no traceback."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from prolepsis.cli import main

TURTLE = """@prefix : <https://w3id.org/prolepsis#> .
:floor a :Floor . :Würfel a :Block ; :on :floor ; :length 0.05 ; :width 0.05 ; :height 0.05 .
"""


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which ``run`` is a projection with a thing whose name is not ASCII."""
    folder = tmp_path_factory.mktemp("surroundings")
    (folder / "s.ttl").write_text(TURTLE, encoding="utf-8")
    (folder / "s.toml").write_text('situation = "s.ttl"\nplan = "wait(0.02)"\nduration = 0.05\n')
    done = prolepsis(folder, "project", "s.toml", "--out", "run")
    assert done == (0, "0.05 s simulated, 3 facts recognized, saved in run\n", "")
    return folder


def prolepsis(folder: Path, *arguments: str, shell: str = "", **environment: str) -> tuple[int, str, str]:
    """Return status and streams of the command line, in a shell that redirects them."""
    command = f'"$@" {shell}' if "|" in shell or ">" in shell or "<" in shell else '"$@"'
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", command, "bash", sys.executable, "-m", "prolepsis", *arguments],
        capture_output=True,
        text=True,
        cwd=folder,
        check=False,
        env={**os.environ, **environment},
    )
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize("command", [["list", "actions"], ["timeline", "run"], ["--help"], ["describe", "Egg"]])
def test_an_answer_that_cannot_be_written_is_no_success(command: list[str], saved: Path) -> None:
    full = "prolepsis: standard output: No space left on device\n"
    closed = "prolepsis: standard output is closed, so there is nowhere to answer\n"
    assert prolepsis(saved, *command, shell=">/dev/full") == (2, "", full)
    assert prolepsis(saved, *command, shell=">&-") == (2, "", closed)


def test_a_reader_that_has_seen_enough_is_no_problem(saved: Path) -> None:
    assert prolepsis(saved, "list", shell="| head -c 0") == (0, "", "")
    assert prolepsis(saved, "ask", "run", "holds(F, T)", shell="| head -c 0") == (0, "", "")
    assert prolepsis(saved, "ask", "run", "holds(broken(X), T)", shell="| head -c 0") == (1, "", "")


def test_closed_input_and_errors_change_nothing(saved: Path) -> None:
    before = sorted(saved.rglob("*"))
    assert prolepsis(saved, "ask", "run", "holds(supports(floor, X), _)", shell="<&- 2>&-")[0] == 0
    assert prolepsis(saved, "ask", "run", "nonsense(", shell="<&- 2>&-") == (2, "", "")
    assert prolepsis(saved, "project", "absent.toml", shell="2>/dev/full")[0] == 2
    assert sorted(saved.rglob("*")) == before


def test_letters_that_the_terminal_does_not_know_are_written_otherwise(saved: Path) -> None:
    for environment in ({"PYTHONIOENCODING": "ascii"}, {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}):
        goal = "holds(supports(floor, X), _)"
        assert prolepsis(saved, "ask", "run", goal, **environment) == (0, "X = 'W\\xfcrfel'\n", "")
        assert prolepsis(saved, "ask", "run", goal, "--json", **environment) == (0, '{"X": "W\\u00fcrfel"}\n', "")
        assert '["floor", "W\\u00fcrfel"]' in prolepsis(saved, "timeline", "run", "--json", **environment)[1]
        status, out, errors = prolepsis(saved, "describe", "Würfel", **environment)
        assert (status, out) == (2, "")
        assert "\\xfcrfel" in errors or "\\udcc3" in errors


def test_a_wrong_way_to_draw_is_told(saved: Path) -> None:
    told = "prolepsis: MuJoCo does not start with MUJOCO_GL=nonsense; unset MUJOCO_GL, or set it to egl or osmesa\n"
    assert prolepsis(saved, "project", "s.toml", MUJOCO_GL="nonsense") == (2, "", told)
    status, out, errors = prolepsis(saved, "doctor", MUJOCO_GL="nonsense")
    assert (status, errors) == (2, "")
    assert "MuJoCo does not start with MUJOCO_GL=nonsense: unset MUJOCO_GL" in out


def test_an_interruption_while_modules_load_is_told(saved: Path) -> None:
    code = f"import os, sys; sys.argv[0] = 'prolepsis'; {INTERRUPT}; from prolepsis.cli import main; sys.exit(main())"
    for module in ("argparse", "pydantic", "mujoco", "rdflib", "numpy.linalg", "prolepsis.engine.simulation"):
        command = [sys.executable, "-c", code, "project", "s.toml"]
        # With nothing kept, rdflib is loaded too.
        environment = {**os.environ, "INTERRUPTED": module, "PROLEPSIS_CACHE": ""}
        done = subprocess.run(command, capture_output=True, text=True, cwd=saved, check=False, env=environment)
        assert (done.returncode, done.stdout) == (130, ""), module
        assert done.stderr == "prolepsis: interrupted; nothing was written\n"


INTERRUPT = f"""exec('''
import sys
class Finder:
    def find_spec(self, name, path, target=None):
        if name == os.environ["INTERRUPTED"]:
            sys.meta_path.remove(self)
            os.kill(os.getpid(), {int(signal.SIGINT)})
sys.meta_path.insert(0, Finder())
''')"""


def test_an_interruption_that_a_library_makes_an_error_of_its_own_is_one(saved: Path) -> None:
    code = (
        "import os, signal, sys\n"
        "from prolepsis import cli\n"
        "from prolepsis.commands import catalogue\n"
        "def run(given):\n"
        "    try:\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "    except KeyboardInterrupt:\n"
        "        raise ImportError('initialization failed') from None\n"
        "catalogue.run_list = run\n"
        "sys.argv[1:] = ['list']\n"
        "sys.exit(cli.main())\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=saved, check=False)
    assert (done.returncode, done.stderr) == (130, "prolepsis: interrupted; nothing was written\n")


def test_a_folder_whose_name_is_not_utf_8_is_written_and_read(saved: Path) -> None:
    name = os.fsdecode(b"not\xffutf8")
    assert prolepsis(saved, "project", "s.toml", "--out", name)[::2] == (0, "")
    assert prolepsis(saved, "ask", name, "holds(supports(floor, _), _)") == (0, "yes\n", "")
    assert prolepsis(saved, "render", name, "--strip", f"{name}.png", "--count", "1")[::2] == (0, "")
    assert prolepsis(saved, "render", name, "--frames", f"{name}.frames", "--count", "1")[::2] == (0, "")
    (saved / name / "s.toml").write_text("situation = 's.ttl'")
    status, out, errors = prolepsis(saved, "project", f"{name}/s.toml")
    assert (status, out) == (2, "")
    assert errors == "prolepsis: not\\udcffutf8/s.toml: the name of the scenario is not UTF-8 text; rename it\n"


def test_pictures_that_cannot_be_saved_are_refused(saved: Path) -> None:
    status, out, errors = prolepsis(saved, "render", "run", "--frames", "x" * 300, "--count", "1")
    assert (status, out) == (2, "")
    assert errors.endswith("File name too long\n")
    assert len(errors.splitlines()) == 1


def test_too_little_memory_is_told_in_one_line(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    limited = 'ulimit -v 300000; exec "$@"'
    done = subprocess.run(
        ["bash", "-c", limited, "bash", sys.executable, "-m", "prolepsis", "project", "s.toml"],
        capture_output=True,
        text=True,
        cwd=saved,
        check=False,
    )
    assert (done.returncode, done.stderr) == (
        2,
        "prolepsis: 292 MB of memory are allowed (ulimit -v); needed: 512 MB\n",
    )

    def run_short(*arguments: object, **named: object) -> None:
        raise MemoryError

    monkeypatch.setattr("prolepsis.log.saved.read_timeline", run_short)
    monkeypatch.setattr("prolepsis.cli._memory", lambda: 1000.0)
    assert main(["timeline", str(saved / "run")]) == 2

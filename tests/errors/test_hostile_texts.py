"""Numbers, terms, Turtle and files that no program expects are refused in one line of at most 300 characters."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from prolepsis.cli import main
from prolepsis.terms.errors import LONGEST_LINE, InputError, brief, brief_list, error_line
from prolepsis.terms.reader import parse_term

TURTLE = """@prefix : <https://w3id.org/prolepsis#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
:floor a :Floor . :table1 a :Table .
:block1 a :Block ; :on :table1 ; :length 0.05 ; :width 0.05 ; :height 0.05 .
:cup1 a :Cup ; :on :table1 ; :x 0.2 . :hand1 a :Gripper ; :z 1.2 .
"""
HUGE = "1" + "0" * 400
LONG = "1" + "0" * 5000


def refused(
    folder: Path, capfd: pytest.CaptureFixture[str], *, plan: str = "wait(0.02)", rest: str = "", turtle: str = ""
) -> str:
    """Return the one line with which a scenario is refused."""
    (folder / "s.ttl").write_text(TURTLE + turtle, encoding="utf-8")
    file = folder / "s.toml"
    file.write_text(f"situation = 's.ttl'\nplan = '''{plan}'''\n{rest}", encoding="utf-8")
    return line_of(capfd, file)


def line_of(capfd: pytest.CaptureFixture[str], file: Path | str) -> str:
    """Return the one line with which a scenario file is refused, without the folder."""
    assert main(["project", str(file)]) == 2
    captured = capfd.readouterr()
    assert captured.out == ""
    assert len(captured.err) <= LONGEST_LINE + 1
    (line,) = captured.err.splitlines()
    assert line.isprintable()
    return line.replace(f"{Path(file).parent}/", "")


SCENARIOS = {
    "huge duration": ("wait(0.02)", f"duration = {HUGE}", "duration must be a finite number"),
    "duration of days": ("wait(0.02)", "duration = 1e9", "at most 86,400"),
    "too many digits": ("wait(0.02)", f"duration = {LONG}", "TOML syntax: a number"),
    "huge parameter": ("wait(T)", f"[parameters]\nT = {HUGE}", "parameter T must be finite"),
    "huge quantity": (
        "wait(T)",
        f'[parameters]\nT = {{ value = {HUGE}, unit = "s" }}',
        "parameter T must be finite",
    ),
    "huge knowledge": ("wait(0.02)", f'[knowledge]\n"block1.mass" = {HUGE}', "block1.mass: mass = inf: must be finite"),
    "huge seed": ("wait(0.02)", f"seed = {HUGE}", "seed = 1000"),
    "huge particles": ("wait(0.02)", f"particles = {HUGE}", "particles = 1000"),
    "not a number": ("wait(0.02)", "duration = nan", "not nan"),
    "endless": ("wait(0.02)", "duration = inf", "not inf"),
    "date": ("wait(0.02)", "duration = 2026-01-01", "duration = 2026-01-01: give a number of seconds"),
    "truth": ("wait(0.02)", "duration = true", "duration = true: give a number"),
    "table": ("wait(0.02)", "duration = { a = { b = 1 } }", "duration = {'a'"),
    "deep": ("wait(0.02)", "x = " + "[" * 5000 + "]" * 5000, "TOML syntax: tables or lists are nested too deeply"),
    "long key": ("wait(0.02)", "k" * 5000 + " = 1", "unknown key 'kkk"),
    "escape in a key": ("wait(0.02)", '"a\\u001b[31mb" = 1', "unknown key 'a\\x1b[31mb'"),
    "power of a unit": ("wait(T)", '[parameters]\nT = "5 mm^400"', "no unit 'mm^400'"),
    "huge number in the plan": (f"wait({HUGE})", "", "must be finite"),
    "too many digits in the plan": (f"wait({LONG})", "", "a number has too many digits"),
    "chain": ("+".join(["1"] * 20_000), "", "at most 150 levels of nesting"),
    "chain of chains": ("(" * 100 + "+1+1+1)" * 100, "", "at most 150 levels of nesting"),
    "nested": ("(" * 20_000, "", "at most 150 levels of nesting"),
    "no character": (r"wait('\UFFFFFFFF')", "", "an escape that is no character"),
    "no character, octal": (r"wait('\77777777777777777777\')", "", "an escape that is no character"),
    "half a character": (r"wait('\xD800\')", "", "an escape that is no character"),
    "partial list": ("sequence([wait(1)|T])", "", "[A|B] is no list"),
    "far": ("lift(hand1, 1e300)", "", "must be at most 100 m in size"),
    "far aside": ("carry(hand1, [1e300, 0, 0])", "", "must be at most 100 m in size"),
    "long time": ("wait(1e300)", "", "must be at most 86400 s in size"),
    "terminal escapes": (r"'\e[31mred'(1)", "", "no action named '\\x1b[31mred'"),
    "long name": ("x" * 5000 + "(1)", "", "no action named 'xxx"),
}


@pytest.mark.parametrize(("plan", "rest", "message"), SCENARIOS.values(), ids=list(SCENARIOS))
def test_a_scenario_that_cannot_be_is_refused(
    plan: str, rest: str, message: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert message in refused(tmp_path, capfd, plan=plan, rest=rest)


TURTLES = {
    "no double": (':block1 :mass "xx"^^xsd:double .', "mass must be a number, with or without a unit, not 'xx'"),
    "blank nodes": (":block1 :hasPart " + "[ :hasPart " * 5000 + "[]" + " ]" * 5000 + " .", "nested too deeply"),
    "lists": (":block1 :hasPart " + "( " * 5000 + ") " * 5000 + ".", "nested too deeply"),
    "huge": (f":block1 :mass {HUGE} .", "mass = 1000"),
    "too many digits": (f":block1 :mass {LONG} .", "Turtle syntax"),
    "escapes": (':block1 :mass "\\u001b[31m" .', "not '\\x1b[31m'"),
    "long word": (":block1 :mass " + "x" * 5000 + " .", "Turtle syntax"),
}


@pytest.mark.parametrize(("turtle", "message"), TURTLES.values(), ids=list(TURTLES))
def test_turtle_that_cannot_be_is_refused(
    turtle: str, message: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert message in refused(tmp_path, capfd, turtle=turtle)


def test_no_more_than_a_word_of_a_foreign_file_is_shown(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "secret").write_text("password: tower-of-london and more than that\n")
    (tmp_path / "s.toml").write_text('situation = "secret"\nplan = "wait(0.02)"\n')
    line = line_of(capfd, tmp_path / "s.toml")
    assert "secret:1: Turtle syntax" in line
    assert "tower" not in line and "more than that" not in line


def test_what_is_no_file_is_refused_as_a_scenario(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "empty.toml").write_text("")
    (tmp_path / "latin.toml").write_bytes(b'plan = "\xe4"')
    (tmp_path / "zeros.toml").write_bytes(b"\0" * 1000)
    (tmp_path / "long.toml").write_bytes(b"# \n" * 400_000)
    for name, message in {
        "pipe": "it is a pipe, not a file",
        "": "it is a folder, not a file",
        "/dev/zero": "it is a device, not a file",
        "empty.toml": "the key 'situation' is missing",
        "latin.toml": "is not UTF-8 text",
        "zeros.toml": "TOML syntax",
        "long.toml": "is too long",
        "x" * 300: "File name too long",
        "\udcff.toml": "is not UTF-8 text; rename it",
    }.items():
        assert message in line_of(capfd, os.path.join(tmp_path, name))


@pytest.mark.parametrize("name", ["/dev/zero", "/dev/null", ".", "pipe", "x\\u0000", "y" * 300, "none.ttl"])
def test_what_is_no_file_is_refused_as_a_situation(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "s.toml").write_text(f'situation = "{name}"\nplan = "wait(0.02)"\n')
    assert "situation: there is no file" in line_of(capfd, tmp_path / "s.toml")


@pytest.mark.parametrize(
    "text",
    ["0'\\\n", "'\\x110000\\'", "1.0e999999999999", "0b", "'" + "\\" * 999, "a" * 100_000 + "(", "f(" * 149 + "x"],
)
def test_a_strange_term_is_read_or_refused(text: str) -> None:
    try:
        parse_term(text)
    except InputError as error:
        assert len(str(error)) <= LONGEST_LINE


def test_a_long_list_is_no_deep_term() -> None:
    assert parse_term("[" + ",".join(["x"] * 5000) + "|T]") is not None
    assert parse_term("[" + ",".join(["x"] * 5000) + "]") == ("x",) * 5000


def test_values_are_shortened_in_the_middle() -> None:
    assert brief("x" * 10_000) == "x" * 27 + " ... " + "x" * 28
    assert len(brief("\x1b" * 10_000)) <= 60
    assert brief(10**5000) == "an integer of thousands of digits"
    assert brief_list([]) == "none"
    assert brief_list(map(str, range(1000))).endswith(", ...")
    assert len(error_line("a\n" * 1000)) == LONGEST_LINE

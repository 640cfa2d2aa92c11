"""An error that nobody foresaw is one line and exit status 4, and an option shows where it happened."""

from __future__ import annotations

import argparse

import pytest

from prolepsis.cli import main
from prolepsis.commands import catalogue
from prolepsis.terms.errors import LONGEST_LINE

COMMANDS = ["project", "ask", "timeline", "sweep", "render", "list", "describe", "doctor"]


class _Panic(BaseException):
    """As a library in another language may raise it."""


def endless(depth: int = 0) -> int:
    """Return nothing, ever."""
    return endless(depth + 1) + 1


def fail_with(error: BaseException | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let ``prolepsis list`` fail, with endless recursion if ``error`` is None."""

    def run(given: argparse.Namespace) -> int:
        del given
        if error is None:
            return endless()
        raise error

    monkeypatch.setattr(catalogue, "run_list", run)


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (KeyError("egg1"), "KeyError: 'egg1'"),
        (MemoryError(), "MemoryError; "),
        (None, "RecursionError: "),
        (_Panic("lost"), "_Panic: lost"),
        (ValueError("one\ntwo " + "x" * 5000), "ValueError: one two x"),
        (BrokenPipeError(32, "Broken pipe"), "BrokenPipeError: "),
        (ConnectionError("lost"), "ConnectionError: lost"),
    ],
    ids=["key", "memory", "recursion", "panic", "long", "pipe", "connection"],
)
def test_an_unexpected_failure_is_one_line_and_exit_status_4(
    error: BaseException | None, words: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    fail_with(error, monkeypatch)
    assert main(["list"]) == 4
    captured = capfd.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(f"prolepsis: unexpected failure: {words}")
    assert captured.err.endswith("the same command with --traceback shows where\n")
    assert len(captured.err.splitlines()) == 1
    assert len(captured.err) <= LONGEST_LINE + 1


@pytest.mark.parametrize("given", [["list", "--traceback"], ["--traceback", "list"], ["list", "--trace"]])
def test_traceback_shows_where_it_happened(
    given: list[str], monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    fail_with(KeyError("egg1"), monkeypatch)
    assert main(given) == 4
    shown = capfd.readouterr().err
    assert shown.startswith("Traceback (most recent call last):\n")
    assert "in run\n" in shown
    assert shown.endswith("KeyError: 'egg1'\n")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_can_show_where(command: str, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main([command, "--help"])
    assert "--traceback" in capfd.readouterr().out


def test_a_refusal_shows_no_traceback_even_when_asked(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", "eggshel1", "--traceback"]) == 2
    assert len(capfd.readouterr().err.splitlines()) == 1

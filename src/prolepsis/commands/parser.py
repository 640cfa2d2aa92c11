"""The parser of the whole command line: eight commands and their help."""

from __future__ import annotations

import argparse
import sys
from typing import Any, NoReturn

from prolepsis.commands import ask, catalogue, doctor, project, render, sweep, timeline
from prolepsis.commands.output import add_traceback
from prolepsis.terms.errors import error_line

DESCRIPTION = """\
Ask what happens if a robot does this: prolepsis simulates the action in detail and answers in symbols.

  prolepsis project examples/dropped_egg.toml --out out/drop
  prolepsis timeline out/drop
  prolepsis ask out/drop 'holds(broken(X), T)'
"""
EPILOGUE = """\
All quantities are in SI units (m, kg, s, N) unless a unit is written: 25, '25 N', '0.4 m'.
Exit status: 0 answered, 1 no (the goal has no answer), 2 bad input, 3 the simulation was invalid,
4 an unexpected failure (--traceback shows where), 130 interrupted.
`prolepsis COMMAND --help` shows an example of each.
"""
BAD_COMMAND_LINE = 2
"""Exit status, as of all bad input."""


class _Parser(argparse.ArgumentParser):
    """Reports a wrong command line in one line, as every other error."""

    def error(self, message: str) -> NoReturn:
        print(error_line(f"{self.prog}: {message}; see {self.prog} --help"), file=sys.stderr)
        sys.exit(BAD_COMMAND_LINE)


class _Version(argparse.Action):
    """Looks the version up when it is asked for, which takes a third of the time of --help."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from importlib.metadata import version

        print(f"{parser.prog} {version('prolepsis')}")
        parser.exit()


def parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    top = _Parser(
        prog="prolepsis",
        description=DESCRIPTION,
        epilog=EPILOGUE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show program's version number and exit")
    add_traceback(top)
    commands = top.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for command in (project, ask, timeline, sweep, render, catalogue, doctor):
        command.add_to(commands)
    return top

"""The command line: eight commands, their help, and what becomes of an error."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import NoReturn

from prolepsis.commands import ask, catalogue, doctor, project, render, sweep, timeline
from prolepsis.errors import InputError, InvalidSimulationError, MissingToolError

ANSWERED, NO, BAD_INPUT, INVALID = 0, 1, 2, 3
INTERRUPTED = 130
"""As shells report a process that was ended by Ctrl-C."""

DESCRIPTION = """\
Ask what happens if a robot does this: prolepsis simulates the action in detail and answers in symbols.

  prolepsis project examples/dropped_egg.toml --out out/drop
  prolepsis timeline out/drop
  prolepsis ask out/drop 'holds(broken(X), T)'
"""
EPILOGUE = """\
All quantities are in SI units (m, kg, s, N) unless a unit is written: 25, '25 N', '0.4 m'.
Exit status: 0 answered, 1 no (the goal has no answer), 2 bad input, 3 the simulation was invalid.
`prolepsis COMMAND --help` shows an example of each.
"""


class _Parser(argparse.ArgumentParser):
    """Reports a wrong command line in one line, as every other error."""

    def error(self, message: str) -> NoReturn:
        print(f"{self.prog}: {message}; see {self.prog} --help", file=sys.stderr)
        sys.exit(BAD_INPUT)


def parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    top = _Parser(
        prog="prolepsis",
        description=DESCRIPTION,
        epilog=EPILOGUE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"prolepsis {version('prolepsis')}")
    commands = top.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for command in (project, ask, timeline, sweep, render, catalogue, doctor):
        command.add_to(commands)
    return top


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    given = parser().parse_args(arguments)
    try:
        status: int = given.run(given)
        sys.stdout.flush()
        return status
    except InvalidSimulationError as error:
        return _tell(error, INVALID)
    except (InputError, MissingToolError) as error:
        return _tell(error, BAD_INPUT)
    except BrokenPipeError:
        # The reader, such as `head`, has seen enough; Python would complain once more when it ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ANSWERED
    except OSError as error:
        return _tell(error, BAD_INPUT)
    except KeyboardInterrupt:
        return _tell("interrupted; nothing was written", INTERRUPTED)


def _tell(error: object, status: int) -> int:
    line = " ".join(str(error).split())
    print(f"prolepsis: {line}", file=sys.stderr)
    return status

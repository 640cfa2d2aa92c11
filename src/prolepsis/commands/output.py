"""How commands print: values, tables, and a progress line on standard error."""

from __future__ import annotations

import argparse
import json
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, Any, TextIO

from prolepsis.terms.errors import InputError, Note, error_line

if TYPE_CHECKING:
    from prolepsis.terms.terms import Value

QUIET = 1.0
"""No progress is shown before this time [s]."""


def add_command(commands: Any, name: str, doc: str, example: str, run: Callable[[Any], int]) -> argparse.ArgumentParser:
    """Return the parser of a new command, whose help ends with an example."""
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=doc,
        description=doc[:1].upper() + doc[1:] + ".",
        epilog=f"example:\n{example.rstrip()}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_traceback(parser, default=argparse.SUPPRESS)
    parser.set_defaults(run=run)
    return parser


def add_traceback(parser: argparse.ArgumentParser, default: Any = False) -> None:
    """Add the option that shows tracebacks; it may stand before a command and after it."""
    doc = "show where an unexpected failure happened"
    parser.add_argument("--traceback", action="store_true", default=default, help=doc)


def add_progress(parser: argparse.ArgumentParser) -> None:
    """Add the option that shows progress also when standard error is no terminal."""
    parser.add_argument("--progress", action="store_true", help="show progress also when not at a terminal")


def settings(pairs: Sequence[str]) -> dict[str, str]:
    """Return NAME=VALUE arguments as a mapping.

    Raises:
        InputError: If one is not of this form or a name is given twice.
    """
    result: dict[str, str] = {}
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise InputError(f"{pair!r}: is not of the form NAME=VALUE")
        if name.strip() in result:
            raise InputError(f"{name.strip()}: is given twice")
        result[name.strip()] = value.strip()
    return result


@contextmanager
def progress_line(wanted: bool) -> Generator[Callable[[str], None]]:
    """Yield a function that shows what is being done on one line of standard error, and clear it at the end."""
    terminal = sys.stderr.isatty()
    began = time.monotonic()
    width = 0
    interrupted = False

    def interrupt(number: int, frame: FrameType | None) -> None:
        nonlocal interrupted
        interrupted = True
        if callable(before):
            before(number, frame)
        raise KeyboardInterrupt

    def show(doing: str) -> None:
        nonlocal width
        if interrupted:
            # What was going on, such as a callback of a compiler, has swallowed it.
            raise KeyboardInterrupt
        elapsed = time.monotonic() - began
        if not (terminal or wanted) or (terminal and elapsed < QUIET):
            return
        line = f"{doing} ({elapsed:.0f} s)"
        print(f"\r{line.ljust(width)}" if terminal else line, end="" if terminal else "\n", file=sys.stderr, flush=True)
        width = len(line)

    is_main = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, interrupt) if is_main else None
    try:
        yield show
    finally:
        if is_main:
            signal.signal(signal.SIGINT, before)
        if terminal and width:
            print("\r" + " " * width + "\r", end="", file=sys.stderr, flush=True)


@contextmanager
def notes_told() -> Generator[None]:
    """Tell each note once, in a line of standard error; other warnings are for developers, who ask for them."""
    show = warnings.showwarning
    told: set[str] = set()

    def tell(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        if not issubclass(category, Note):
            if sys.warnoptions:
                show(message, category, filename, lineno, file, line)
        elif str(message) not in told:
            told.add(str(message))
            print(error_line(f"prolepsis: note: {message}"), file=sys.stderr)

    with warnings.catch_warnings():
        warnings.simplefilter("always", Note)
        warnings.showwarning = tell
        yield


def warn_unchecked(why: str) -> None:
    """Say that an answer rests on knowledge that was not checked, if it does."""
    if why:
        warnings.warn(f"unchecked: {why}", Note, stacklevel=2)


def json_line(row: Mapping[str, Any]) -> str:
    """Return a row as one line of JSON, in letters that standard output knows."""
    known = (sys.stdout.encoding or "").lower().replace("-", "") == "utf8"
    return json.dumps(row, ensure_ascii=not known)


def bindings(answer: Mapping[str, Value]) -> str:
    """Return an answer for people, ``F = broken(egg1), T = 0.4-2.0``; of a goal without variables, ``yes``."""
    from prolepsis.terms.terms import format_value

    return ", ".join(f"{name} = {format_value(_rounded(value))}" for name, value in answer.items()) or "yes"


def _rounded(value: Value) -> Value:
    """Return a value with numbers rounded to a microsecond, micrometre or micronewton."""
    from prolepsis.terms.terms import Term

    if isinstance(value, Term):
        return Term(value.functor, tuple(_rounded(argument) for argument in value.args))
    if isinstance(value, tuple):
        return tuple(_rounded(item) for item in value)
    return round(value, 6) if isinstance(value, float) else value


def table(rows: Iterable[Sequence[str]], *, indent: str = "") -> str:
    """Return rows of text in aligned columns, a line each. Columns of numbers stand to the right."""
    kept = [list(row) for row in rows]
    if not kept:
        return ""
    columns = list(zip(*kept, strict=True))
    widths = [max(map(len, column)) for column in columns]
    numeric = [all(_is_number(cell) for cell in column[1:] if cell) and len(column) > 1 for column in columns]
    lines = (
        "  ".join(
            cell.rjust(width) if right else cell.ljust(width)
            for cell, width, right in zip(row, widths, numeric, strict=True)
        )
        for row in kept
    )
    return "\n".join(indent + line.rstrip() for line in lines)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return cell == "-"
    return True

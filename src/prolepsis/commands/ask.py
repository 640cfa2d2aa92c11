"""``prolepsis ask``: answer a Prolog goal from a saved projection."""

from __future__ import annotations

import argparse
import os
from importlib import import_module
from typing import Any

from prolepsis.commands.output import add_command, bindings, json_line, warn_unchecked
from prolepsis.terms.errors import InputError
from prolepsis.terms.json_values import json_value

EXAMPLE = """\
  prolepsis ask out/drop 'holds(F, T), objOf(F, egg1)'
  prolepsis ask out/drop 'occurs(falling(X), T1), after(T2, T1), holds(broken(X), T2)' --json
  prolepsis ask out/drop 'occurs(shattering(X, Y), T)' --chronicles shattering.pl
Times T are intervals Start-End in seconds; a number for T means at that instant.
"""


def add_to(commands: Any) -> None:
    """Add the command and its arguments."""
    parser = add_command(commands, "ask", "answer a Prolog goal from a saved projection", EXAMPLE, run)
    parser.add_argument("folder", metavar="DIR", help="folder that `prolepsis project --out` saved")
    parser.add_argument("goal", metavar="GOAL", help="one goal; exit status 1 if it has no answer")
    parser.add_argument(
        "--json",
        action="store_true",
        help="print one JSON object per answer; an interval is an object with start and end [s]",
    )
    parser.add_argument(
        "--require-confinement",
        action="store_true",
        help="refuse where Prolog cannot be kept from files, programs and the network (doctor tells)",
    )
    parser.add_argument(
        "--chronicles",
        action="append",
        default=[],
        metavar="FILE",
        help="rules chronicle(Event, Start-End) :- Goal whose answers are events too; may be repeated",
    )
    parser.add_argument("--limit", type=int, metavar="N", help="print at most N answers")


def run(given: argparse.Namespace) -> int:
    """Print the answers, one a line; ``no`` and exit status 1 if there is none."""
    if given.limit is not None and given.limit < 1:
        raise InputError(f"--limit {given.limit}: at least 1 answer must be allowed")
    if given.require_confinement:
        os.environ["PROLEPSIS_REQUIRE_CONFINEMENT"] = "1"
    from prolepsis.log.saved import read_timeline
    from prolepsis.logic.session import Session, shared_session

    if given.chronicles:
        # Chronicles may not take the names of actions' events, which are known once the actions have been imported.
        import_module("prolepsis.programs")
    timeline = read_timeline(given.folder)
    session = Session(chronicles=tuple(given.chronicles)) if given.chronicles else shared_session()
    answers = session.ask(timeline, given.goal, limit=given.limit)
    warn_unchecked(timeline.domain.unchecked)
    for answer in answers:
        if given.json:
            print(json_line(json_value(answer)))
        else:
            print(bindings(answer))
    if not answers and not given.json:
        print("no")
    return 0 if answers else 1

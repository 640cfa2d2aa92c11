"""``prolepsis timeline``: what held and occurred in a saved projection, in order of time."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from prolepsis.commands.output import add_command, json_line, table, warn_unchecked

if TYPE_CHECKING:
    from prolepsis.log.timeline import Timeline

EXAMPLE = """\
  prolepsis timeline out/drop
  prolepsis timeline out/drop --json
"""


def add_to(commands: Any) -> None:
    """Add the command and its arguments."""
    parser = add_command(commands, "timeline", "print what held and occurred in a saved projection", EXAMPLE, run)
    parser.add_argument("folder", metavar="DIR", help="folder that `prolepsis project --out` saved")
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object a fact: kind, type, args, start, end, evidence"
    )


def run(given: argparse.Namespace) -> int:
    """Print the facts."""
    from prolepsis.log.saved import read_timeline

    timeline = read_timeline(given.folder)
    warn_unchecked(timeline.domain.unchecked)
    if given.json:
        for row in timeline.to_json():
            print(json_line(row))
    else:
        print(table(rows(timeline)))
    return 0


def rows(timeline: Timeline) -> list[tuple[str, str, str, str, str]]:
    """Return a heading and a row for each fact."""
    from prolepsis.terms.terms import format_value
    from prolepsis.terms.ticks import ticks_of

    decimals = ticks_of(timeline.dt).decimals
    facts = [
        (
            f"{fact.start:.{decimals}f}",
            f"{fact.end:.{decimals}f}",
            fact.kind,
            format_value(fact.term),
            evidence(fact.evidence),
        )
        for fact in timeline.facts
    ]
    return [("start[s]", "end[s]", "kind", "what", "evidence"), *facts]


def evidence(found: Mapping[str, float | str]) -> str:
    """Return evidence in one line, numbers with four digits."""
    return ", ".join(f"{name}={value if isinstance(value, str) else f'{value:.4g}'}" for name, value in found.items())

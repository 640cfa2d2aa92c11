"""``prolepsis project``: simulate a scenario, recognize what happens, save it."""

from __future__ import annotations

import argparse
from typing import Any

from prolepsis.commands.output import add_command, add_progress, progress_line, settings, warn_unchecked

EXAMPLE = """\
  prolepsis project examples/grasp_egg.toml --set Force='20 N' --out out/grasp
  prolepsis project examples/grasp_egg.toml --set force=force7 --set eggshell1.friction=0.3
"""


def add_to(commands: Any) -> None:
    """Add the command and its arguments."""
    parser = add_command(commands, "project", "simulate a scenario, recognize what happens, save it", EXAMPLE, run)
    parser.add_argument("scenario", metavar="SCENARIO.toml", help="situation, plan and parameters")
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="value of a parameter (any case), of seed, draw or particles, or of what is known (individual.property); "
        "may be repeated",
    )
    parser.add_argument("--out", metavar="DIR", help="folder to save in; one that prolepsis wrote is replaced")
    add_progress(parser)


def run(given: argparse.Namespace) -> int:
    """Project and print the timeline's length; with ``--out``, also where it is."""
    chosen = settings(given.set)
    from prolepsis.log.plan_end import plan_end_told
    from prolepsis.projection import project_into, read_scenario

    with progress_line(given.progress) as show:
        result, saved = project_into(read_scenario(given.scenario, chosen), given.out, show)
    warn_unchecked(result.timeline.domain.unchecked)
    facts = len(result.timeline.facts)
    if ended := plan_end_told(result.timeline):
        print(ended)
    where = f", saved in {saved}" if saved else "; give --out DIR to keep them"
    print(f"{result.log.duration:g} s simulated, {facts} facts recognized{where}")
    return 0

"""``prolepsis sweep``: the same scenario at several values, a row each."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from prolepsis.commands.output import (
    add_command,
    add_progress,
    bindings,
    json_line,
    progress_line,
    settings,
    table,
    warn_unchecked,
)
from prolepsis.terms.errors import InputError, Note
from prolepsis.terms.json_values import json_value

if TYPE_CHECKING:
    from prolepsis.campaigns.campaign import Outcomes, Row

EXAMPLE = """\
  prolepsis sweep examples/grasp_egg.toml --over Force=force1,force5,force12
  prolepsis sweep examples/grasp_egg.toml --over Force=0.1,5,60 --refine 4
  prolepsis sweep examples/grasp_egg.toml --over Force=1,5,20,45 --ask 'holds(broken(X), T)'
  prolepsis sweep examples/pr2_split.toml --over seed=1,2,3 --ask 'holds(broken(yolk1), T)'
Of a plan that grasps, each row tells whether the object slips, is held or is crushed, and the table ends with
the forces between which this changes [N]; --refine narrows them down by further runs.
"""
MOST_HALVINGS = 20
"""More would tell levels apart that the simulation does not."""


def add_to(commands: Any) -> None:
    """Add the command and its arguments."""
    parser = add_command(
        commands, "sweep", "project a scenario at several values, and print a row for each", EXAMPLE, run
    )
    parser.add_argument("scenario", metavar="SCENARIO.toml", help="situation, plan and parameters")
    parser.add_argument(
        "--over",
        action="append",
        required=True,
        metavar="NAME=V1,V2,...",
        help="values of a parameter, a knowledge value, particles, seed or draw; several --over: every combination",
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="value that is the same in all"
    )
    parser.add_argument("--ask", metavar="GOAL", help="goal to ask of every run; exit status 1 if all say no")
    parser.add_argument(
        "--refine", type=int, default=0, metavar="N", help="halve the interval of each transition force N times"
    )
    parser.add_argument("--limit", type=int, metavar="N", help="at most N answers a run")
    parser.add_argument("--json", action="store_true", help="print one JSON object a row")
    add_progress(parser)


def run(given: argparse.Namespace) -> int:
    """Print one row a value, then the transitions."""
    if given.limit is not None and given.limit < 1:
        raise InputError(f"--limit {given.limit}: at least 1 answer must be allowed")
    if not 0 <= given.refine <= MOST_HALVINGS:
        raise InputError(f"--refine {given.refine}: between 0 and {MOST_HALVINGS} halvings are allowed")
    over = {name: _values(name, text) for name, text in settings(given.over).items()}
    chosen = settings(given.set)
    from prolepsis.campaigns.campaign import sweep

    with progress_line(given.progress) as show:
        outcomes = sweep(
            given.scenario,
            over,
            ask=given.ask,
            settings=chosen,
            limit=given.limit,
            refine=given.refine,
            progress=show,
        )
    print(as_json(outcomes) if given.json else report(outcomes))
    warn_unchecked(next((row.unchecked for row in outcomes.rows if row.unchecked), ""))
    for note in notes_of(outcomes.rows):
        warnings.warn(note, Note, stacklevel=2)
    if given.traceback:
        for row in outcomes.rows:
            if row.unexpected:
                print(row.unexpected, file=sys.stderr)
    return status_of(outcomes, given.ask)


def report(outcomes: Outcomes) -> str:
    """Return the table of a sweep, and below it the transition forces."""
    names = list(outcomes.rows[0].values)
    grasps = any(row.grasp for row in outcomes.rows)
    levels = any(isinstance(row.grasp.level, str) for row in outcomes.rows if row.grasp)
    head = [*names, *(["force[N]"] if levels else [])]
    head += ["outcome", "slip[mm]", "peak[N]", "bonds broken"] if grasps else ["outcome"]
    rows = [head]
    for row in outcomes.rows:
        cells = [str(row.values[name]) for name in names]
        cells += ([f"{row.level:g}" if row.level is not None else "-"]) if levels else []
        if row.grasp is not None:
            grasp = row.grasp
            cells += [grasp.outcome, f"{1000 * grasp.slip:.2f}", f"{grasp.peak_force:.2f}", str(grasp.bonds_broken)]
        else:
            cells += ["error" if row.error else row.outcome, *(["-"] * 3 if grasps else [])]
        rows.append(cells)
    lines = table(rows).splitlines()
    shown = lines[:1]
    for line, row in zip(lines[1:], outcomes.rows, strict=True):
        shown.append(line)
        shown += [f"  {answer}" for answer in _told(row)]
    shown += [
        f"{each.below.outcome} -> {each.above.outcome}: {each.force:.3g} +-{(each.high - each.low) / 2:.2g} N "
        f"(between {each.low:.4g} and {each.high:.4g} N)"
        for each in outcomes.transitions()
    ]
    asked = [row for row in outcomes.rows if row.answers is not None]
    if asked:
        shown.append(f"{sum(bool(row.answers) for row in asked)} of {len(asked)} runs have an answer")
    return "\n".join(shown)


def notes_of(rows: Sequence[Row]) -> list[str]:
    """Return the notes on the runs of a sweep, each with the values of the runs that it is about."""
    about: dict[str, list[str]] = {}
    for row in rows:
        for note in row.notes:
            about.setdefault(note, []).append(", ".join(f"{name}={value}" for name, value in row.values.items()))
    return [f"{'; '.join(runs)}: {note}" for note, runs in about.items()]


def _told(row: Row) -> list[str]:
    if row.error:
        return [row.error]
    if row.answers is None:
        return []
    return [bindings(answer) for answer in row.answers] or ["no"]


def as_json(outcomes: Outcomes) -> str:
    """Return one JSON object a row."""
    return "\n".join(json_line(_plain(row)) for row in outcomes.rows)


def _plain(row: Row) -> dict[str, Any]:
    result: dict[str, Any] = {"values": dict(row.values)}
    if row.grasp is not None:
        grasp = row.grasp
        result |= {
            "level": grasp.level,
            "force": row.level,
            "outcome": grasp.outcome,
            "slip": grasp.slip,
            "peak_force": grasp.peak_force,
            "bonds_broken": grasp.bonds_broken,
        }
    if row.answers is not None:
        result["answers"] = [{name: json_value(value) for name, value in answer.items()} for answer in row.answers]
    if row.notes:
        result["notes"] = list(row.notes)
    if row.error is not None:
        result["error"] = row.error
    return result


def status_of(outcomes: Outcomes, goal: str | None) -> int:
    """Return 0 if any run was answered, 1 if all said no; else runs failed: 4, 3 or 2, by the worst of the failures."""
    failed = [row for row in outcomes.rows if row.error is not None]
    if any(row.answers if goal is not None else row.error is None for row in outcomes.rows):
        return 0
    if not failed:
        return 1
    if any(row.unexpected for row in failed):
        return 4
    return 3 if any(row.invalid for row in failed) else 2


def _values(name: str, text: str) -> list[str]:
    values = [value.strip() for value in text.split(",")]
    if not all(values):
        raise InputError(f"--over {name}={text}: a value between two commas is missing")
    return values

"""``prolepsis timeline``: what held and occurred in a saved projection, in order of time."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING, Any

from prolepsis.commands.output import add_command, json_line, table, warn_unchecked
from prolepsis.system.cache import note
from prolepsis.terms.errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from prolepsis.log.timeline import Fact, Timeline

EXAMPLE = """\
  prolepsis timeline out/drop
  prolepsis timeline out/drop --about egg1 --type breaking --type broken
  prolepsis timeline out/drop --from 0.6 --to 0.7 --all
  prolepsis timeline out/drop --near
  prolepsis timeline out/drop --json
Facts about many like things are told as one: contacts([12 parts of eggshell1],floor). What is alike is read off
what the things are: parts of one whole, and things of the same classes and mass.
"""


def add_to(commands: Any) -> None:
    """Add the command and its arguments."""
    parser = add_command(commands, "timeline", "print what held and occurred in a saved projection", EXAMPLE, run)
    parser.add_argument("folder", metavar="DIR", help="folder that `prolepsis project --out` saved")
    parser.add_argument(
        "--all", action="store_true", help="print each fact by itself, also those about many like things"
    )
    parser.add_argument(
        "--about",
        action="append",
        default=[],
        metavar="NAME",
        help="only facts about this thing or a part of it; repeated: about all of them",
    )
    parser.add_argument(
        "--type", action="append", default=[], metavar="TYPE", help="only facts of this type; repeated: of any of them"
    )
    parser.add_argument(
        "--from",
        dest="begin",
        type=_time,
        default=-math.inf,
        metavar="S",
        help="only facts that end after this time [s]",
    )
    parser.add_argument(
        "--to", dest="end", type=_time, default=math.inf, metavar="S", help="only facts that start before this time [s]"
    )
    parser.add_argument(
        "--near",
        action="store_true",
        help="only what lies within a fifth of its threshold, and what did not come about but nearly (kind: nearly)",
    )
    parser.add_argument(
        "--json",
        action="store_true",
        help="print one JSON object a fact, never folded: kind, type, args, start, end, evidence",
    )


def run(given: argparse.Namespace) -> int:
    """Print the facts."""
    from prolepsis.log.saved import read_timeline
    from prolepsis.log.timeline import plain

    if not given.begin < given.end:
        raise InputError(f"--from {given.begin:g} --to {given.end:g}: the first must be less than the second")
    timeline = selected(read_timeline(given.folder), given.about, given.type, given.begin, given.end)
    warn_unchecked(timeline.domain.unchecked)
    if given.near:
        timeline = _near(timeline)
    if given.json:
        for row in timeline.to_json():
            print(json_line(row))
        for fact in timeline.near_misses if given.near else ():
            print(json_line({**plain(fact), "nearly": True}))
    else:
        shown = rows(timeline, all=given.all)
        if given.near:
            nearly = rows(replace(timeline, facts=timeline.near_misses), all=given.all)[1:]
            shown += [(start, end, "nearly", what, evidence) for start, end, _, what, evidence in nearly]
        print(table(shown))
    if not timeline.facts and not (given.near and timeline.near_misses):
        note(f"none of what is chosen is so; the log lasts {timeline.duration:g} s")
    return 0


def _near(timeline: Timeline) -> Timeline:
    """Return the timeline with only the facts that lie near their threshold."""
    from prolepsis.log.near import is_near

    return replace(timeline, facts=tuple(fact for fact in timeline.facts if is_near(fact.evidence)))


def _time(text: str) -> float:
    """Return a time with or without its unit [s]."""
    from prolepsis.terms.units import read_quantity

    try:
        return float(text)
    except ValueError:
        read = read_quantity(text)
    if read is None or read[1] != "s":
        raise argparse.ArgumentTypeError(f"{text!r} is no time; allowed: seconds, as 0.5 or '0.5 s'")
    return read[0]


def selected(timeline: Timeline, names: Sequence[str], types: Sequence[str], begin: float, end: float) -> Timeline:
    """Return the timeline with only the facts about all of the things, of any of the types, within the times [s].

    Raises:
        UnknownNameError: If a name or a type occurs nowhere.
    """
    from prolepsis.log.folding import about

    known = {name for name, _ in timeline.domain.instances}
    known |= {each for fact in timeline.facts for each in fact.args if isinstance(each, str) and each[:1] != "["}
    for name in names:
        if name not in known:
            raise UnknownNameError.of("thing", name, known, "--about")
    wanted = {_type(timeline, each) for each in types}
    things = [about(timeline, name) for name in names]

    def is_wanted(fact: Fact) -> bool:
        of_them = all(any(each in within for each in fact.args) for within in things)
        return (not wanted or fact.type in wanted) and of_them and begin < fact.end and fact.start < end

    facts, nearly = filter(is_wanted, timeline.facts), filter(is_wanted, timeline.near_misses)
    return replace(timeline, facts=tuple(facts), near_misses=tuple(nearly))


def _type(timeline: Timeline, given: str) -> str:
    name = given[:1].lower() + given[1:]
    known = {fact.type for fact in timeline.facts}
    if name not in known:
        # Takes a moment, and is needed only to tell what did not happen from what cannot.
        import_module("prolepsis.programs")
        from prolepsis.fluents import fact_types

        known |= set(fact_types())
        if name not in known:
            raise UnknownNameError.of("type", given, known, "--type")
    return name


def rows(timeline: Timeline, *, all: bool = False) -> list[tuple[str, str, str, str, str]]:
    """Return a heading and a row for each fact, or for facts about many like things unless ``all`` are wanted."""
    from prolepsis.log.folding import fold, tell
    from prolepsis.terms.ticks import ticks_of

    told = [tell(fact) for fact in timeline.facts] if all else fold(timeline.facts, timeline.domain)
    decimals = ticks_of(timeline.dt).decimals
    facts = [
        (f"{each.start:.{decimals}f}", f"{each.end:.{decimals}f}", each.kind, each.what, each.evidence) for each in told
    ]
    return [("start[s]", "end[s]", "kind", "what", "evidence"), *facts]

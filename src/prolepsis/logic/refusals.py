"""Why a goal was refused, said to someone who does not know Prolog yet: what, where, and what is allowed."""

from __future__ import annotations

import difflib
import re

from prolepsis.log.timeline import Timeline
from prolepsis.logic.process import STACK_LIMIT
from prolepsis.logic.syntax import INSTEAD, syntax_error
from prolepsis.logic.unknown_names import OTHERWISE, a_kind, nearest, unknown_name
from prolepsis.terms.errors import GoalError, GoalLimitError, brief

PERMITTED = (
    "a query only reads the timeline and computes, with what docs/queries.md lists; it may not print, change facts, "
    "reach files or start programs"
)
RELATIONS = (
    "before, after, meets, met_by, overlaps, overlapped_by, starts, started_by, during, contains, "
    "finishes, finished_by, equals"
)
COMPUTES = re.compile(r"[\d)][+*/]|\)-|-\(")
"""What stands for a time, and is to be computed."""
NO_NUMBERS = {"1.5NaN": "nan", "1.0Inf": "inf", "-1.0Inf": "-inf"}
"""How a goal writes what Prolog prints so."""
NO_FUNCTION = re.compile(r"Arithmetic: `(.*)/0' is not a function")
OTHER_WORDS = {
    "is_a": "instance_of(Individual, Class)",
    "type": "instance_of(Individual, Class)",
    "part_of": "has_part(Whole, Part)",
    "count": "aggregate_all(count, Goal, N)",
    "happens": "occurs(Event, T)",
    "happened": "occurs(Event, T)",
    "precedes": "before(I, J)",
    "follows": "after(I, J)",
    "duration": "holds(Fluent, S-E), D is E-S",
    "start": "holds(Fluent, S-E), where S is the start",
    "end": "holds(Fluent, S-E), where E is the end",
    "object": "objOf(FluentOrEvent, Object)",
}
"""What is asked otherwise here than elsewhere."""
SHOWN = 120
"""Characters of a goal that a message shows."""


def shown(goal: str) -> str:
    """Return a goal as messages quote it."""
    return repr(brief(goal, SHOWN))


def refusal(status: str, body: str, goal: str, time_limit: float, timeline: Timeline) -> GoalError:
    """Return the error for a goal that was refused.

    Args:
        status: First line of the reply: the kind of refusal.
        body: The other lines: what it is about.
        goal: The goal as it was asked.
        time_limit: Its time limit [s].
        timeline: What it was asked about.
    """
    match status:
        case "syntax":
            position, message, known = body.split("\n")
            return GoalError(f"{syntax_error(int(position), message, goal, known.split(chr(9)))}: {shown(goal)}")
        case "predicate":
            name, known = body.split("\n", 1)
            return GoalError(f"unknown predicate {brief(name)}; {_nearest(name, known.split(chr(9)), timeline)}")
        case "name":
            return GoalError(unknown_name(body))
        case "relation":
            return GoalError(f"unknown relation {brief(body)!r}; known: {RELATIONS}")
        case "permission":
            return GoalError(f"not permitted: {brief(body)}: {PERMITTED}")
        case "module":
            return GoalError(f"not permitted: {brief(body)}: a predicate is called without the name of its module")
        case "goal":
            return GoalError(
                f"not a goal: {brief(body)}; a goal is a predicate with arguments, such as holds(Fluent, T)"
            )
        case "unbound":
            return GoalError(f"not permitted: a goal that is known only when the query runs: {shown(goal)}")
        case "related":
            asked = OTHERWISE.get(body, f"holds({brief(body)}(X, Y), T)")
            return GoalError(f"{brief(body)} is a relation and no value; ask {asked}")
        case "number":
            name, unit, value = body.split("\n")
            return GoalError(f"{name} is a number{f' [{unit}]' if unit != '1' else ''}, not {brief(value)}")
        case "list":
            return GoalError(f"not a list: {brief(body)}; arguments are a list, as [{brief(body)}]")
        case "other":
            name, kind, other = body.split("\n")
            return GoalError(f"{brief(name)} is {a_kind(other)}, no {kind}; ask {other}T(X, {brief(name)})")
        case "computed":
            told = "gives an interval and no number to compare; write S-E for it, and compare S, E or E-S, its length"
            return GoalError(f"{brief(body)} {told}")
        case "interval":
            told = "an interval is Start-End, with Start before End; holds and occurs take a number, an instant, too"
            told += f"; compute it first: T is {brief(body)}" if COMPUTES.search(body) else ""
            return GoalError(f"not an interval: {brief(body)}; {told}")
        case "instant":
            told = "a time is a finite number of seconds, or an interval Start-End"
            return GoalError(f"not a time: {NO_NUMBERS.get(body, brief(body))}; {told}")
        case "time":
            return GoalLimitError(f"time limit of {time_limit:g} s reached: {shown(goal)}")
        case "memory":
            return GoalLimitError(f"memory limit of {STACK_LIMIT} MB reached: {shown(goal)}")
        case "much":
            return GoalLimitError(f"the answers have more than {int(body):,} characters; set a limit: {shown(goal)}")
        case "error" if found := NO_FUNCTION.match(body):
            return GoalError(f"{brief(found[1])} is computed with, and is no number: {shown(goal)}")
        case "error" if "not sufficiently instantiated" in body:
            return GoalError(
                f"a value is needed before it is known; give it, or put the goals that find it first: {shown(goal)}"
            )
        case _:
            return GoalError(f"{brief(body.strip() or status, 120)}: {shown(goal)}")


def _nearest(name: str, known: list[str], timeline: Timeline) -> str:
    plain = name.rpartition("/")[0]
    types = {fact.type: fact.kind for fact in timeline.facts}
    if plain in types:
        asked = "holds" if types[plain] == "fluent" else "occurs"
        arguments = next(len(fact.args) for fact in timeline.facts if fact.type == plain)
        pattern = f"{plain}({', '.join('XYZUVW'[:arguments])})" if arguments else plain
        return f"{plain} is a type of {types[plain]}; ask {asked}({pattern}, T)"
    if plain.strip("()") in INSTEAD:
        return f"{plain.strip('()')} is written {INSTEAD[plain.strip('()')]}"
    if plain in OTHER_WORDS:
        return f"ask {OTHER_WORDS[plain]}"
    if plain in ("(:-)", "(-->)"):
        return "a query is one goal; rules are added as chronicles, see docs/queries.md"
    if plain == "('|')":
        return "either of two goals is asked with ;"
    near = nearest(name, [each for each in known if each.rpartition("/")[2] == name.rpartition("/")[2]])
    near = near or difflib.get_close_matches(name, known, n=1, cutoff=0.75)
    if near:
        return f"did you mean {near[0]}?"
    alike = difflib.get_close_matches(plain, list(types), n=1, cutoff=0.75)
    if alike:
        kind = types[alike[0]]
        return f"did you mean the {kind} {alike[0]}, asked by {'holds' if kind == 'fluent' else 'occurs'}/2?"
    return "see docs/queries.md; among others: holds/2, occurs/2, fluentT/2, eventT/2, argsOf/2, objOf/2, allen/3"

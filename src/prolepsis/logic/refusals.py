"""Why a goal was refused, said to someone who does not know Prolog yet: what, where, and what is allowed."""

from __future__ import annotations

import difflib
import re

from prolepsis.log.timeline import Timeline
from prolepsis.logic.process import STACK_LIMIT
from prolepsis.logic.unknown_names import unknown_name
from prolepsis.terms.errors import GoalError, GoalLimitError, brief

PERMITTED = (
    "a query only reads the timeline and computes, with what docs/queries.md lists; it may not print, change facts, "
    "reach files or start programs"
)
RELATIONS = (
    "before, after, meets, met_by, overlaps, overlapped_by, starts, started_by, during, contains, "
    "finishes, finished_by, equals"
)
SYNTAX = {
    "operator expected": "two terms stand side by side; between them a comma, an operator or a bracket is missing",
    "operator clash": "these operators cannot be combined without brackets",
    "operator balance": "an operator lacks what it should stand between",
    "end of clause": "the goal ends too early, or a full stop stands within it",
    "end of clause expected": "the goal should end here; is an opening bracket missing?",
    "cannot start term": "no term can begin here; a bracket or a comma is too many",
    "illegal start of term": "no term can begin here; a bracket or a comma is too many",
    "end of file in quoted": "a quoted name has no closing quote",
    "end of file in block comment": "a comment has no closing */",
    "undefined char escape": "no such escape after a backslash; a backslash itself is written twice",
    "punct": "a bracket or a comma stands where a term should",
}
"""What SWI-Prolog's messages mean."""
SHOWN = 120
"""Characters of a goal that a message shows."""
_CALL = re.compile(r"(\w+)\s*\(")


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
            position, message = body.split("\n", 1)
            return GoalError(_syntax(int(position), message, goal))
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
        case "compared":
            return GoalError(
                f"{brief(body)} gives an interval and no number to compare; write S-E for it, and compare S or E"
            )
        case "interval":
            return GoalError(f"not an interval: {brief(body)}; an interval is Start-End, with Start before End")
        case "time":
            return GoalLimitError(f"time limit of {time_limit:g} s reached: {shown(goal)}")
        case "memory":
            return GoalLimitError(f"memory limit of {STACK_LIMIT} MB reached: {shown(goal)}")
        case "much":
            return GoalLimitError(f"the answers have more than {int(body):,} characters; set a limit: {shown(goal)}")
        case "error" if "not sufficiently instantiated" in body:
            return GoalError(
                f"a value is needed before it is known; give it, or put the goals that find it first: {shown(goal)}"
            )
        case _:
            return GoalError(f"{brief(body.strip() or status, 120)}: {shown(goal)}")


def _syntax(position: int, message: str, goal: str) -> str:
    position = min(position, len(goal))
    line, column = goal.count("\n", 0, position) + 1, position - (goal.rfind("\n", 0, position) + 1) + 1
    at = f"column {column}" if "\n" not in goal else f"line {line}, column {column}"
    meaning = next((text for known, text in SYNTAX.items() if message.startswith(known)), "")
    call = _CALL.search(goal, max(0, goal.rfind("(", 0, position) + 1))
    if message == "operator expected" and call and call.end() - 2 <= position < call.end():
        name = call.group(1)
        if name[0].isupper() or name[0] == "_":
            small = name.lstrip("_")
            meaning = f"a predicate's name begins with a small letter, and {name} is a variable"
            meaning += f"; write {small[0].lower()}{small[1:]}(" if small else ""
    told = f"{message}: {meaning}" if meaning else message
    return f"syntax error at {at}: {told}: {shown(goal)}"


def _nearest(name: str, known: list[str], timeline: Timeline) -> str:
    plain = name.rpartition("/")[0]
    types = {fact.type: fact.kind for fact in timeline.facts}
    if plain in types:
        asked = "holds" if types[plain] == "fluent" else "occurs"
        arguments = next(len(fact.args) for fact in timeline.facts if fact.type == plain)
        pattern = f"{plain}({', '.join('XYZUVW'[:arguments])})" if arguments else plain
        return f"{plain} is a type of {types[plain]}; ask {asked}({pattern}, T)"
    if plain in ("(:-)", "(-->)"):
        return "a query is one goal; rules are added as chronicles, see docs/queries.md"
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.75)
    if near:
        return f"did you mean {near[0]}?"
    alike = difflib.get_close_matches(plain, list(types), n=1, cutoff=0.75)
    if alike:
        kind = types[alike[0]]
        return f"did you mean the {kind} {alike[0]}, asked by {'holds' if kind == 'fluent' else 'occurs'}/2?"
    return "see docs/queries.md; among others: holds/2, occurs/2, fluentT/2, eventT/2, argsOf/2, objOf/2, allen/3"

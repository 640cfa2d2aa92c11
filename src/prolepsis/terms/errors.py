"""The exception tree: everything that prolepsis refuses, and nothing else.

::

    ProlepsisError                 anything below; the command line prints one line and exits
     ├── InputError                what the user gave is wrong (exit status 2)
     │    ├── UnknownNameError     a name that is not known; the message lists the known ones
     │    ├── KnowledgeError       ontology or situation: syntax, units, values, structure
     │    │    ├── InconsistentError   the axioms clash; the few that do are named
     │    │    └── UndecidedError      the reasoner ran out of time
     │    ├── ScenarioError        scenario file: syntax, missing or extra keys
     │    ├── PlanError            a plan that cannot be read or carried out
     │    ├── GoalError            a query: syntax, unknown predicate, not permitted
     │    │    └── GoalLimitError  the query ran out of time or memory
     │    └── LogError             a log folder that is truncated, altered or not one
     ├── InvalidSimulationError    the physics went unstable, or through a wall; the run is no answer (exit status 3)
     └── MissingToolError          something outside Python is absent; how to get it (exit status 2)

A message is one line: what was wrong, where, and what is allowed. ``brief`` shortens a value that it shows.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable

LONGEST_LINE = 300
"""Most characters of a line that tells of an error; more would not be read."""
LONGEST_VALUE = 60
"""Most characters of a value that is shown in one."""
LONGEST_LIST = 140
"""Most characters of a list of what is known."""


def brief(value: object, most: int = LONGEST_VALUE) -> str:
    """Return a value as a message shows it: in printable characters, and shortened in the middle if it is long."""
    try:
        text = str(value)
    except ValueError:
        return "an integer of thousands of digits"  # Python writes none that is longer than 4300
    if len(text) > 2 * most:
        text = text[:most] + " ... " + text[-most:]
    text = "".join(each if each.isprintable() else ascii(each)[1:-1] for each in text)
    if len(text) <= most:
        return text
    left = (most - 5) // 2
    return text[:left] + " ... " + text[left + 5 - most :]


def brief_list(names: Iterable[str], most: int = LONGEST_LIST) -> str:
    """Return names for a message, in their order and as many as fit; ``none`` if there are none."""
    shown: list[str] = []
    for name in map(brief, names):
        most -= len(name) + 2
        if most < 0 and shown:
            return ", ".join([*shown, "..."])
        shown.append(name)
    return ", ".join(shown) or "none"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a question for a message, after what the nearest known name is; empty if none is near."""
    if len(name) > LONGEST_VALUE:
        return ""
    known = [*known]
    # Letters of another size, and underscores between words, are what is mistaken most often.
    plain = {_plain(each): each for each in reversed(known)}
    near = [_plain(name)] if _plain(name) in plain else difflib.get_close_matches(name, known, n=1)
    near = near or difflib.get_close_matches(_plain(name), [*plain], n=1)
    return f"; did you mean {brief(repr(plain.get(near[0], near[0])))}?" if near else ""


def _plain(name: str) -> str:
    return name.replace("_", "").lower()


def error_line(error: object, most: int = LONGEST_LINE) -> str:
    """Return an error as one line of at most ``most`` characters."""
    return brief(" ".join(str(error).split()), most)


class ProlepsisError(Exception):
    """Base of every error that prolepsis raises on purpose."""


class InputError(ProlepsisError):
    """What the user gave is wrong."""


class UnknownNameError(InputError):
    """A name that is not known."""

    @classmethod
    def of(cls, what: str, name: str, known: Iterable[str], where: str = "") -> UnknownNameError:
        """Return the error for an unknown ``name``, with the nearest and all known names.

        Args:
            what: What the name should have named, such as ``"object"``.
            name: The name that was given.
            known: The names that would have been right.
            where: Where it was given, such as a file and line.
        """
        names = sorted(known)
        prefix = f"{where}: " if where else ""
        told = f"{prefix}no {what} named {brief(repr(name))}{did_you_mean(name, names)}; known: "
        # What is near is told in any case; of the others as many as there is room for in a line.
        room = LONGEST_LINE - len("prolepsis: ") - len(told) - len(", ...")
        return cls(told + brief_list(names, min(LONGEST_LIST, max(room, 20))))


class KnowledgeError(InputError):
    """The ontology or the situation is wrong."""


class InconsistentError(KnowledgeError):
    """The knowledge base contradicts itself; ``conflict`` has all that clashes, also where the line has not."""

    def __init__(self, message: str, conflict: tuple[str, ...] = ()) -> None:
        """Keep the line, and what clashes: each as a person would say it, with where it is said."""
        super().__init__(message)
        self.conflict = conflict

    def __reduce__(self) -> tuple[type[InconsistentError], tuple[str, tuple[str, ...]]]:
        """Travel whole from one process to another."""
        return type(self), (str(self), self.conflict)


class UndecidedError(KnowledgeError):
    """The reasoner ran out of time; a knowledge base that is loaded says so in ``unchecked`` instead."""


class ScenarioError(InputError):
    """The scenario file is wrong."""


class PlanError(InputError):
    """The plan cannot be read or carried out."""


class GoalError(InputError):
    """The query is wrong or not permitted."""


class GoalLimitError(GoalError):
    """The query used up its time or memory."""


class LogError(InputError):
    """The log folder is not whole."""


class InvalidSimulationError(ProlepsisError):
    """The physics went unstable, or something through solid matter, so there is no answer."""


class MissingToolError(ProlepsisError):
    """A program or library outside Python is missing."""


class Note(UserWarning):
    """What a user should know of an answer that is given all the same."""

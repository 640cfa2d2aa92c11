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
     ├── InvalidSimulationError    the physics went unstable; the run is no answer (exit status 3)
     └── MissingToolError          something outside Python is absent; how to get it (exit status 2)
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable


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
        near = difflib.get_close_matches(name, names, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        place = f"{where}: " if where else ""
        shown = ", ".join(names[:40]) + (", ..." if len(names) > 40 else "") or "none"
        return cls(f"{place}no {what} named {name!r}{hint}; known: {shown}")


class KnowledgeError(InputError):
    """The ontology or the situation is wrong."""


class InconsistentError(KnowledgeError):
    """The knowledge base contradicts itself."""


class UndecidedError(KnowledgeError):
    """The reasoner ran out of time, so it is not known whether the knowledge base contradicts itself."""


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
    """The physics went unstable, so there is no answer."""


class MissingToolError(ProlepsisError):
    """A program or library outside Python is missing."""


class Note(UserWarning):
    """What a user should know of an answer that is given all the same."""

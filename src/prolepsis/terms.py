"""Terms: the one notation for plans, actions, fluents, events and answers (Prolog's).

An atom is a ``str``, a number an ``int`` or ``float``, a list a ``tuple``, a variable a ``Variable``,
anything else a ``Term``.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Variable:
    """A named placeholder, ``Force``."""

    name: str
    """Begins with an upper-case letter or ``_``."""


@dataclass(frozen=True, slots=True)
class Term:
    """A functor with arguments, ``grasp(hand1, egg1, 20)``. Without arguments, use a ``str``."""

    functor: str
    """Name of the relation, action or function."""
    args: tuple[Value, ...] = ()
    """Arguments."""


Value = Term | Variable | str | int | float | tuple["Value", ...]

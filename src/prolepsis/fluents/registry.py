"""Every fluent and event that can be recognized, by name: what it means and how it is found in a log."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

from prolepsis.fluents.observation import Observation
from prolepsis.log.timeline import Fact
from prolepsis.terms.errors import InputError

Grounding = Callable[[Observation], Iterable[Fact]]


@dataclass(frozen=True, kw_only=True, slots=True)
class FactType:
    """One kind of fact."""

    name: str
    """Lower camel case, ``closingGripper``."""
    kind: Literal["fluent", "event"]
    """``fluent`` for a condition, ``event`` for what happens."""
    arguments: tuple[str, ...]
    """Names of the arguments, for people."""
    doc: str
    """One line that says when it holds."""
    grounding: Grounding
    """Finds its facts in a log (one of its groundings, if solids and stuffs have their own)."""


FLUENTS: dict[str, FactType] = {}
"""Conditions, by name."""
EVENTS: dict[str, FactType] = {}
"""What happens, by name."""
GROUNDINGS: list[Grounding] = []
"""All groundings; a fact type may have several, one for solids and one for stuffs."""


def fluent(name: str, *arguments: str) -> Callable[[Grounding], Grounding]:
    """Register the decorated function as the grounding of a fluent; its first line of documentation describes it."""
    return _registration(FLUENTS, "fluent", name, arguments)


def event(name: str, *arguments: str) -> Callable[[Grounding], Grounding]:
    """Register the decorated function as the grounding of an event; its first line of documentation describes it."""
    return _registration(EVENTS, "event", name, arguments)


def _registration(
    table: dict[str, FactType], kind: Literal["fluent", "event"], name: str, arguments: tuple[str, ...]
) -> Callable[[Grounding], Grounding]:
    def register(grounding: Grounding) -> Grounding:
        if any(g.__module__ == grounding.__module__ and g.__qualname__ == grounding.__qualname__ for g in GROUNDINGS):
            raise InputError(f"{kind} {name}: {grounding.__qualname__} is registered already")
        doc = (grounding.__doc__ or "").strip().split("\n")[0]
        known = table.setdefault(
            name, FactType(name=name, kind=kind, arguments=arguments, doc=doc, grounding=grounding)
        )
        if known.arguments != arguments:
            raise InputError(f"{kind} {name}: arguments {arguments}, but elsewhere {known.arguments}")
        GROUNDINGS.append(grounding)
        return grounding

    return register

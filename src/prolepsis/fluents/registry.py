"""How fluents and events are found in a log: the groundings, each registered with the type that it finds."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from prolepsis.fluents.margins import NearMiss
from prolepsis.fluents.observation import Observation
from prolepsis.log.fact_types import EVENTS, FLUENTS, FactType
from prolepsis.log.timeline import Fact, Kind
from prolepsis.terms.errors import InputError, UnknownNameError

Grounding = Callable[[Observation], Iterable[Fact | NearMiss]]

GROUNDINGS: list[Grounding] = []
"""All groundings; a fact type may have several, one for solids and one for stuffs."""


def fluent(name: str, *arguments: str) -> Callable[[Grounding], Grounding]:
    """Register the decorated function as the grounding of a fluent; its first line of documentation describes it."""
    return _registration(FLUENTS, "fluent", name, arguments)


def event(name: str, *arguments: str, action: str | None = None) -> Callable[[Grounding], Grounding]:
    """Register the decorated function as the grounding of an event; its first line of documentation describes it.

    Args:
        name: Type of the event.
        arguments: Names of its arguments.
        action: Name of an action whose event it is, which then is on the timeline only as it is found.
    """
    return _registration(EVENTS, "event", name, arguments, action)


def check_declared(kind: str, name: str, count: int) -> None:
    """Check that a fact which a grounding found, with ``count`` arguments, is declared.

    Raises:
        UnknownNameError: If nothing of that kind has its name.
        InputError: If it has another number of arguments.
    """
    known = FLUENTS if kind == "fluent" else EVENTS
    if name not in known:
        raise UnknownNameError.of(kind, name, known, "a grounding finds what is not declared")
    declared = known[name].arguments
    if len(declared) != count:
        raise InputError(f"a grounding finds {name} with {count} arguments; declared: {name}({', '.join(declared)})")


def _registration(
    table: dict[str, FactType], kind: Kind, name: str, arguments: tuple[str, ...], action: str | None = None
) -> Callable[[Grounding], Grounding]:
    def register(grounding: Grounding) -> Grounding:
        if any(g.__module__ == grounding.__module__ and g.__qualname__ == grounding.__qualname__ for g in GROUNDINGS):
            raise InputError(f"{kind} {name}: {grounding.__qualname__} is registered already")
        doc = (grounding.__doc__ or "").strip().split("\n")[0]
        known = table.setdefault(name, FactType(name=name, kind=kind, arguments=arguments, doc=doc, action=action))
        if known.arguments != arguments:
            raise InputError(f"{kind} {name}: arguments {arguments}, but elsewhere {known.arguments}")
        GROUNDINGS.append(grounding)
        return grounding

    return register

"""One value as it is written, in Turtle or in a setting, is checked against its property and becomes an SI value."""

from __future__ import annotations

from rdflib import BNode, Literal, URIRef
from rdflib.term import Node

from prolepsis.knowledge.turtle import local_name
from prolepsis.knowledge.vocabulary import Property
from prolepsis.terms.errors import InputError, KnowledgeError, brief
from prolepsis.terms.units import read_quantity, to_si


def read_value(entry: Property, node: Node | str | float, *, where: str) -> float | str:
    """Return a value as it is written in SI units, checked against the bounds of its property.

    Args:
        entry: The property.
        node: A Turtle literal or IRI, a number in the property's unit, or a text such as ``"58 g"``.
        where: File, line and subject, for the message.

    Raises:
        KnowledgeError: If it is not of the right kind, or outside the bounds.
    """
    if entry.kind == "relation":
        if isinstance(node, (Literal, BNode)):
            raise KnowledgeError(f"{where}: {entry.name} must name an individual, not {brief(repr(str(node)))}")
        return local_name(node) if isinstance(node, URIRef) else str(node)
    if isinstance(node, (URIRef, BNode)):
        raise KnowledgeError(f"{where}: {entry.name} must be a value, not {brief(repr(local_name(URIRef(str(node)))))}")
    text = str(node).strip()
    if entry.kind == "truth":
        if text.lower() not in ("true", "false", "1", "0"):
            raise KnowledgeError(f"{where}: {entry.name} must be true or false, not {brief(repr(text))}")
        return "true" if text.lower() in ("true", "1") else "false"
    if entry.kind == "text":
        return text
    read = read_quantity(text)
    if read is None:
        raise KnowledgeError(f"{where}: {entry.name} must be a number, with or without a unit, not {brief(repr(text))}")
    number, unit = read
    if unit.startswith(","):
        raise KnowledgeError(f"{where}: {entry.name} = {brief(repr(text))}: decimals are behind a point, as in 1.5")
    try:
        value = to_si(number, unit or entry.unit, entry.unit)
    except InputError as error:
        raise KnowledgeError(f"{where}: {entry.name} = {brief(repr(text))}: {error}") from error
    return _bounded(entry, value, text, where)


def _bounded(entry: Property, value: float, text: str, where: str) -> float:
    finite = value - value == 0.0
    if not finite or not entry.admits(value):
        allowed = f" and {entry.bounds}" if entry.bounds else ""
        raise KnowledgeError(f"{where}: {entry.name} = {brief(text)}: must be finite{allowed}")
    return value

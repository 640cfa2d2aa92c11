"""What a situation says must make sense before anything is built: what is on, in or full of what."""

from __future__ import annotations

from collections.abc import Collection

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.scene.shapes import EXTENTS
from prolepsis.terms.errors import KnowledgeError, brief_list

HOLDING = {"contains": "be in", "absorbs": "be soaked up by"}
"""Relations from what holds to what is held, and how that is said of what is held."""
ANGLES = ("yaw", "pitch", "roll")
"""How a thing is turned, in the order in which it is."""


def refuse_nonsense(kb: KnowledgeBase, bodies: Collection[str]) -> None:
    """Refuse a situation that says of things what cannot be so; ``bodies`` are the wholes that are solid.

    Raises:
        KnowledgeError: With the file and line of what is wrong, and what is allowed.
    """
    if not kb.objects:
        raise KnowledgeError("the situation names no physical object; state at least one, such as :floor a :Floor")
    for relation, subject, host in kb.relations():
        if relation == "comprises":
            raise KnowledgeError(
                f"{kb.location(subject)}: {subject} comprises {host}: how is not said; state :hasPart or :contains"
            )
        if relation == "on":
            _refuse_host(kb, subject, host, "be on", bodies)
        elif relation in HOLDING:
            _refuse_host(kb, host, subject, HOLDING[relation], bodies)
            if relation == "contains" and not kb.is_a(subject, "Container"):
                known = brief_list(name for name in sorted(bodies) if kb.is_a(name, "Container"))
                raise KnowledgeError(
                    f"{kb.location(host)}: {host} cannot be in the {kb.kind(subject)} {subject}, which has no cavity; "
                    f"needed: a Container, such as what is told to be a Vessel; known: {known}"
                )


def _refuse_host(kb: KnowledgeBase, name: str, host: str, how: str, bodies: Collection[str]) -> None:
    if name == host:
        raise KnowledgeError(f"{kb.location(name)}: {name} cannot {how} itself")
    if host not in bodies:
        what = f"the {kb.kind(host)} {host}" if host in kb.objects else host
        known = brief_list(sorted({*bodies} - {name}))
        raise KnowledgeError(
            f"{kb.location(name)}: {name} cannot {how} {what}; needed: a whole that is solid, as {known}"
        )


def refuse_shaped(kb: KnowledgeBase, flowing: Collection[str]) -> None:
    """Refuse a shape, an extent, an angle or a height of what flows: it has none of its own.

    Raises:
        KnowledgeError: With the file and line of what is wrong.
    """
    for name in flowing:
        for prop in ("shape", "file", *sorted(EXTENTS), *ANGLES, "z"):
            for said in kb.situation.said.get((name, prop), ())[:1]:
                raise KnowledgeError(
                    f"{said.where}: {name} ({kb.kind(name)}) has no {prop} of its own: it is as what holds it"
                )


def refuse_placed(kb: KnowledgeBase, flowing: Collection[str]) -> None:
    """Refuse a place of a part, which is where its whole has it; the bodies of a stuff have places of their own.

    Raises:
        KnowledgeError: With the file and line of what is wrong.
    """
    for name in kb.objects:
        whole = kb.whole(name)
        for prop in ("x", "y", "z", *ANGLES, "on") if whole is not None and whole not in flowing else ():
            for said in kb.situation.said.get((name, prop), ())[:1]:
                raise KnowledgeError(
                    f"{said.where}: {name} ({kb.kind(name)}) has no {prop} of its own: it is where {whole} has it"
                )

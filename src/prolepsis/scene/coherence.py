"""What a situation says must make sense before anything is built: what is on, in or full of what."""

from __future__ import annotations

from collections.abc import Collection

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.terms.errors import KnowledgeError, brief_list

HOLDING = {"contains": "be in", "absorbs": "be soaked up by"}
"""Relations from what holds to what is held, and how that is said of what is held."""


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


def _refuse_host(kb: KnowledgeBase, name: str, host: str, how: str, bodies: Collection[str]) -> None:
    if name == host:
        raise KnowledgeError(f"{kb.location(name)}: {name} cannot {how} itself")
    if host not in bodies:
        what = f"the {kb.kind(host)} {host}" if host in kb.objects else host
        known = brief_list(sorted({*bodies} - {name}))
        raise KnowledgeError(
            f"{kb.location(name)}: {name} cannot {how} {what}; needed: a whole that is solid, as {known}"
        )

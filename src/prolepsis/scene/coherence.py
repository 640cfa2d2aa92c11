"""What a situation says must make sense before anything is built: what breaks, what is on, in or full of what."""

from __future__ import annotations

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.matter.liquids.liquids import is_liquid
from prolepsis.terms.errors import KnowledgeError, brief_list

HOLDING = {"contains": "be in", "absorbs": "be soaked up by"}
"""Relations from what holds to what is held, and how that is said of what is held."""


def refuse_nonsense(kb: KnowledgeBase) -> None:
    """Refuse a situation that says of things what cannot be so, or would have no effect.

    Raises:
        KnowledgeError: With the file and line of what is wrong, and what is allowed.
    """
    if not kb.objects:
        raise KnowledgeError("the situation names no physical object; state at least one, such as :floor a :Floor")
    for name in kb.objects:
        _refuse_strength(kb, name)
    bodies = {name for name in kb.objects if kb.whole(name) is None and not is_liquid(kb, name)}
    for relation, subject, place in kb.relations():
        if relation == "on":
            _refuse_place(kb, subject, place, "be on", bodies)
        elif relation in HOLDING:
            _refuse_place(kb, place, subject, HOLDING[relation], bodies)


def _refuse_place(kb: KnowledgeBase, name: str, host: str, how: str, bodies: set[str]) -> None:
    if name == host:
        raise KnowledgeError(f"{kb.place(name)}: {name} cannot {how} itself")
    if host not in bodies:
        what = f"the {kb.kind(host)} {host}" if host in kb.objects else host
        known = brief_list(sorted(bodies - {name}))
        raise KnowledgeError(f"{kb.place(name)}: {name} cannot {how} {what}; needed: a whole that is solid, as {known}")


def _refuse_strength(kb: KnowledgeBase, name: str) -> None:
    """Refuse a strength of what does not break here, which would never come to bear."""
    if kb.is_a(name, "Shell"):
        return
    known = kb.find(name, "breakingForce")
    if known is None or known.origin == "derived":
        return
    shells = [part for part in kb.parts(name) if kb.is_a(part, "Shell")]
    if shells:
        raise KnowledgeError(f"{kb.place(name)}: {name} breaks by its shell; state the breakingForce of {shells[0]}")
    kinds = brief_list(c for c in kb.class_names() if "Shelled" in kb.vocabulary.told_classes((c,)))
    raise KnowledgeError(
        f"{kb.place(name)}: {name} ({kb.kind(name)}) has a breakingForce, but does not break here; what does: {kinds}"
    )

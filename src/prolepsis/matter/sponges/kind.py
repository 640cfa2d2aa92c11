"""Sponges: what absorbs takes up the liquid that it touches, carries it, drips, and gives it off under pressure."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.scene.kind import Controller, Kind
from prolepsis.scene.running import Running
from prolepsis.terms.errors import KnowledgeError

NEEDED = (
    "absorbentCapacity",
    "drippingRetention",
    "squeezedCapacity",
    "youngsModulus",
    "uptakeSpeed",
    "pressingTime",
    "recoveryTime",
    "drippingTime",
)
"""What must be known of what absorbs."""


class Sponges(Kind):
    """The kind of what absorbs."""

    order = 40
    roles = frozenset({"Absorbent"})
    quantities = MappingProxyType(
        dict.fromkeys({*NEEDED, "saturation", "poreSize", "edgeRadius"} - {"youngsModulus"}, "Absorbent")
    )

    def refuse(self, kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
        """Refuse what is told to be soaked but not with what, and what absorbs but not how, or never moves."""
        for name in kb.objects:
            if kb.is_a(name, "Absorbent"):
                _refuse_unknown(kb, name)
            soaked = kb.number(name, "saturation")
            if soaked and not kb.objects_of("absorbs", name):
                raise KnowledgeError(
                    f"{name} has the saturation {soaked:g}, but of what? State the liquid that it :absorbs"
                )

    def start(self, state: Running) -> Sequence[Controller]:
        """Return its controllers in one run."""
        if state.particles is None:
            return ()
        from prolepsis.matter.sponges.absorbing import Absorbing

        things = state.scene.things
        return [Absorbing(state, thing) for thing in things if "Absorbent" in thing.roles and thing.is_body]


def _refuse_unknown(kb: KnowledgeBase, name: str) -> None:
    unknown = [needed for needed in NEEDED if kb.number(name, needed) is None]
    if unknown:
        raise KnowledgeError(f"{kb.location(name)}: {name} ({kb.kind(name)}) absorbs, but has no {', '.join(unknown)}")
    if kb.is_a(name, "Furniture"):
        raise KnowledgeError(
            f"{kb.location(name)}: {name} ({kb.kind(name)}) is fixed, and what is fixed absorbs nothing"
        )


KIND = Sponges()

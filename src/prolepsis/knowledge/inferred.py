"""What is inferred of individuals: their classes, and which of these say what a thing is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from prolepsis.knowledge.vocabulary import Vocabulary


@dataclass(frozen=True, kw_only=True, slots=True)
class Types:
    """What the reasoner found out."""

    classes: Mapping[str, tuple[str, ...]]
    """Individual to its named classes, sorted."""
    vocabulary: Vocabulary
    """The classes."""
    unchecked: str = ""
    """Why it is not known whether the knowledge base contradicts itself, and whether more follows; empty if it is."""

    def superclasses(self, name: str) -> tuple[str, ...]:
        """Return the named classes that are more general than ``name``."""
        return tuple(above for above in self.vocabulary.told_classes((name,)) if above != name)

    def kind(self, classes: tuple[str, ...], vocabulary: Vocabulary) -> str:
        """Return the most specific of ``classes`` that is not defined, or else the most specific one."""
        plain = [c for c in classes if not vocabulary.classes[c].defined] or list(classes)
        higher = {c for o in plain for c in self.superclasses(o)}
        lowest = [c for c in plain if c not in higher]
        return sorted(lowest or plain)[0]

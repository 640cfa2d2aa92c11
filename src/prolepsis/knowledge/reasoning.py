"""First version: told classes."""
from __future__ import annotations
from collections.abc import Mapping
from dataclasses import dataclass
from prolepsis.knowledge.situation import Situation
from prolepsis.knowledge.turtle import Document
from prolepsis.knowledge.vocabulary import Vocabulary

@dataclass(frozen=True, kw_only=True, slots=True)
class Types:
    """Inferred classes."""
    classes: Mapping[str, tuple[str, ...]]
    parents: Mapping[str, tuple[str, ...]]
    """Class to all its named superclasses."""

    def superclasses(self, name: str) -> tuple[str, ...]:
        """Return all named superclasses."""
        return self.parents.get(name, ())

    def kind(self, classes: tuple[str, ...], vocabulary: Vocabulary) -> str:
        """Return the most specific class that is not defined, or else the most specific one."""
        plain = [c for c in classes if not vocabulary.classes[c].defined] or list(classes)
        lowest = [c for c in plain if not any(c in self.superclasses(o) for o in plain if o != c)]
        return sorted(lowest or plain)[0]

def infer_types(documents: tuple[Document, ...], vocabulary: Vocabulary, situation: Situation, *, check: bool) -> Types:
    """Told classes only."""
    return Types(
        classes={n: vocabulary.told_classes(t) for n, t in situation.classes.items()},
        parents={c: tuple(x for x in vocabulary.told_classes((c,)) if x != c) for c in vocabulary.classes},
    )

"""What a batch states is the mean of its individuals, so it must be something that each of them has by its class."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from prolepsis.knowledge.deriving import derive
from prolepsis.terms.errors import KnowledgeError, brief_list

if TYPE_CHECKING:
    from prolepsis.knowledge.knowledge_base import KnowledgeBase
    from prolepsis.knowledge.vocabulary import Default


def refuse_idle_batches(base: KnowledgeBase) -> None:
    """Refuse what is stated of a batch that no individual of it would take, or several in different senses.

    Raises:
        KnowledgeError: With what may be stated of it.
    """
    stated: dict[str, dict[str, str]] = {}
    for (name, property_name), said in base.situation.said.items():
        if "Batch" in base.types.classes[name]:
            stated.setdefault(name, {})[property_name] = said[0].where
    for batch, properties in stated.items():
        members = base.subjects("batch", batch)
        if not members:
            raise KnowledgeError(
                f"{base.location(batch)}: {batch} is a batch to which nothing belongs, so what it states is of no use; "
                f"state :batch :{batch} of its individuals"
            )
        for property_name, where in properties.items():
            for member in members:
                if not _takes(base, member, property_name):
                    allowed = [p for p in base.vocabulary.properties if all(_takes(base, m, p) for m in members)]
                    raise KnowledgeError(
                        f"{where}: {batch} is a batch of {brief_list(sorted({*map(base.kind, members)}))}, of which "
                        f"{member} takes no {property_name} from it; allowed: {brief_list(sorted(allowed))}"
                    )


def _takes(base: KnowledgeBase, member: str, property_name: str) -> bool:
    """Return whether what its batch states of a quantity is that of an individual, or of one part of it."""
    if base.vocabulary.properties[property_name].kind != "quantity":
        return False
    names = [each for each in _with_parts(base, member) if derive(base, each, property_name) is None]
    found = [base.default_of(base.types.classes[each], property_name) for each in names]
    defaults: set[Default] = {default for _, default in filter(None, found)}
    return len({(each.value, each.deviation) for each in defaults}) == 1


def _with_parts(base: KnowledgeBase, name: str) -> Iterator[str]:
    yield name
    for part in base.parts(name):
        yield from _with_parts(base, part)

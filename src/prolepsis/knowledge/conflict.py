"""QuickXplain: the few axioms that cannot hold together, out of the many that do not."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Item = TypeVar("Item")


def smallest_conflict(
    background: tuple[Item, ...], items: tuple[Item, ...], consistent: Callable[[tuple[Item, ...]], bool]
) -> tuple[Item, ...]:
    """Return a subset of ``items`` that is inconsistent with ``background``, and no proper subset of which is.

    Args:
        background: What is not in doubt.
        items: What may be at fault. Earlier ones are kept in the conflict only if later ones do not do.
        consistent: Whether a collection is consistent; whatever is added to an inconsistent one stays so.

    Returns:
        The conflict, in the order of ``items``; empty if the background alone is inconsistent.

    Raises:
        ValueError: If everything together is consistent.

    Source:
        U. Junker, QuickXplain, AAAI 2004.
    """
    if consistent(background + items):
        raise ValueError("there is no conflict")
    if not consistent(background):
        return ()
    return _explain(background, (), items, consistent)


def _explain(
    background: tuple[Item, ...],
    added: tuple[Item, ...],
    items: tuple[Item, ...],
    consistent: Callable[[tuple[Item, ...]], bool],
) -> tuple[Item, ...]:
    if added and not consistent(background):
        return ()
    if len(items) == 1:
        return items
    half = len(items) // 2
    first, second = items[:half], items[half:]
    from_second = _explain(background + first, first, second, consistent)
    from_first = _explain(background + from_second, from_second, first, consistent)
    return from_first + from_second

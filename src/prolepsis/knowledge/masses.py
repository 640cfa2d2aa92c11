"""Masses of wholes and parts agree: a whole has the sum of its parts, and a stated whole is shared out among them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from prolepsis.terms.errors import KnowledgeError

TOLERANCE = 1e-3
"""Two stated masses agree when they differ by no more than this share [1]: people round."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Masses:
    """Who is part of whom, and which masses are known without looking at parts and wholes."""

    parts: Mapping[str, tuple[str, ...]]
    """Whole to its direct parts."""
    wholes: Mapping[str, str]
    """Part to whole."""
    stated: Callable[[str], float | None]
    """Stated mass [kg]."""
    usual: Callable[[str], float | None]
    """Mass by class default, or by density and volume [kg]."""

    def fixed(self, name: str) -> float | None:
        """Return the mass that is stated of ``name``, or of each of its parts [kg]."""
        stated = self.stated(name)
        if stated is not None:
            return stated
        masses = [self.fixed(part) for part in self.parts.get(name, ())]
        return sum(m for m in masses if m is not None) if masses and None not in masses else None

    def expected(self, name: str) -> float | None:
        """Return the mass of ``name`` if nothing were said of its whole [kg]."""
        fixed = self.fixed(name)
        if fixed is not None:
            return fixed
        masses = [self.expected(part) for part in self.parts.get(name, ())]
        if masses and None not in masses:
            return sum(m for m in masses if m is not None)
        return self.usual(name)

    def share(self, name: str) -> float | None:
        """Return the share of ``name`` in the mass of its whole [kg]; None if that does not decide it.

        What is left by the parts of fixed mass goes to the others, in proportion to what is expected of them.
        """
        whole = self.wholes.get(name)
        if whole is None or self.fixed(name) is not None:
            return None
        total = self.stated(whole)
        total = self.share(whole) if total is None else total
        own = self.expected(name)
        if total is None or own is None:
            return None
        others = sum(self.expected(part) or 0.0 for part in self.parts[whole] if self.fixed(part) is None)
        return own * self._rest(whole, total) / others

    def _rest(self, whole: str, total: float) -> float:
        return total - sum(self.fixed(part) or 0.0 for part in self.parts[whole])

    def refuse(self, where: Callable[[str], str]) -> None:
        """Refuse wholes whose mass their parts contradict.

        Args:
            where: File and line at which the mass of a whole is stated.

        Raises:
            KnowledgeError: If parts of stated mass exceed the whole, leave nothing for the others, or, when all
                are stated, do not add up to it.
        """
        for whole, parts in self.parts.items():
            total = self.stated(whole)
            location = where(whole)
            if total is None:
                total, location = self.share(whole), f"{location}: its share"
            if total is None:
                continue
            known = {part: mass for part in parts if (mass := self.fixed(part)) is not None}
            everything, together = len(known) == len(parts), sum(known.values())
            agrees = abs(together - total) <= TOLERANCE * total if everything else together < total
            if not agrees:
                plural = len(known) > 1
                names = f"its part{'s' if plural else ''} {', '.join(known)} {'have' if plural else 'has'}"
                others = [part for part in parts if part not in known]
                rest = f", which leaves nothing for {', '.join(others)}" if others else ""
                raise KnowledgeError(
                    f"{location}: the mass of {whole} is {total:g} kg, but {names} {together:g} kg{rest}"
                )

"""Pushing: what kinds do to bodies by forces of their own, summed, and whether it can add to the energy of bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.terms.errors import InputError, brief


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Push:
    bodies: IntArray
    """MuJoCo bodies, each once, shape (k,)."""
    wrenches: FloatArray
    """Force [N] and torque about the centre of mass [N m] on each, world frame, shape (k, 6)."""
    passes_on: bool


@dataclass(kw_only=True)
class Pushes:
    """What each source pushes now."""

    _by: dict[object, _Push] = field(default_factory=dict[object, _Push])
    _on: dict[tuple[int, bool], BoolArray] = field(default_factory=dict[tuple[int, bool], BoolArray])
    """What is pushed, as long as nobody pushes otherwise."""

    def put(self, source: object, data: Any, bodies: IntArray, wrenches: FloatArray, *, passes_on: bool) -> None:
        """Take what a source pushes from now on in place of what it pushed, and bring the sum into the data.

        Raises:
            InputError: If bodies or wrenches are none.
        """
        count = len(data.xfrc_applied)
        where = f"{type(source).__name__} pushes"
        if wrenches.shape != (len(bodies), 6) or not np.isfinite(wrenches).all():
            raise InputError(f"{where} with wrenches of shape {wrenches.shape}; needed: {(len(bodies), 6)}, finite")
        if len(np.unique(bodies)) < len(bodies) or ((bodies < 0) | (bodies >= count)).any():
            raise InputError(f"{where} bodies {brief(bodies.tolist())}; allowed: 0 to {count - 1}, each once")
        self._on.clear()
        self._by[source] = _Push(bodies=bodies.copy(), wrenches=wrenches.copy(), passes_on=passes_on)
        data.xfrc_applied[:] = 0.0
        for each in self._by.values():
            data.xfrc_applied[each.bodies] += each.wrenches

    @property
    def drive(self) -> bool:
        """Whether something may be pushed that gains energy by it."""
        return any(not each.passes_on for each in self._by.values())

    def on(self, count: int, *, passes_on: bool) -> BoolArray:
        """Return which of ``count`` bodies is pushed by sources that only pass energy on, or by others."""
        known = self._on.get((count, passes_on))
        if known is not None:
            return known
        pushed = np.zeros(count, dtype=np.bool_)
        for each in self._by.values():
            if each.passes_on == passes_on:
                pushed[each.bodies] |= each.wrenches.any(axis=1)
        self._on[count, passes_on] = pushed
        return pushed

    def bind(self, old: Sequence[str], new: Sequence[str]) -> None:
        """Take the numbers of bodies in a model that is new, names being given; what is no more is pushed no more."""
        self._on.clear()
        index = {name: body for body, name in enumerate(new)}
        number = np.array([index.get(name, -1) for name in old], dtype=np.int64)
        for source, each in self._by.items():
            kept = number[each.bodies] >= 0
            bodies = number[each.bodies[kept]]
            self._by[source] = replace(each, bodies=bodies, wrenches=each.wrenches[kept])

"""Joining: what kinds hold together at points, each its own joints, and what they tell of what sticks to what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.scene.running import PointJoint
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError, UnknownNameError, brief

NAMED = "joint:"
"""Names of joints at points begin so; none is given twice, or one would be taken for another."""
SOLREF = (0.002, 1.0)
"""They give as little as the longest substep allows."""


@dataclass(kw_only=True)
class Joining:
    """The joints of each source."""

    _names: dict[object, tuple[str, ...]] = field(default_factory=dict[object, tuple[str, ...]])
    _pairs: dict[object, frozenset[tuple[int, int]]] = field(default_factory=dict[object, frozenset[tuple[int, int]]])
    _made: int = 0

    @property
    def pairs(self) -> frozenset[tuple[int, int]]:
        """What sticks to what now: indices of the holding and the held thing."""
        return frozenset(pair for pairs in self._pairs.values() for pair in pairs)

    def tell(self, source: object, pairs: frozenset[tuple[int, int]], count: int) -> None:
        """Take what a source tells of what sticks to what, of ``count`` things.

        Raises:
            InputError: If these are no two things.
        """
        for pair in pairs:
            if len(pair) != 2 or not all(index in range(count) for index in pair):
                raise InputError(
                    f"{type(source).__name__} tells that {brief(pair)} stick; needed: two of {count} things"
                )
        self._pairs[source] = pairs

    def replace(self, source: object, spec: Any, joints: Sequence[PointJoint]) -> None:
        """Bring joints of a source into a spec, in place of those that it has.

        Raises:
            InputError: If a joint is none.
        """
        bodies = {body.name for body in spec.bodies if body.name}
        for joint in joints:
            _check(joint, bodies, f"{type(source).__name__} joins")
        before = self._names.get(source, ())
        for known in list(spec.equalities):
            if known.name in before:
                spec.delete(known)
        names = tuple(f"{NAMED}{self._made + k}" for k in range(len(joints)))
        for name, joint in zip(names, joints, strict=True):
            spec.add_equality(
                name=name,
                type=mujoco.mjtEq.mjEQ_CONNECT,
                name1=joint.first,
                name2=joint.second,
                objtype=mujoco.mjtObj.mjOBJ_BODY,
                data=[0.0] * 12,
                solref=list(SOLREF),
            )
        self._names[source], self._made = names, self._made + len(names)

    def numbers(self, source: object, model: Any) -> list[int]:
        """Return the numbers of a source's joints in a model; those of bodies that have fallen apart are lost."""
        known = {model.equality(number).name: number for number in range(model.neq)}
        return [known[name] for name in self._names.get(source, ()) if name in known]

    def points(self, model: Any) -> dict[str, FloatArray]:
        """Return where the joints of a model are, by name."""
        joints = [model.equality(number) for number in range(model.neq)]
        return {joint.name: joint.data.copy() for joint in joints if joint.name.startswith(NAMED)}


def _check(joint: PointJoint, bodies: set[str], where: str) -> None:
    for name in (joint.first, joint.second):
        if name not in bodies:
            raise UnknownNameError.of("body", name, bodies, where)
    if joint.first == joint.second:
        raise InputError(f"{where} {joint.first} with itself; allowed: two bodies")
    for point in (joint.point_on_first, joint.point_on_second):
        if np.shape(point) != (3,) or not np.isfinite(point).all():
            raise InputError(f"{where} {joint.first} and {joint.second} at {brief(point)}; needed: three numbers [m]")

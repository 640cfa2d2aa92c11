"""Joining: what kinds hold together at points, each its own joints, and what they tell of what sticks to what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from prolepsis.geometry.shape import FloatArray
from prolepsis.scene.running import PointJoint
from prolepsis.system.mujoco import mujoco

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

    def tell(self, source: object, pairs: frozenset[tuple[int, int]]) -> None:
        """Take what a source tells of what sticks to what."""
        self._pairs[source] = pairs

    def replace(self, source: object, spec: Any, joints: Sequence[PointJoint]) -> None:
        """Bring joints of a source into a spec, in place of those that it has."""
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

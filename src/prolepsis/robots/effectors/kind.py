"""What a kind of effector says of itself - its keys in a scenario, what it can hold, how it is built, driven and felt -
and the register of all kinds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import MISSING, fields
from typing import Any, Generic, Protocol, TypeVar

from prolepsis.geometry.shape import FloatArray
from prolepsis.robots.commands import Command
from prolepsis.robots.effectors.gap import Gap
from prolepsis.scenario.file import read_table, unknown_key
from prolepsis.scenario.own_robot import OwnGripper
from prolepsis.scene.robot import Effector
from prolepsis.scene.running import Running
from prolepsis.terms.errors import ScenarioError, UnknownNameError

T = TypeVar("T")


class EffectorControl(Protocol):
    """An effector in a running simulation: what it is told, and what it feels."""

    motion: int
    """1 opening, -1 closing, 0 idle."""
    command: float
    """Commanded pad force [N]."""
    pad_force: float
    """The least of the pads' normal forces [N]."""

    @property
    def opening(self) -> float:
        """Gap between the pads [m]."""
        ...

    def bind(self, state: Running) -> None:
        """Look the effector up in a model that is new."""
        ...

    def accept(self, command: Command) -> None:
        """Take a command for this effector."""
        ...

    def act(self, dt: float) -> None:
        """Set its motors for the coming tick of ``dt`` [s]."""
        ...

    def measure(self, forces: list[tuple[int, int, int, float]]) -> None:
        """Read what the pads feel from the normal forces of the last substep, as ``Running`` gives them."""
        ...

    def between(self, own: Collection[int], middle: FloatArray) -> tuple[str, ...]:
        """Return the wholes that it presses on from both sides, in the order of names: none of its ``own`` bodies.

        ``middle`` is where what it holds would have its middle, in the world [m], shape (3,).
        """
        ...

    def held(self, own: Collection[int], middle: FloatArray) -> tuple[str, ...]:
        """Return those of ``between`` that it holds: what has slipped in its grip is not, though it presses on it."""
        ...


class EffectorKind(ABC, Generic[T]):
    """One kind of effector. ``where`` is where a scenario tells of one, for messages."""

    name: str
    """In scenarios."""
    table: type[T]
    """The keys of its own in a gripper's table: a dataclass. Those that must be given tell it from other kinds."""

    @abstractmethod
    def fit(self, spec: Any, model: Any, table: T, given: OwnGripper, where: str) -> tuple[str, ...]:
        """Return the joints that open the effector, and let them open it when they grow.

        Args:
            spec: The ``mujoco.MjSpec`` of the robot, to be changed.
            model: The robot as it was read.
            table: What the scenario says of this kind.
            given: What it says of every gripper.
            where: Where it says so.

        Raises:
            UnknownNameError: If the model lacks what is named.
            ScenarioError: If that cannot be such an effector.
        """

    @abstractmethod
    def read(self, spec: Any, model: Any, joints: tuple[str, ...], table: T, given: OwnGripper, where: str) -> Effector:
        """Return the effector in a robot that was made to fit; ``max_force`` is 0 if the scenario does not say it.

        Raises:
            ScenarioError: If it has no frame.
        """

    @abstractmethod
    def gap(self, spec: Any, model: Any, effector: Effector, where: str) -> Gap:
        """Return how wide the effector is open, from the least to the greatest that it can hold, and where it holds.

        Raises:
            ScenarioError: If it does not open where its joints grow.
        """

    @abstractmethod
    def edit(self, spec: Any, effector: Effector, robot: str, name: str) -> None:
        """Add to the ``mujoco.MjSpec`` of a world what drives the effector called ``name`` of a robot."""

    @abstractmethod
    def control(self, state: Running, effector: Effector, gap: Gap, robot: str, name: str) -> EffectorControl:
        """Return the controller of the effector called ``name`` of a robot."""


KINDS: dict[str, EffectorKind[Any]] = {}
"""All kinds by name; a file of this package adds its own with ``effector``."""


def effector(kind: type[EffectorKind[Any]]) -> type[EffectorKind[Any]]:
    """Register the decorated class as a kind of effector."""
    KINDS[kind.name] = kind()
    return kind


def read_effector(given: OwnGripper, where: str) -> tuple[EffectorKind[Any], Any]:
    """Return the kind of a gripper, stated or told by its keys, and what the scenario says of this kind.

    Raises:
        UnknownNameError: If there is no such kind.
        ScenarioError: If the keys are of no kind, or wrong.
    """
    if given.kind is not None and given.kind not in KINDS:
        raise UnknownNameError.of("kind of effector", given.kind, KINDS, f"{where}.kind")
    kinds = [kind for kind in KINDS.values() if given.kind in (None, kind.name)]
    common = [key for key in OwnGripper.__dataclass_fields__ if key != "effector"]
    known = [*common, *dict.fromkeys(key for kind in kinds for key in _keys(kind))]
    for key in given.effector:
        if key not in known:
            raise unknown_key(where, key, known)
    fitting = [kind for kind in kinds if {*_needed(kind)} <= {*given.effector} <= {*_keys(kind)}]
    if len(fitting) != 1:
        options = " or ".join(f"{', '.join(_needed(kind))} ({kind.name})" for kind in kinds)
        raise ScenarioError(f"{where}: its keys do not tell one kind of effector; needed: palm, tool and {options}")
    kind = fitting[0]
    return kind, read_table(kind.table, given.effector, where)


def _keys(kind: EffectorKind[Any]) -> list[str]:
    return [field.name for field in fields(kind.table)]


def _needed(kind: EffectorKind[Any]) -> list[str]:
    return [field.name for field in fields(kind.table) if field.default is MISSING]

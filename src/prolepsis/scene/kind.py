"""What a kind is - of matter, of hands, of robots: what it adds to a scene, to the world, and to each moment of a run.

All that is general knows kinds by the five steps here, and takes them in this order: compose (``refuse``, ``flowing``,
``parts``, ``fill``), edit (``attach``, ``edit``), start, act (the methods of a ``Controller``), report (``channels``,
``happenings``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Protocol

from prolepsis.geometry.shape import Triple
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.happenings import HappeningType
from prolepsis.log.things import Thing
from prolepsis.scene.running import MAX_STEP, Running
from prolepsis.scene.scene import Pool, Scene

RestingHeight = Callable[[Thing, Sequence[Thing]], float]
"""Returns the height of a thing's frame [m] at which it first touches bodies when it is lowered onto them."""
Roles = Callable[[str], frozenset[str]]
"""Returns of an individual the classes that physics or recognition goes by."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Individuals:
    """The individuals of a situation, while they become things."""

    kb: KnowledgeBase
    roles: Roles
    bodiless: Callable[[str], Thing]
    """Returns an individual as a thing at its stated place that has no shape yet."""
    solid: Callable[[str], Thing]
    """Returns an individual as a thing at its stated place with its shape."""
    attributes: Callable[[str], Mapping[str, float]]
    """Returns the attributes that an individual has at the start, each 1."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Made:
    """What a whole becomes."""

    things: tuple[Thing, ...]
    """The whole and its parts, in that order."""
    parts: tuple[object, ...] = ()
    """What the parts are, as frozen values of a type of their own; ``Scene.each`` finds them."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Draft:
    """A scene in which all solids are at their places."""

    individuals: Individuals
    things: Mapping[str, tuple[Thing, ...]]
    """Each whole with its parts."""
    pools: tuple[Pool, ...]
    """What flows, so far."""
    particles: int
    """Number of particles of the largest liquid."""
    resting_height: RestingHeight


class Building(Protocol):
    """A world while it is built."""

    @property
    def spec(self) -> Any:
        """The ``mujoco.MjSpec``; the body of a thing is called as the thing, its geoms ``thing/0``, ``thing/1`` ..."""
        ...

    @property
    def scene(self) -> Scene:
        """What it is made from."""
        ...

    def rule_contact(self, geom: Any, thing: Thing, *, rolls: bool) -> None:
        """Give a geom of a thing its friction and softness, and resistance to rolling where it rolls."""
        ...

    def add_hinge(
        self, thing: str, position: Triple, axis: Triple, stiffness: float, damping: float, armature: float
    ) -> None:
        """Give the body of a thing a hinge of its name, in its own frame, with a spring [N m/rad, N m s/rad, kg m2]."""
        ...

    def add_pair(self, first: str, second: str, friction: float, gap: float) -> None:
        """Give two geoms a contact of their own, which is found from a distance of ``gap`` on [m]."""
        ...


@dataclass(frozen=True, kw_only=True, slots=True)
class Channel:
    """A number that can be logged of a thing at each tick."""

    name: str
    doc: str
    """What it is, with its unit."""
    role: str | None = None
    """Role of the things that have it; None for all."""
    default: bool = False
    """Whether it is logged of all that have it unless something else is chosen."""
    needed: bool = False
    """Whether recognition cannot do without it, so that it is logged in any case."""
    begins: str | None = None
    """Class of the things of which it is 1 at the start, as the situation tells; None if of none."""
    read: Callable[[Running, Thing], float] | None = None
    """How it is read; by default it is the attribute of its name, which whoever measures it sets."""


class Controller:
    """What a kind does in one run; by default it does nothing and needs nothing."""

    def rejoin(self, state: Running) -> None:
        """Make joints anew, once a body has fallen apart: it has lost them. The first are made in any other step."""
        del state

    def bind(self, state: Running) -> None:
        """Look up what it needs in a model that is new: before the first tick and after each rebuild."""
        del state

    def begin_tick(self, state: Running) -> None:
        """Do what comes before the substeps of a tick."""
        del state

    def longest_step(self, state: Running) -> float:
        """Return the longest substep that it can do with in the coming tick [s]."""
        del state
        return MAX_STEP

    def is_steady(self) -> bool:
        """Return whether the substeps of the coming tick need no look one by one."""
        return True

    def act(self, state: Running) -> None:
        """Do its work after a substep; once a controller has rebuilt the model, the others wait for the next one."""
        del state

    def end_tick(self, state: Running) -> None:
        """Do what need not be done every substep, and set the attributes that it measures."""
        del state


class Kind:
    """A kind; by default it has no individuals and does nothing."""

    order = 0
    """Kinds take each step in ascending order; a later one may go by what an earlier one did."""
    claims: str | None = None
    """Class of the wholes that it makes; inferred, not only stated."""
    shapes: tuple[str, ...] = ()
    """Names of shapes in the ontology that are built by its ``parts`` only."""
    rests = True
    """Whether what it claims is lowered onto what it is on."""
    roles: frozenset[str] = frozenset()
    """Classes that it or recognition goes by, beside those of ``compose``."""
    quantities: Mapping[str, str] = MappingProxyType({})
    """Quantities of which only kinds make use, and the class of the individuals of which this one does."""
    channels: tuple[Channel, ...] = ()
    """What can be logged of its things; its controllers set those that nothing reads."""
    happenings: tuple[HappeningType, ...] = ()
    """What its controllers may report."""

    def refuse(self, kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
        """Refuse a situation that says of its individuals what cannot be so.

        Args:
            kb: The situation.
            kinds: All kinds that there are, this one too: what it cannot do, another may.

        Raises:
            KnowledgeError: With what is wrong, and what is allowed.
        """
        del kb, kinds

    def flowing(self, kb: KnowledgeBase) -> Sequence[str]:
        """Return the individuals that are no bodies, for which its ``fill`` finds a place."""
        del kb
        return ()

    def parts(self, individuals: Individuals, whole: Thing) -> Made:
        """Return what an individual that it claims becomes, at its place.

        Raises:
            KnowledgeError: If it cannot be simulated.
        """
        del individuals
        return Made(things=(whole,))

    def fill(self, draft: Draft) -> tuple[Mapping[str, tuple[Thing, ...]], tuple[Pool, ...]]:
        """Return what flows once all solids are at their places: things that are new or changed, and pools.

        Raises:
            KnowledgeError: If something does not fit where it is.
        """
        del draft
        return {}, ()

    def attach(self, building: Building) -> Mapping[str, float]:
        """Add bodies that come with a model of their own, and return where their joints are at the start, by name."""
        del building
        return {}

    def edit(self, building: Building) -> None:
        """Add to a world in which all bodies are: joints, motors, springs, contacts."""
        del building

    def start(self, state: Running) -> Sequence[Controller]:
        """Return its controllers in one run, by what the parts of the scene are."""
        del state
        return ()

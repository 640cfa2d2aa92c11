"""What a plan may wait for: conditions on what a robot senses, for ``repeat_until``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from prolepsis.log.things import Thing
from prolepsis.programs.action import FORCE, HAND, OBJECT, ParameterSpec, bind, usage_of
from prolepsis.robots.commands import Sense
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import PlanError, UnknownNameError, brief
from prolepsis.terms.terms import Term, Value

Condition = Callable[[Sense], bool]


@dataclass(frozen=True, kw_only=True, slots=True)
class ConditionSpec:
    """One kind of condition."""

    parameters: tuple[ParameterSpec, ...]
    doc: str
    """When it holds, in a line."""
    holds: Callable[..., bool]
    """Called with what is sensed and the arguments by name."""

    def usage(self, name: str) -> str:
        """Return how it is written as ``name``: ``above(Object, Height)``."""
        return usage_of(name, self.parameters)


def _touching(sense: Sense, *, object: Thing, other: Thing) -> bool:
    return sense.pressing(object.name, other.name) > 0.0


def _pressed(sense: Sense, *, object: Thing, other: Thing, force: float) -> bool:
    return sense.pressing(object.name, other.name) >= force


def _holding(sense: Sense, *, hand: Thing) -> bool:
    return bool(sense.hands[hand.name].held())


def _above(sense: Sense, *, object: Thing, height: float) -> bool:
    return sense.position(object.name)[2] > height


def _cracked(sense: Sense, *, object: Thing) -> bool:
    return sense.attribute(object.name, "broken") > 0.0


OTHER = ParameterSpec(name="other", kind="object")
CONDITIONS = {
    "touching": ConditionSpec(parameters=(OBJECT, OTHER), doc="The two touch.", holds=_touching),
    "pressed": ConditionSpec(
        parameters=(OBJECT, OTHER, FORCE), doc="The two are pressed together with at least a force.", holds=_pressed
    ),
    "holding": ConditionSpec(parameters=(HAND,), doc="The hand feels something between its pads.", holds=_holding),
    "above": ConditionSpec(
        parameters=(OBJECT, ParameterSpec(name="height", kind="length")),
        doc="The object's frame is higher than a height over the ground.",
        holds=_above,
    ),
    "cracked": ConditionSpec(parameters=(OBJECT,), doc="The object has been heard to crack.", holds=_cracked),
}
"""All conditions by name; ``not(C)`` turns one round."""


def read_condition(value: Value, scene: Scene) -> Condition:
    """Return the condition that a term describes.

    Raises:
        PlanError: If it is none, or has wrong arguments.
        UnknownNameError: If there is no such condition or object.
    """
    if not isinstance(value, Term):
        raise PlanError(f"plan: {brief(value)} is no condition; one looks like touching(egg1, table1)")
    if value.functor == "not" and len(value.args) == 1:
        inner = read_condition(value.args[0], scene)
        return lambda sense: not inner(sense)
    spec = CONDITIONS.get(value.functor)
    if spec is None:
        raise UnknownNameError.of("condition", value.functor, [*CONDITIONS, "not"], "plan")
    arguments = bind(spec.parameters, value, scene)
    if "other" in arguments and arguments["object"].name == arguments["other"].name:
        raise PlanError(f"plan: {brief(value)} would never hold: nothing touches itself")
    return lambda sense: spec.holds(sense, **arguments)

"""What an action is: a name, typed parameters and a generator of commands; the registry of all actions."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from prolepsis.log.fact_types import declare_action, event_of
from prolepsis.log.things import Thing
from prolepsis.robots.commands import Behaviour
from prolepsis.robots.hand import HAND as ROBOT
from prolepsis.scene.scene import Scene
from prolepsis.system.text_files import is_file
from prolepsis.terms.errors import PlanError, UnknownNameError, brief, brief_list
from prolepsis.terms.terms import Term, Value, Variable, format_value
from prolepsis.terms.units import read_quantity, to_float

KINDS: Mapping[str, str] = {
    "hand": "name of a gripper",
    "robot": "name of a robot",
    "object": "name of an object",
    "part": "where on an object: edge or top",
    "force": "force of each pad [N], a number or a force level",
    "push": "force on what is in front [N]",
    "length": "[m]",
    "duration": "[s]",
    "speed": "[m/s]",
    "acceleration": "[m/s^2]",
    "angle": "[rad]",
    "rate": "[rad/s]",
    "count": "[1]",
    "displacement": "list of three lengths along the world's axes [m]",
    "position": "list of two lengths along the world's axes [m]",
    "file": "name of a file, such as 'wipe.csv', seen from the scenario",
}
"""What an argument of an action may be, with its unit."""


UNITS: Mapping[str, str] = {
    "force": "N",
    "push": "N",
    "length": "m",
    "duration": "s",
    "speed": "m/s",
    "acceleration": "m/s2",
    "angle": "rad",
    "rate": "rad/s",
}
"""SI unit of each kind of quantity."""


NEEDS: Mapping[str, str] = {
    "anything": "an object",
    "solid": "an object with a body of its own",
    "loose": "an object with a body of its own that is not fixed",
}
"""What is asked of an object, in words: a hand holds only what is loose."""


Sign = Literal["any", "not negative", "not zero", "positive"]
"""What is asked of a quantity's sign."""
SIGNS: Mapping[str, Sign] = {"length": "any", "angle": "any", "displacement": "not zero", "position": "any"}
"""Sign of the kinds of quantities that need not be positive, where an action does not ask for another."""
SLOWEST: Mapping[str, float] = {"speed": 1.0e-4, "rate": 1.0e-3, "acceleration": 1.0e-3}
"""Least size of some kinds, in SI units: what is slower needs hours for its way, and is no movement."""
GREATEST: Mapping[str, float] = {
    "acceleration": ROBOT.max_acceleration,
    "rate": ROBOT.max_angular_speed,
    "angle": math.pi,
    "count": 100.0,
    "length": 100.0,
    "displacement": 100.0,
    "position": 100.0,
    "duration": 86_400.0,
}
"""Greatest size of some kinds, in SI units: what the hand cannot follow, or takes more than a day, is refused."""
HINTS: Mapping[str, str] = {
    "angle": '; degrees need a parameter such as { value = 90, unit = "deg" }',
    "rate": '; degrees need a parameter such as { value = 90, unit = "deg/s" }',
}
"""What may have been meant."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ParameterSpec:
    """One argument of an action."""

    name: str
    kind: str
    """One of ``KINDS``."""
    default: float | str | None = None
    """Value when the argument is left out; None if it must be given."""
    needs: str = "anything"
    """What an object must be, one of ``NEEDS``."""
    sign: Sign | None = None
    """What a quantity's sign must be; None for what ``SIGNS`` says of its kind."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ActionSpec:
    """One kind of action."""

    name: str
    parameters: tuple[ParameterSpec, ...]
    doc: str
    """What it does, in a line."""
    behave: Callable[..., Behaviour] = field(repr=False)
    """Called with the scene, the first sense and the arguments by name; yields the commands."""
    check: Callable[..., None] | None = field(default=None, repr=False)
    """Called with the scene and the arguments before anything runs; raises PlanError if it cannot work."""
    moves: str | None = None
    """What of the robots it names it moves, ``base`` or ``head``; None for one that moves the hands it names."""

    @property
    def event(self) -> str:
        """Type of the event that it is on a timeline: ``lifting``."""
        return event_of(self.name)

    def usage(self) -> str:
        """Return how it is written: ``lift(Hand, Height, Speed = 0.25 m/s)``."""
        return usage_of(self.name, self.parameters)


def usage_of(name: str, parameters: Iterable[ParameterSpec]) -> str:
    """Return how a term with these parameters is written."""
    shown: list[str] = []
    for parameter in parameters:
        variable = parameter.name[0].upper() + parameter.name[1:]
        told, default = KINDS[parameter.kind], parameter.default
        unit = told.strip("[]1") if told.startswith("[") else UNITS.get(parameter.kind, "")
        value = default if default is None or isinstance(default, str) else f"{default:g} {unit}".rstrip()
        shown.append(variable if value is None else f"{variable} = {value}")
    return f"{name}({', '.join(shown)})"


ACTIONS: dict[str, ActionSpec] = {}
"""All actions by name; a file in ``actions/`` adds its own with ``action``."""


def action(
    *parameters: ParameterSpec, check: Callable[..., None] | None = None, moves: str | None = None
) -> Callable[[Callable[..., Behaviour]], Callable[..., Behaviour]]:
    """Register the decorated generator function as an action of its name, and the event that it is.

    Its docstring's first line is for users.
    """

    def register(behave: Callable[..., Behaviour]) -> Callable[..., Behaviour]:
        doc = (behave.__doc__ or "").strip().partition("\n")[0]  # `python -OO` leaves none
        ACTIONS[behave.__name__] = ActionSpec(
            name=behave.__name__, parameters=parameters, doc=doc, behave=behave, check=check, moves=moves
        )
        optional = sum(each.default is not None for each in parameters)
        declare_action(behave.__name__, tuple(each.name for each in parameters), optional=optional)
        return behave

    return register


PARTS = ("edge", "top")
"""Where something may be hit."""
LISTS = {"displacement": (3, "[0.2, 0, 0.1]"), "position": (2, "[0.5, -0.2]")}
"""Kinds that are lists: how many numbers, and an example."""
ROLES = {"hand": "Gripper", "robot": "Robot"}
"""Role of what an argument may name."""
OWN = frozenset(ROLES.values())
"""Roles of what is no object to a plan."""

HAND = ParameterSpec(name="hand", kind="hand")
ROBOT_NAME = ParameterSpec(name="robot", kind="robot")
OBJECT = ParameterSpec(name="object", kind="object")
HELD = ParameterSpec(name="object", kind="object", needs="loose")
FORCE = ParameterSpec(name="force", kind="force")


def bind(parameters: tuple[ParameterSpec, ...], term: Term, scene: Scene, usage: str = "") -> dict[str, Any]:
    """Return the arguments of an action or a condition by name: things for names, SI numbers for quantities.

    Raises:
        PlanError: If an argument is missing, superfluous, of the wrong kind, or more than the robot can.
        UnknownNameError: If an object or a force level does not exist.
    """
    needed = sum(parameter.default is None for parameter in parameters)
    if not needed <= len(term.args) <= len(parameters):
        shown = usage or f"{term.functor}({', '.join(each.name.capitalize() for each in parameters)})"
        raise PlanError(
            f"plan: {brief(term)} has {len(term.args)} argument{'s' * (len(term.args) != 1)}, needed: {shown}"
        )
    bound: dict[str, Any] = {}
    for k, parameter in enumerate(parameters):
        if k < len(term.args):
            bound[parameter.name] = _bind(parameter, term.args[k], term, scene)
        else:
            bound[parameter.name] = parameter.default
    _refuse_beyond(parameters, bound, term)
    return bound


def _refuse_beyond(parameters: tuple[ParameterSpec, ...], bound: dict[str, Any], term: Term) -> None:
    """Refuse what is given and more than the hand can that an action names; what is left out is what it can at most."""
    for hand in (each for each in bound.values() if isinstance(each, Thing) and "Gripper" in each.roles):
        for k, parameter in enumerate(parameters):
            limit = hand.quantities.get(LIMITS.get(parameter.kind, ""))
            if limit is not None and k >= len(term.args):
                bound[parameter.name] = min(bound[parameter.name], limit)
            elif limit is not None and bound[parameter.name] > limit:
                unit = UNITS[parameter.kind]
                raise PlanError(
                    f"plan: {parameter.name} of {brief(term)} is {bound[parameter.name]:g} {unit}, "
                    f"{hand.name} can do {limit:.4g} {unit} at most"
                )


LIMITS: Mapping[str, str] = {
    "force": "maxForce",
    "push": "maxPush",
    "speed": "maxSpeed",
    "acceleration": "maxAcceleration",
}
"""Quantity of a gripper that says how much of a kind it can."""


def _bind(parameter: ParameterSpec, value: Value, term: Term, scene: Scene) -> Any:
    where = f"plan: {parameter.name} of {brief(term)}"
    if isinstance(value, Variable):
        raise PlanError(f"{where} has no value; give parameter {value.name} one")
    if parameter.kind in ("hand", "robot", "object"):
        return _bind_thing(parameter, value, where, scene)
    if parameter.kind == "part":
        if value not in PARTS:
            raise PlanError(f"{where} must be one of {', '.join(PARTS)}, not {brief(format_value(value))}")
        return value
    if parameter.kind in LISTS:
        count, example = LISTS[parameter.kind]
        if isinstance(value, tuple) and len(value) == count and all(isinstance(v, int | float) for v in value):
            numbers = tuple(_within(parameter, to_float(v), where) for v in value if isinstance(v, int | float))
            _refuse_sign(parameter, max(map(abs, numbers)), where)
            return numbers
        raise PlanError(f"{where} must be a {KINDS[parameter.kind]}, such as {example}")
    if parameter.kind == "file":
        return _bind_file(value, where, scene)
    if parameter.kind == "force" and isinstance(value, str):
        newtons = scene.number(value, "force")
        if newtons is None and read_quantity(value) is not None:
            raise PlanError(
                f"{where} must be a number [N] or a force level, not {brief(value)}; what has a unit is a parameter of "
                'the scenario, { value = 5, unit = "N" }'
            )
        if newtons is None:
            levels = [subject for subject, name, _ in scene.domain.values if name == "force"]
            raise UnknownNameError.of("force level", value, levels, where)
        return newtons
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise PlanError(f"{where} must be a {_number(parameter.kind)}, not {brief(format_value(value))}")
    number = _within(parameter, to_float(value), where)
    if parameter.kind == "count" and not number.is_integer():
        raise PlanError(f"{where} must be a whole number, not {number:g}")
    _refuse_sign(parameter, number, where)
    least = SLOWEST.get(parameter.kind, 0.0)
    if abs(number) < least:
        raise PlanError(f"{where} must be at least {least:g} {UNITS[parameter.kind]}, not {number:g}")
    return number


def _refuse_sign(parameter: ParameterSpec, number: float, where: str) -> None:
    """Refuse a number whose sign makes no sense; of a list, its greatest size is looked at."""
    sign = parameter.sign or SIGNS.get(parameter.kind, "positive")
    if {"any": False, "not negative": number < 0, "not zero": number == 0, "positive": number <= 0}[sign]:
        asked = "be positive" if sign == "positive" else f"not be {sign.removeprefix('not ')}"
        unit = UNITS.get(parameter.kind, "m" if parameter.kind in LISTS else "")
        raise PlanError(f"{where} must {asked}, {'not' if sign == 'positive' else 'but is'} {number:g} {unit}".rstrip())


def _number(kind: str) -> str:
    """Return how a message calls a number of a kind: what it is, or only its unit."""
    return f"number {KINDS[kind]}" if KINDS[kind].startswith("[") else KINDS[kind]


def _bind_thing(parameter: ParameterSpec, value: Value, where: str, scene: Scene) -> Thing:
    if not isinstance(value, str):
        raise PlanError(f"{where} must be the {KINDS[parameter.kind]}, not {brief(format_value(value))}")
    role = ROLES.get(parameter.kind)
    choices = [t for t in scene.things if t.whole is None and (role in t.roles if role else not t.roles & OWN)]
    for thing in choices:
        if thing.name == value:
            if parameter.needs != "anything":
                _refuse_unless(_is_solid, thing, where, NEEDS["solid"], scene)
            return thing
    raise UnknownNameError.of(KINDS[parameter.kind].rsplit(" ", 1)[-1], value, (t.name for t in choices), where)


def refuse_fixed(parameters: tuple[ParameterSpec, ...], arguments: Mapping[str, Any], term: Term, scene: Scene) -> None:
    """Refuse a fixed thing where an action needs one that a hand can hold.

    Raises:
        PlanError: With what could be held.
    """
    for parameter in parameters:
        if parameter.needs == "loose":
            where = f"plan: {parameter.name} of {brief(term)}"
            _refuse_unless(_is_loose, arguments[parameter.name], where, NEEDS["loose"], scene)


def _refuse_unless(fits: Callable[[Thing, Scene], bool], thing: Thing, where: str, needed: str, scene: Scene) -> None:
    if not fits(thing, scene):
        known = brief_list(t.name for t in scene.things if t.whole is None and not t.roles & OWN and fits(t, scene))
        raise PlanError(f"{where} must be {needed}, not the {thing.kind} {thing.name}; known: {known}")


def _is_solid(thing: Thing, scene: Scene) -> bool:
    return any(each.shape.geoms for each in (thing, *scene.parts(thing.name))) and "Stuff" not in thing.roles


def _is_loose(thing: Thing, scene: Scene) -> bool:
    return _is_solid(thing, scene) and not thing.fixed


def _bind_file(value: Value, where: str, scene: Scene) -> Path:
    if not isinstance(value, str):
        raise PlanError(f"{where} must be the {KINDS['file']}, not {brief(format_value(value))}")
    if not is_file(scene.folder / value):
        raise PlanError(f"{where}: there is no file {scene.folder / value}")
    return scene.folder / value


def _within(parameter: ParameterSpec, number: float, where: str) -> float:
    if not math.isfinite(number):
        raise PlanError(f"{where} must be finite, not {number:g}")
    kind = parameter.kind
    if kind in GREATEST and abs(number) > GREATEST[kind]:
        most = f"{GREATEST[kind]:.5g} {UNITS.get(kind, 'm' if kind in LISTS else '')}".rstrip()
        raise PlanError(f"{where} must be at most {most} in size, not {number:g}{HINTS.get(kind, '')}")
    return number

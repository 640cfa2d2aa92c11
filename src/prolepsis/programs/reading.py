"""From a plan, which is a term, to a program: combinators and actions, checked against the scene."""

from __future__ import annotations

from collections.abc import Mapping

import prolepsis.programs.actions as _actions
from prolepsis.log.things import Thing
from prolepsis.programs.action import ACTIONS, KINDS, UNITS, bind, refuse_fixed
from prolepsis.programs.combining import Maker, all_together, in_sequence, repeated
from prolepsis.programs.conditions import read_condition
from prolepsis.programs.nesting import as_event
from prolepsis.programs.program import Program
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import PlanError, UnknownNameError, brief, brief_list
from prolepsis.terms.terms import Term, Value, Variable, format_value

COMBINATORS = {
    "sequence": "one action after the other: sequence([A, B, ...])",
    "together": "all at once; ends when the last one ends: together([A, B, ...])",
    "repeat_until": "again and again until a condition holds: repeat_until(touching(egg1, table1), A)",
}
"""What joins actions."""

_ = _actions


def read_program(plan: Value, scene: Scene) -> Program:
    """Return the program that a plan describes.

    Args:
        plan: Such as ``sequence([grasp(hand1, egg1, 20), lift(hand1, 0.1)])``.
        scene: The things that the plan may name.

    Raises:
        PlanError: If an action has wrong arguments or cannot work in this scene.
        UnknownNameError: If an action, object or force level does not exist.
    """
    return Program(term=plan, begin=_read(plan, scene))


def check_units(plan: Value, units: Mapping[str, str | None]) -> None:
    """Check that each variable of a plan has the unit that its place in an action needs.

    Args:
        plan: The plan with its variables.
        units: SI unit of each variable's value, or None for a pure number or a name.

    Raises:
        PlanError: If a unit does not fit.
    """
    if isinstance(plan, tuple):
        for part in plan:
            check_units(part, units)
    if not isinstance(plan, Term):
        return
    spec = ACTIONS.get(plan.functor)
    if spec is None:
        for part in plan.args:
            check_units(part, units)
        return
    for parameter, value in zip(spec.parameters, plan.args, strict=False):
        given = units.get(value.name) if isinstance(value, Variable) else None
        needed = UNITS.get(parameter.kind)
        if isinstance(value, Variable) and given is not None and given != needed:
            wanted = f"needs {needed}" if needed else f"is a {KINDS[parameter.kind]}"
            raise PlanError(f"parameter {value.name} is in {given}, but {parameter.name} of {plan.functor} {wanted}")


def _read(plan: Value, scene: Scene) -> Maker:
    if isinstance(plan, tuple):
        plan = Term("sequence", (plan,))
    if isinstance(plan, Variable):
        raise PlanError(f"plan: {plan.name} stands where an action is needed")
    if isinstance(plan, str) and plan in (*ACTIONS, *COMBINATORS):
        plan = Term(plan, ())
    if not isinstance(plan, Term):
        raise PlanError(f"plan: {brief(plan)} is no action; an action looks like lift(hand1, 0.1)")
    if plan.functor in (",", ";", "|", "->"):
        raise PlanError(f"plan: {brief(plan)}: actions are joined by sequence([A, B]) or together([A, B])")
    if plan.functor in COMBINATORS:
        return _read_combinator(plan, scene)
    spec = ACTIONS.get(plan.functor)
    if spec is None:
        raise UnknownNameError.of("action", plan.functor, [*ACTIONS, *COMBINATORS], "plan")
    arguments = bind(spec.parameters, plan, scene, spec.usage())
    if spec.check is not None:
        spec.check(scene, **arguments)
    refuse_fixed(spec.parameters, arguments, plan, scene)

    return lambda sense: as_event(spec.name, arguments, spec.behave(scene, sense, **arguments), sense, said=plan.args)


def _read_combinator(plan: Term, scene: Scene) -> Maker:
    if plan.functor == "repeat_until":
        if len(plan.args) != 2:
            raise PlanError(f"plan: {plan.functor} needs a condition and an action: {COMBINATORS[plan.functor]}")
        return repeated(read_condition(plan.args[0], scene), _read(plan.args[1], scene), format_value(plan.args[0]))
    if len(plan.args) != 1 or not isinstance(plan.args[0], tuple) or not plan.args[0]:
        raise PlanError(f"plan: {plan.functor} needs a list of at least one action: {COMBINATORS[plan.functor]}")
    makers = [_read(part, scene) for part in plan.args[0]]
    if plan.functor == "sequence":
        return in_sequence(makers)
    _refuse_shared_joints(plan.args[0], scene)
    return all_together(makers)


def _refuse_shared_joints(parts: tuple[Value, ...], scene: Scene) -> None:
    """Refuse actions that move the same joints at the same time."""
    taken: dict[str, Value] = {}
    for part in parts:
        moved = _moved(part, scene)
        shared = sorted(moved & {*taken})
        if shared:
            raise PlanError(
                f"plan: two actions done together command {brief_list(shared)}: {brief(taken[shared[0]])} and "
                f"{brief(part)}; put them in a sequence"
            )
        taken |= dict.fromkeys(moved, part)


def _moved(plan: Value, scene: Scene) -> set[str]:
    """Return what a plan moves: hands, and bases and heads of robots."""
    if isinstance(plan, tuple):
        return {name for part in plan for name in _moved(part, scene)}
    if not isinstance(plan, Term):
        return set()
    spec = ACTIONS.get(plan.functor)
    if spec is None:
        return {name for part in plan.args for name in _moved(part, scene)}
    arguments = bind(spec.parameters, plan, scene, spec.usage())
    return {
        each.name if spec.moves is None else f"the {spec.moves} of {each.name}"
        for each in arguments.values()
        if isinstance(each, Thing) and ("Gripper" in each.roles) == (spec.moves is None) and (each.roles & MOVING)
    }


MOVING = frozenset({"Gripper", "Robot"})
"""What actions move by its own joints."""

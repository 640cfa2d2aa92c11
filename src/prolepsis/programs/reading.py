"""From a plan, which is a term, to a program: combinators and actions, checked against the scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import prolepsis.programs.actions as _actions
from prolepsis.errors import PlanError, UnknownNameError
from prolepsis.programs.action import ACTIONS, KINDS, UNITS, bind_arguments
from prolepsis.programs.commands import ActionFailedError, Begin, Behaviour, Command, End, Sense
from prolepsis.programs.program import Program
from prolepsis.scene.scene import Scene
from prolepsis.terms import Term, Value, Variable

COMBINATORS = {
    "sequence": "one action after the other: sequence([A, B, ...])",
    "together": "all at once; ends when the last one ends: together([A, B, ...])",
}
"""What joins actions."""

Maker = Callable[[Sense], Behaviour]

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
    if not isinstance(plan, Term):
        raise PlanError(f"plan: {plan} is no action; an action looks like lift(hand1, 0.1)")
    if plan.functor in COMBINATORS:
        return _read_combinator(plan, scene)
    spec = ACTIONS.get(plan.functor)
    if spec is None:
        raise UnknownNameError.of("action", plan.functor, [*ACTIONS, *COMBINATORS], "plan")
    arguments = bind_arguments(spec, plan, scene)
    if spec.check is not None:
        spec.check(scene, **arguments)

    def begin(sense: Sense) -> Behaviour:
        sense = yield from _with(Begin(term=plan), spec.behave(scene, sense, **arguments), sense)
        return sense

    return begin


def _with(begin: Begin, behaviour: Behaviour, sense: Sense) -> Behaviour:
    """Run an action between its beginning and its end."""
    greatest: dict[str, float] = {}
    commands: tuple[Command, ...] = (begin,)
    first = True
    while True:
        try:
            made = next(behaviour) if first else behaviour.send(sense)
        except StopIteration as ended:
            sense = ended.value
            break
        except ActionFailedError as failed:
            outcome = {"reason": failed.detail}
            yield (*commands, End(term=begin.term, outcome=failed.outcome, evidence={**greatest, **outcome}))
            raise
        first = False
        sense = yield (*commands, *made)
        commands = ()
        for name, hand in sense.hands.items():
            if name in begin.term.args:
                greatest["peak_pad_force"] = max(greatest.get("peak_pad_force", 0.0), hand.pad_force)
    sense = yield (*commands, End(term=begin.term, evidence=dict(greatest)))
    return sense


def _read_combinator(plan: Term, scene: Scene) -> Maker:
    if len(plan.args) != 1 or not isinstance(plan.args[0], tuple) or not plan.args[0]:
        raise PlanError(f"plan: {plan.functor} needs a list of at least one action: {COMBINATORS[plan.functor]}")
    makers = [_read(part, scene) for part in plan.args[0]]
    if plan.functor == "together":
        _refuse_shared_hands(plan.args[0], scene)
    return _in_sequence(makers) if plan.functor == "sequence" else _all_together(makers)


def _refuse_shared_hands(parts: tuple[Value, ...], scene: Scene) -> None:
    """Refuse actions that move the same hand at the same time."""
    hands = {thing.name for thing in scene.things if "Gripper" in thing.roles}
    taken: set[str] = set()
    for part in parts:
        shared = _names(part) & hands & taken
        if shared:
            raise PlanError(
                f"plan: two actions done together command {', '.join(sorted(shared))}; put them in a sequence"
            )
        taken |= _names(part) & hands


def _names(plan: Value) -> set[str]:
    """Return all atoms in a term."""
    if isinstance(plan, str):
        return {plan}
    parts = plan if isinstance(plan, tuple) else plan.args if isinstance(plan, Term) else ()
    return {name for part in parts for name in _names(part)}


def _in_sequence(makers: list[Maker]) -> Maker:
    def begin(sense: Sense) -> Behaviour:
        ended: tuple[Command, ...] = ()
        for maker in makers:
            behaviour, fresh = maker(sense), True
            while True:
                try:
                    made = next(behaviour) if fresh else behaviour.send(sense)
                except StopIteration as stopped:
                    sense = stopped.value
                    break
                fresh = False
                # That an action has ended takes no time: the next one begins at the same tick.
                if made and all(isinstance(command, End) for command in made):
                    ended += made
                    continue
                sense = yield (*ended, *made)
                ended = ()
        if ended:
            sense = yield ended
        return sense

    return begin


def _all_together(makers: list[Maker]) -> Maker:
    def begin(sense: Sense) -> Behaviour:
        fresh = [maker(sense) for maker in makers]
        going: list[Behaviour] = []
        while fresh or going:
            commands: list[Command] = []
            still: list[Behaviour] = []
            for behaviour in (*going, *fresh):
                try:
                    commands += behaviour.send(sense) if behaviour in going else next(behaviour)
                    still.append(behaviour)
                except StopIteration:
                    pass
            going, fresh = still, []
            if going:
                sense = yield tuple(commands)
        return sense

    return begin

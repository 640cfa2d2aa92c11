"""Actions as events: each says when it begins and how it ends, also when it is a part of another one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from prolepsis.log.outcomes import CARRYING, Outcome
from prolepsis.log.things import Thing
from prolepsis.programs.action import ACTIONS
from prolepsis.programs.crushing import Crushing
from prolepsis.robots.commands import ActionFailedError, Begin, Behaviour, End, HandSense, Measured, Sense, is_instant
from prolepsis.scene.scene import Scene
from prolepsis.terms.terms import Term, Value

LOST_TICKS = 20
"""What was held is dropped if the pads have not felt it for so many ticks at the end of an action."""


def as_event(
    name: str,
    arguments: Mapping[str, Any],
    behaviour: Behaviour,
    sense: Sense,
    *,
    said: tuple[Value, ...] | None = None,
) -> Behaviour:
    """Run an action between its beginning and its end, and note what the hands that it names feel meanwhile.

    Args:
        name: Name of the action.
        arguments: All of its arguments by name, things and SI numbers, in the order of its parameters.
        behaviour: What it does.
        sense: What is sensed as it begins.
        said: The first arguments, as they were said; all of them if it is None.
    """
    named = {each: _value(value) for each, value in arguments.items()}
    if said is None:
        said = tuple(named.values())
    named.update(zip(named, said, strict=False))
    term = Term(name, said)
    evidence: dict[str, float | str] = {}
    outcome: Outcome = "done"
    peak = -1.0
    hands = [each for each in sense.hands if each in named.values()]
    held = {each: {*sense.hands[each].held()} for each in hands if sense.hands[each].grip > 0}
    empty = [each for each in held if not held[each] and name in CARRYING]
    lost = dict.fromkeys(hands, 0)
    crushing = Crushing(arguments, hands, set[str]().union(*held.values()), sense)
    crushed: dict[str, float | str] = {}
    sense = yield (Begin(term=term, arguments=named),)
    first = True
    while True:
        try:
            made = next(behaviour) if first else behaviour.send(sense)
        except StopIteration as ended:
            sense = ended.value
            break
        except ActionFailedError as failed:
            if crushed:
                break
            evidence["reason"] = failed.detail
            yield (End(term=term, outcome=failed.outcome, evidence=evidence),)
            raise
        first = False
        for note in made:
            if isinstance(note, Measured):
                evidence |= note.evidence
                outcome = note.outcome or outcome
        sense = yield made
        if is_instant(made):
            continue
        crushed |= crushing.look(sense)
        for each in hands:
            hand = sense.hands[each]
            if hand.pad_force > peak:
                evidence["peak_pad_force"] = peak = hand.pad_force
            lost[each] = lost[each] + 1 if hand.grip > 0 and hand.pad_force == 0 else 0
    dropped = any(_is_dropped(sense.hands[each], held[each], lost[each]) for each in held)
    if crushed:
        outcome, evidence = "crushed", evidence | crushed
    elif dropped:
        outcome = "dropped"
    elif outcome == "done" and any(_grips_nothing(sense.hands[each], lost[each]) for each in empty):
        # The way is gone to its end all the same: the robot does not know it by itself.
        outcome, evidence = "not_held", {"reason": f"between the pads of {empty[0]} is nothing", **evidence}
    return (yield (End(term=term, outcome=outcome, evidence=evidence),))


def _is_dropped(hand: HandSense, before: set[str], lost: int) -> bool:
    """Return whether a hand that should hold what it held before does not."""
    if not before or not hand.grip:
        return False
    # Pads that have lost what was between them press each other.
    return lost >= LOST_TICKS or (hand.pad_force > 0.0 and before.isdisjoint(hand.held()))


def _grips_nothing(hand: HandSense, lost: int) -> bool:
    """Return whether a hand that should hold something holds nothing."""
    return hand.grip > 0 and (lost >= LOST_TICKS or (hand.pad_force > 0.0 and not hand.held()))


def nested(name: str, scene: Scene, sense: Sense, **arguments: Any) -> Behaviour:
    """Carry out the action called ``name`` as a part of another one; what is not given is as usual."""
    spec = ACTIONS[name]
    bound = {each.name: arguments.get(each.name, each.default) for each in spec.parameters}
    given = [k for k, each in enumerate(spec.parameters) if each.name in arguments]
    said = tuple(_value(value) for value in [*bound.values()][: given[-1] + 1])
    return (yield from as_event(name, bound, spec.behave(scene, sense, **bound), sense, said=said))


def _value(value: Any) -> Value:
    if isinstance(value, Thing):
        return value.name
    return tuple(float(part) for part in value) if isinstance(value, tuple | list) else value  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]

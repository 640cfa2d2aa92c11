"""Actions as events: each says when it begins and how it ends, also when it is a part of another one."""

from __future__ import annotations

from typing import Any

from prolepsis.log.things import Thing
from prolepsis.programs.action import ACTIONS
from prolepsis.robots.commands import ActionFailedError, Begin, Behaviour, End, Note, Sense, is_instant
from prolepsis.scene.scene import Scene
from prolepsis.terms.terms import Term, Value

LOST_TICKS = 20
"""What was held is dropped if the pads have not felt it for so many ticks at the end of an action."""


def as_event(term: Term, behaviour: Behaviour, sense: Sense) -> Behaviour:
    """Run an action between its beginning and its end, and note what the hands that it names feel meanwhile."""
    evidence: dict[str, float | str] = {}
    hands = [name for name in sense.hands if name in term.args]
    held = {name for name in hands if sense.hands[name].grip > 0 and sense.hands[name].pad_force > 0}
    lost = dict.fromkeys(hands, 0)
    sense = yield (Begin(term=term),)
    first = True
    while True:
        try:
            made = next(behaviour) if first else behaviour.send(sense)
        except StopIteration as ended:
            sense = ended.value
            break
        except ActionFailedError as failed:
            evidence["reason"] = failed.detail
            yield (End(term=term, outcome=failed.outcome, evidence=evidence),)
            raise
        first = False
        for note in made:
            if isinstance(note, Note):
                evidence |= note.evidence
        sense = yield made
        for name in hands if not is_instant(made) else ():
            hand = sense.hands[name]
            evidence["peak_pad_force"] = max(float(evidence.get("peak_pad_force", 0.0)), hand.pad_force)
            lost[name] = lost[name] + 1 if hand.grip > 0 and hand.pad_force == 0 else 0
    dropped = any(lost[name] >= LOST_TICKS for name in held)
    return (yield (End(term=term, outcome="dropped" if dropped else "done", evidence=evidence),))


def nested(name: str, scene: Scene, sense: Sense, **arguments: Any) -> Behaviour:
    """Carry out the action called ``name`` as a part of another one; what is not given is as usual."""
    spec = ACTIONS[name]
    bound = {each.name: arguments.get(each.name, each.default) for each in spec.parameters}
    given = [k for k, each in enumerate(spec.parameters) if each.name in arguments]
    shown = [bound[each.name] for each in spec.parameters[: given[-1] + 1]]
    term = Term(name, tuple(_value(value) for value in shown))
    return (yield from as_event(term, spec.behave(scene, sense, **bound), sense))


def _value(value: Any) -> Value:
    if isinstance(value, Thing):
        return value.name
    return tuple(float(part) for part in value) if isinstance(value, tuple | list) else value  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]

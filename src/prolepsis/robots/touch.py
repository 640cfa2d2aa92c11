"""What a hand feels of what it touches, by name: what lies between its pads, and what presses on its fingers."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.scene.running import Running

OUTSIDE = 2.0e-3
"""A contact whose side faces away from the middle between the pads by more than this is on the outside [m]."""
BORNE = 0.1
"""A body is borne by what takes this share of its weight [1]."""


def between_pads(state: Running, pads: Collection[int], own: Collection[int], middle: FloatArray) -> tuple[str, ...]:
    """Return what lies between the pads of a hand, in the order of names; nothing unless each pad feels something.

    Args:
        state: The running scene.
        pads: Bodies that carry the pads.
        own: All bodies of the hand: pads that press each other hold nothing.
        middle: Middle between the pads, in the world [m], shape (3,).
    """
    contact, felt = state.data.contact, {pad: set[str]() for pad in pads}
    for number, pad, other, sign, _ in _on(state, pads, own):
        # Also the ground may press on both fingers, but from below.
        inward = sign * (contact.frame[number][:3] @ (middle - contact.pos[number]))
        if inward > -OUTSIDE:
            felt[pad].add(whole_of(state, other))
    return tuple(sorted(set[str]().union(*felt.values()))) if all(felt.values()) else ()


def on_fingers(state: Running, fingers: Collection[int], own: Collection[int]) -> dict[str, float]:
    """Return with what force each other thing presses on the fingers of a hand [N], by name."""
    felt: dict[str, float] = {}
    for _, _, other, _, force in _on(state, fingers, own):
        name = whole_of(state, other)
        felt[name] = felt.get(name, 0.0) + force
    return felt


def _on(state: Running, bodies: Collection[int], own: Collection[int]) -> Iterator[tuple[int, int, int, float, float]]:
    """Yield contact, body, what touches it, the normal's sign towards that, and force [N], of what is not its own."""
    for number, first, second, force in state.normal_forces():
        if force > 0.0 and (first in own) != (second in own):
            body, other, sign = (first, second, 1.0) if first in own else (second, first, -1.0)
            if body in bodies:
                yield number, body, other, sign, force


def is_borne(state: Running, body: int) -> bool:
    """Return whether something that is no gripper bears a noticeable share of a body's weight from below."""
    borne = 0.0
    for number, first, second, force in state.normal_forces():
        if body in (first, second):
            other, sign = (first, 1.0) if body == second else (second, -1.0)
            upward = sign * force * float(state.data.contact.frame[number][2])
            thing = int(state.body_thing[other])
            if upward > 0.0 and not (thing >= 0 and "Gripper" in state.scene.thing(whole_of(state, other)).roles):
                borne += upward
    gravity = float(np.linalg.norm(state.scene.gravity))
    return borne > BORNE * float(state.model.body_mass[body]) * gravity


def whole_of(state: Running, body: int) -> str:
    """Return the whole that a body is of: the egg for a piece of its shell, the gripper for a finger."""
    number = int(state.body_thing[body])
    if number < 0:
        return str(state.model.body(body).name) or "the ground"
    thing = state.scene.things[number]
    while thing.whole is not None and "Gripper" not in thing.roles:
        thing = state.scene.thing(thing.whole)
    return thing.name

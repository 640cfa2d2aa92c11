"""Peeling: one hand holds out what is cracked, the other pinches its free end and draws shell off, again and again."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from prolepsis.geometry.shape import FloatArray, Quaternion, triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import FORCE, HAND, HELD, ParameterSpec, action
from prolepsis.programs.actions.gripping import close_from
from prolepsis.programs.actions.motion import open_to, stay, travel
from prolepsis.programs.moving.following import go
from prolepsis.programs.moving.grasping import CLEARANCE
from prolepsis.programs.moving.holding import holding
from prolepsis.programs.moving.reached import compared
from prolepsis.programs.moving.two_hands import OTHER, HandPose, HeldOut, check_two_arms, hold_out
from prolepsis.robots.commands import Behaviour, HandTarget, JointPath, Measured, Sense, no_joint_path
from prolepsis.scene.extent import extent_along
from prolepsis.scene.parts import Kernel, Shard
from prolepsis.scene.scene import Scene, reference_of
from prolepsis.terms.errors import PlanError

GONE = 0.008
"""A piece is off when it is farther from the kernel than in the whole shell by this much [m]."""
NEAREST, BEST, FARTHEST = 0.006, 0.018, 0.022
"""How far beyond the middle, towards the free end, it is pinched [m]: not in the way of the first hand, where the
surface is not yet too slanted."""
BEFORE = 0.012
"""A piece whose middle is nearer to the first hand than the middle of the whole by more than this is not under a pad of
the second that pinches there [m]."""
ASIDE = math.sin(math.radians(50.0))
"""What faces the first hand's pads more than this is under them or beside them [1]."""
PITCHES = (23.0, 10.0, 40.0, 0.0)
"""Pitches of the second hand that are tried [degrees]."""
ROOM = 0.030
"""The gripper is open this much wider than what it goes round, if it can be [m]."""
APART = 0.06
"""It comes from so far away, and draws so far [m]."""
DRAW_SPEED, APPROACH_SPEED = 0.05, 0.15
"""[m/s]"""
LOST = 0.04
"""What is so far from where it was held out has been lost [m]."""
SLIPPED = 0.006
"""When the kernel has followed so far, it would come out of the first hand: the pull is given up [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class _Shelled:
    """What is peeled."""

    object: Thing
    kernel: Thing
    pieces: tuple[Thing, ...]

    def seen(self, sense: Sense) -> Thing:
        """Return the whole where its kernel is now."""
        position, orientation = sense.position(self.kernel.name), sense.orientation(self.kernel.name)
        return replace(self.object, position=position, orientation=orientation)

    def outward(self, sense: Sense, piece: Thing) -> FloatArray:
        """Return the displacement from the kernel's middle to a piece [m], shape (3,)."""
        return np.subtract(sense.position(piece.name), sense.position(self.kernel.name))

    def covered(self, sense: Sense) -> list[Thing]:
        """Return the pieces that are still where they were on the kernel."""
        return [piece for piece in self.pieces if self._is_on(sense, piece)]

    def _is_on(self, sense: Sense, piece: Thing) -> bool:
        before = float(np.linalg.norm(np.subtract(piece.position, self.kernel.position)))
        return float(np.linalg.norm(self.outward(sense, piece))) < before + GONE


@dataclass(frozen=True, kw_only=True, slots=True)
class _Pinch:
    """Where the second hand pinches."""

    piece: str
    """Piece under one of its pads."""
    at: HandPose
    width: float
    """Of what is between the pads [m]."""
    opening: float
    """Of the gripper before [m]."""


def _shelled(scene: Scene, object: Thing) -> _Shelled | None:
    """Return an object with its kernel and the pieces of its shell, if it has such."""
    kernels = [scene.thing(kernel.name) for kernel in scene.each(Kernel) if kernel.whole == object.name]
    pieces = tuple(scene.thing(shard.name) for shard in scene.each(Shard) if shard.whole == object.name)
    return _Shelled(object=object, kernel=kernels[0], pieces=pieces) if kernels and pieces else None


def _can_peel(scene: Scene, *, hand: Thing, other: Thing, object: Thing, **_: object) -> None:
    if _shelled(scene, object) is None:
        raise PlanError(f"plan: {object.name} cannot be peeled: it has no shell round a firm kernel")
    check_two_arms(scene, "peel", hand, other, object)


@action(HAND, OTHER, HELD, FORCE, ParameterSpec(name="tries", kind="count", default=4.0), check=_can_peel)
def peel(
    scene: Scene, sense: Sense, *, hand: Thing, other: Thing, object: Thing, force: float, tries: float
) -> Behaviour:
    """Hold out to the other hand what is cracked all round; pinch its free end with a force, draw shell off, repeat."""
    shelled = _shelled(scene, object)
    assert shelled is not None
    holding(hand, object, sense)
    reference = reference_of(scene, hand)
    held, sense = yield from hold_out(hand, other, sense, shelled.seen(sense), BEST, reference)
    sense = yield from stay(0.2, sense)
    before = len(shelled.covered(sense))
    tried: set[str] = set()
    for done in range(round(tries) + 1):
        off = before - len(shelled.covered(sense))
        yield (Measured(evidence={"pieces": before, "pieces_off": off, "tries": done}),)
        sense = yield ()
        if done == round(tries) or math.dist(sense.position(shelled.kernel.name), held.middle) > LOST:
            break
        found = _pinch(other, sense, shelled, held, reference, tried)
        if not isinstance(found, _Pinch):
            if done or not before:
                break
            raise no_joint_path(
                found, f"shell of {object.name} by {other.name}", f"all of it is at the pads of {hand.name}"
            )
        tried.add(found.piece)
        sense = yield from _pull(other, sense, shelled, held, found, reference, force)
        if before - len(shelled.covered(sense)) > off:
            tried.clear()
    off = before - len(shelled.covered(sense))
    return (yield from compared(sense, "pieces_off", off, before, 0.0, "pieces"))


def _pinch(
    other: Thing, sense: Sense, shelled: _Shelled, held: HeldOut, reference: Quaternion, tried: set[str]
) -> _Pinch | JointPath | None:
    """Return the first pinch of a piece that is still on the kernel to which the arm gets; else why not to the first.

    None if no piece is left that is not at the first hand's pads.
    """
    there = sense.hands[other.name]
    assert there.arm is not None
    first: JointPath | None = None
    pieces = [piece for piece in shelled.covered(sense) if piece.name not in tried]
    outward = {piece.name: shelled.outward(sense, piece) for piece in pieces}
    for name in sorted(outward, key=lambda name: abs(float(outward[name] @ held.across) - BEST)):
        for found in _pinches(name, outward[name], other, there.arm.held_at, sense, shelled, held):
            offset, rotation = found.at.seen(there, reference)
            before, _ = found.at.moved(found.at.position, held.across, 0.0, APART * held.across).seen(there, reference)
            path = there.arm.path_to(offset, rotation, {shelled.object.name}, found.opening)
            if not path.problem:
                path = there.arm.path_to(before, rotation, (), found.opening)
            if not path.problem:
                return found
            first = first or path
    return first


def _pinches(
    name: str,
    outward: FloatArray,
    other: Thing,
    held_at: Callable[[float], tuple[float, float]],
    sense: Sense,
    shelled: _Shelled,
    held: HeldOut,
) -> Iterator[_Pinch]:
    """Yield how a piece and what is opposite may be pinched."""
    along = float(outward @ held.across)
    aside = outward - along * held.across
    aside = aside / max(float(np.linalg.norm(aside)), 1e-9)
    if along < -BEFORE or abs(float(aside @ held.pinch)) > ASIDE:
        return
    along = min(max(along, NEAREST), FARTHEST)
    seen = shelled.seen(sense)
    width = extent_along(seen, aside)
    opening = min(width + ROOM, other.quantities["maxOpening"])
    up = np.array([0.0, 0.0, 1.0])
    for pitch in map(math.radians, PITCHES):
        ahead = -math.cos(pitch) * held.across - math.sin(pitch) * up
        across = aside - float(aside @ ahead) * ahead
        for side in (1.0, -1.0):
            pinch = side * across / float(np.linalg.norm(across))
            rotation = np.stack([ahead, pinch, np.cross(ahead, pinch)], axis=1)
            shift = held_at(width)[0] * ahead + held_at(width)[1] * pinch
            position = np.asarray(seen.position) + along * held.across - shift
            yield _Pinch(piece=name, at=HandPose(position=position, rotation=rotation), width=width, opening=opening)


def _pull(
    other: Thing, sense: Sense, shelled: _Shelled, held: HeldOut, pinch: _Pinch, reference: Quaternion, force: float
) -> Behaviour:
    """Pinch, draw away along the free end until the kernel follows, let go, and go back."""
    away = triple(APART * held.across)
    there = sense.hands[other.name]
    offset, rotation = pinch.at.seen(there, reference)
    sense = yield from open_to(other, pinch.opening, sense)
    sense = yield from go(other, sense, triple(np.add(offset, away)), rotation, ())
    sense = yield from travel(other, sense, triple(np.negative(away)), 1.0, APPROACH_SPEED)
    sense = yield from close_from(other, pinch.width + CLEARANCE, force, sense)
    start = sense.position(shelled.kernel.name)
    pulling = travel(other, sense, away, 1.0, DRAW_SPEED)
    made = next(pulling)
    while True:
        try:
            sense = yield made
            if math.dist(sense.position(shelled.kernel.name), start) > SLIPPED:
                break
            made = pulling.send(sense)
        except StopIteration as ended:
            sense = ended.value
            break
    here = sense.hands[other.name]
    sense = yield (HandTarget(hand=other.name, offset=here.offset, rotation=here.rotation),)
    sense = yield from open_to(other, pinch.opening, sense)
    back = triple(np.add(offset, away) - here.offset)
    return (yield from travel(other, sense, back, 1.0, APPROACH_SPEED))

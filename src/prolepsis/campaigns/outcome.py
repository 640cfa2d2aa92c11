"""The outcome of a grasp, read off the timeline: the object slips, is held, or is crushed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from prolepsis.geometry.rotations import rotate_back
from prolepsis.log.fact_types import arguments_of
from prolepsis.log.log import Log
from prolepsis.log.timeline import Fact, Timeline
from prolepsis.programs import ACTIONS
from prolepsis.terms.errors import InputError

GraspOutcome = Literal["slip", "hold", "crush"]
GRASP = ACTIONS["grasp"]
HOLDS = (ACTIONS["hold"], ACTIONS["lift"])
"""What a hand does with what it has grasped."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Grasp:
    """What became of one grasp, with the evidence."""

    hand: str
    """The gripper."""
    object: str
    """What was grasped."""
    level: str | float | None
    """The commanded level: a name, or a force per pad [N]."""
    outcome: GraspOutcome
    """``crush``: it broke in the hand; ``hold``: still attached when the holding ended; else ``slip``."""
    slip: float
    """Greatest displacement of the object in the hand's frame, from the end of the grasp to that of the holding [m]."""
    peak_force: float
    """Greatest force of a pad [N]."""
    bonds_broken: int
    """Bonds of the object that gave way, in the whole run."""


def judge_grasp(timeline: Timeline, log: Log) -> Grasp:
    """Return what became of the first grasp of a run. Symbols decide; the log only gives the evidence.

    Raises:
        InputError: If nothing was grasped.
    """
    grasp = next(iter(timeline.select(type=GRASP.event, kind="event")), None)
    said = {} if grasp is None else arguments_of(grasp)
    if grasp is None or not {"hand", "object"} <= said.keys():
        raise InputError("the plan grasps nothing, so there is no outcome of a grasp (give a goal to ask instead)")
    hand, thing = str(said["hand"]), str(said["object"])
    level = said.get("force", grasp.evidence.get("level"))
    end = _end_of_hold(timeline, grasp, hand)
    return Grasp(
        hand=hand,
        object=thing,
        level=level,
        outcome=_outcome(timeline, grasp, hand, thing, end),
        slip=_slip(log, hand, thing, grasp.end, end),
        peak_force=float(log.channels[f"{hand}.pad_force"].max()) if f"{hand}.pad_force" in log.channels else 0.0,
        bonds_broken=int(np.count_nonzero(log.detachments.thing == log.index(thing))),
    )


def _outcome(timeline: Timeline, grasp: Fact, hand: str, thing: str, end: float) -> GraspOutcome:
    if any(_crushed(timeline, grasp, hand, thing, fact) for fact in _of(timeline, "breaking", thing)):
        return "crush"
    held = any(
        set(fact.args) == {hand, thing} and fact.start < end <= fact.end + timeline.dt / 2
        for fact in timeline.select(type="attached", kind="fluent")
    )
    broken = any(fact.start < end for fact in _of(timeline, "broken", thing))
    return "hold" if held and not broken else "slip"


def _crushed(timeline: Timeline, grasp: Fact, hand: str, thing: str, breaking: Fact) -> bool:
    """Return whether the object broke in the hand: touched by it, and not after it had begun to fall."""
    if breaking.start < grasp.start:
        return False
    fallen = any(grasp.start < fall.start < breaking.start for fall in _of(timeline, "falling", thing))
    touched = any(
        set(fact.args) == {hand, thing}
        and fact.start <= breaking.start + timeline.dt / 2
        # Contact may be lost in the very tick in which the shell gives way.
        and breaking.start <= fact.end + timeline.dt / 2
        for fact in timeline.select(type="contacts", kind="fluent")
    )
    return touched and not fallen


def _of(timeline: Timeline, type: str, thing: str) -> list[Fact]:
    return [fact for fact in timeline.select(type=type) if fact.args == (thing,)]


def _end_of_hold(timeline: Timeline, grasp: Fact, hand: str) -> float:
    """Return when the hand stopped holding [s]: the end of its last holding or lifting, else of the run."""
    ends = [
        fact.end
        for action in HOLDS
        for fact in timeline.select(type=action.event, kind="event")
        if arguments_of(fact).get("hand") == hand and fact.start >= grasp.start
    ]
    return max(ends, default=timeline.duration)


def _slip(log: Log, hand: str, thing: str, start: float, end: float) -> float:
    """Return the greatest displacement of ``thing`` in the hand's frame [m], as long as it is one body."""
    own = log.index(thing)
    parts = [i for i, part in enumerate(log.things) if part.whole == hand and log.carrier[0, i] == i]
    frame = parts[0] if parts else log.index(hand)
    ticks = np.arange(round(start / log.dt), min(round(end / log.dt), log.tick_count))
    ticks = ticks[log.carrier[ticks, own] >= 0]
    if not len(ticks):
        return 0.0
    relative = log.poses[ticks, own, :3] - log.poses[ticks, frame, :3]
    local = rotate_back(log.poses[ticks, frame, 3:], relative)
    return float(np.linalg.norm(local - local[0], axis=1).max())

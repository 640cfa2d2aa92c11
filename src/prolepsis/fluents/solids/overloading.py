"""``overloading(a, share)``: a is struck with more than its wall bears; it would break, but does not here."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import ticks_of
from prolepsis.fluents.kinematics import point_velocities
from prolepsis.fluents.margins import NearMiss
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.collision import APART, MEETING_SPEED, closing_speeds, impacts
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.struck_walls import Wall, blow, wall_of
from prolepsis.fluents.solids.touch import Touch, touches
from prolepsis.log.near import MARGIN, NEAR
from prolepsis.log.timeline import Evidence, Fact


@event("overloading", "o", "share")
def overloading(observation: Observation) -> Iterator[Fact | NearMiss]:
    """An impact on the thing exceeds what its brittle wall bears, by a share; in the world it would break."""
    things = observation.log.things
    closing = observation.of(closing_speeds)
    for touch in observation.of(touches):
        for struck, other in ((touch.a, touch.b), (touch.b, touch.a)):
            wall = wall_of(things[struck].quantities)
            # What yields or folds has a law of its own.
            if wall is None or "YieldingBowl" in things[struck].roles or is_stuff(observation, other):
                continue
            speed = np.maximum.reduceat(closing[touch.rows], touch.first)
            separating = np.minimum.reduceat(closing[touch.rows], touch.first)
            for first, last in impacts(touch, speed, separating, ticks_of(APART, observation.dt)):
                evidence = _struck(observation, touch, (struck, other), wall, (first, last))
                share = float(evidence[MARGIN])
                stretch = touch.tick[first], touch.tick[last - 1] + 1
                fact = observation.fact(
                    "event", "overloading", (things[struck].name, round(share, 2)), stretch, evidence
                )
                if share >= 1:
                    yield fact
                elif share >= 1 - NEAR:
                    yield NearMiss(fact=fact)


def _struck(
    observation: Observation, touch: Touch, pair: tuple[int, int], wall: Wall, rows: tuple[int, int]
) -> Evidence:
    """Return the force of an impact, what the wall bears, and by what it was struck."""
    log = observation.log
    own, other = (log.things[unit] for unit in pair)
    first, last = rows
    closing = observation.of(closing_speeds)[touch.rows]
    begin = int(touch.first[first])
    end = int(touch.first[last]) if last < len(touch.first) else len(touch.rows)
    fastest = begin + int(np.argmax(closing[begin:end]))
    speed = max(float(closing[fastest]), MEETING_SPEED)
    parting = _parting_speed(observation, int(touch.rows[fastest]), int(touch.tick[last - 1]))
    impulse = float(touch.force[first:last].sum() * observation.dt)
    force = blow(wall, own.quantities, other.quantities, impulse / (speed + parting), speed)
    if "Breakable" in other.roles:
        # It gives way itself, under what it was seen to press with.
        force = min(force, float(touch.peak[first:last].max()))
    return {"force": force, "bears": wall.bears, "speed": speed, "by": other.name, MARGIN: force / wall.bears}


def _parting_speed(observation: Observation, row: int, tick: int) -> float:
    """Return how fast both sides of a contact part once an impact is over [m/s]."""
    contacts = observation.log.contacts
    after = np.array([min(tick + 1, observation.tick_count - 2)])
    point = contacts.point[[row]]
    first, second = (point_velocities(observation, side[[row]], after, point) for side in (contacts.a, contacts.b))
    return max(float((second - first)[0] @ contacts.normal[row]), 0.0)

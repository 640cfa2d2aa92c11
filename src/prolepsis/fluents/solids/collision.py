"""``colliding(a, b)``: two solids meet at speed, and an impulse passes between them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import ticks_of
from prolepsis.fluents.kinematics import point_velocities, surface_speeds
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.contact import is_stuff, lighter_mass, pair_names
from prolepsis.fluents.solids.touch import Touch, touches
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

MEETING_SPEED = 0.05
"""Least closing speed of things that were apart [m/s]: the speed after a fall of 0.1 mm."""
SLAMMING_SPEED = 0.3
"""Least closing speed of things that touch already [m/s], as when a tipped box slams down: a sliding body that
hops lands with up to 0.12 m/s, and does not collide."""
APART = 0.05
"""Time without contact after which things were apart [s]: the flight of a bounce of 0.25 m/s."""
SETTLED_SPEED = 0.02
"""Closing or separating speed at which the impact is over [m/s]."""
IMPULSE_SHARE = 0.5
"""Least impulse as a share of (lighter mass times ``MEETING_SPEED``) [1]; less is a touch in passing."""


@event("colliding", "o1", "o2")
def colliding(observation: Observation) -> Iterator[Fact]:
    """Two solids meet at speed and an impulse passes; each bounce is one, resting and sliding are none."""
    closing = observation.of(closing_speeds)
    for touch in observation.of(touches):
        if is_stuff(observation, touch.a) or is_stuff(observation, touch.b):
            continue
        rows = closing[touch.rows]
        if not (rows > MEETING_SPEED).any():
            continue
        speed, separating = np.maximum.reduceat(rows, touch.first), np.minimum.reduceat(rows, touch.first)
        for first, last in impacts(touch, speed, separating, ticks_of(APART, observation.dt)):
            met = float(speed[first:last].max())
            impulse = float(touch.force[first:last].sum() * observation.dt)
            least = IMPULSE_SHARE * lighter_mass(observation, touch) * MEETING_SPEED
            if impulse < least:
                continue
            # What touches already must slam; whatever collides has passed the lower of the two speeds.
            margin = min(met / MEETING_SPEED, impulse / least if least > 0 else np.inf)
            evidence = {"impulse": impulse, "peak_force": float(touch.peak[first:last].max()), "speed": met}
            evidence[MARGIN] = margin
            stretch = touch.tick[first], touch.tick[last - 1] + 1
            yield observation.fact("event", "colliding", pair_names(observation, touch.a, touch.b), stretch, evidence)


def impacts(touch: Touch, speed: FloatArray, separating: FloatArray, apart: int) -> Iterator[tuple[int, int]]:
    """Yield the impacts of a pair as (first, one past the last) of its rows."""
    since = np.diff(touch.tick, prepend=touch.tick[0] - apart - 1)
    hits = np.flatnonzero(((since > apart) & (speed > MEETING_SPEED)) | (speed > SLAMMING_SPEED))
    lively = (speed > SETTLED_SPEED) | (separating < -SETTLED_SPEED)
    over = 0
    for hit in hits.tolist():
        if hit < over:
            continue
        rest = np.flatnonzero((~lively[hit + 1 :]) | (since[hit + 1 :] > 1))
        over = hit + 1 + int(rest[0]) if len(rest) else len(speed)
        yield hit, over


def closing_speeds(observation: Observation) -> FloatArray:
    """Return how fast the two sides of each contact row approached just before it [m/s], negative when parting, (C,).

    Rows of bodies too slow to matter are left at zero.
    """
    contacts = observation.log.contacts
    found = np.zeros(len(contacts.tick))
    speed = observation.of(surface_speeds)
    before = contacts.tick - 1
    fast = speed > SETTLED_SPEED / 2
    chosen = np.flatnonzero((before >= 0) & (fast[contacts.a, before] | fast[contacts.b, before]))
    if not len(chosen):
        return found
    tick, point = before[chosen], contacts.point[chosen]
    relative = point_velocities(observation, contacts.a[chosen], tick, point)
    relative -= point_velocities(observation, contacts.b[chosen], tick, point)
    found[chosen] = np.einsum("ci,ci->c", relative, contacts.normal[chosen])
    return found

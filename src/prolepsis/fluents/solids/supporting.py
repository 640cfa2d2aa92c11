"""``supports(a, b)``: a bears a noticeable share of b's weight from below, and b's weight is balanced."""

from __future__ import annotations

from collections.abc import Iterator

from prolepsis.fluents.intervals import drop_short, mask_of, runs, ticks_of, union
from prolepsis.fluents.margins import NearMiss, margin_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import fluent
from prolepsis.fluents.solids.attachment import grips
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.resting import fixed_supports
from prolepsis.fluents.solids.support import (
    SUPPORT_LEAST,
    bearing_forces,
    bearing_in_all,
    bearing_ratio,
    judged_supports,
    support_runs,
)
from prolepsis.geometry.shape import IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact


@fluent("supports", "o1", "o2")
def supports(observation: Observation) -> Iterator[Fact | NearMiss]:
    """o1 bears at least a tenth of o2's weight through contacts that lie under o2, and o2's weight is balanced."""
    for (below, above), stretches in observation.of(support_runs).items():
        # Of a stuff it is told what all its blobs bear together.
        if observation.has_role(below, "Blob") or is_stuff(observation, above):
            continue
        names = observation.unit_names[below], observation.unit_names[above]
        bearing = observation.of(bearing_forces)[below, above]
        weight, borne = observation.mass(above) * observation.gravity, observation.of(bearing_in_all)[above]
        ratio = bearing_ratio(observation, above, bearing)
        for start, end in _not_gripped(observation, below, above, stretches).tolist():
            force = float(bearing[start:end].mean())
            # What is pressed down has to be borne with what presses it; what also hangs by a joint is not borne in all.
            load = max(float(weight[start:end].mean()), float(borne[start:end].mean()))
            evidence = {"share": force / load, "mean_force": force, MARGIN: margin_of(ratio, start, end)}
            yield observation.fact("fluent", "supports", names, (start, end), evidence)
    yield from observation.of(judged_supports)[1]
    whole = 0, observation.tick_count
    for below, above in observation.of(fixed_supports):
        names = observation.unit_names[below], observation.unit_names[above]
        yield observation.fact("fluent", "supports", names, whole, {"share": 1.0})


def _not_gripped(observation: Observation, below: int, above: int, stretches: IntArray) -> IntArray:
    """Return the stretches without the time in which a unit holds the other by a grip.

    How a hand that grips something is turned, and so which of its pads is below, is nothing new.
    """
    held = union(g.stretches for g in observation.of(grips) if g.held == above and below in g.holders)
    if not len(held):
        return stretches
    count = observation.tick_count
    apart = runs(mask_of(stretches, count) & ~mask_of(held, count))
    return drop_short(apart, ticks_of(SUPPORT_LEAST, observation.dt))

"""When a wall counts as dented or buckled, from the dent that is logged."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from tests.synthetic import DT, TICKS, egg_drop_log

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Timeline


def bowl_log(depth: FloatArray, role: str) -> Log:
    """Return a log with a bowl whose greatest dent is ``depth`` [m], and that is known to give way so."""
    log = egg_drop_log()
    bowl = Thing(name="bowl1", kind="Bowl", roles=frozenset({role}))
    still = np.tile([0.0, 0, 0, 1, 0, 0, 0], (TICKS, 1, 1))
    return dataclasses.replace(
        log,
        things=(*log.things, bowl),
        poses=np.concatenate([log.poses, still], axis=1),
        carrier=np.column_stack([log.carrier, np.full(TICKS, len(log.things))]),
        channels={**log.channels, "bowl1.dent": depth},
    )


def spans(timeline: Timeline, name: str) -> list[tuple[float, float]]:
    return [(fact.start, fact.end) for fact in timeline.facts if fact.type == name]


@pytest.mark.parametrize(("role", "name"), [("DentingBowl", "dented"), ("BucklingBowl", "buckled")])
def test_a_wall_has_given_way_from_when_its_dent_is_noticed(role: str, name: str) -> None:
    depth = np.where(np.arange(TICKS) < 300, 0.0005, 0.004)
    timeline = recognize(bowl_log(depth, role))
    assert spans(timeline, name) == [(300 * DT, TICKS * DT)]
    assert not spans(timeline, "buckled" if name == "dented" else "dented")


def test_a_dent_that_is_pushed_out_again_ends() -> None:
    ticks = np.arange(TICKS)
    timeline = recognize(bowl_log(np.where((ticks > 99) & (ticks < 500), 0.004, 0.0), "DentingBowl"))
    assert spans(timeline, "dented") == [(100 * DT, 500 * DT)]


def test_a_scratch_and_a_bowl_of_glass_are_no_dents() -> None:
    assert not spans(recognize(bowl_log(np.full(TICKS, 0.0009), "DentingBowl")), "dented")
    assert not spans(recognize(bowl_log(np.full(TICKS, 0.004), "density")), "dented")

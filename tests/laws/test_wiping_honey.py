"""A wet sponge wipes thick liquids up, as a person sees it, and as far as closed forms for film and pores say."""

from __future__ import annotations

import numpy as np
import pytest
from tests.comparing import Compare
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import FREE, Log
from prolepsis.matter.sponges.riding_law import RidingLaw

pytestmark = pytest.mark.laws

WIPED = """:floor a :Floor . :table1 a :Table . :liquid1 a :{} ; :on :table1 ; :volume "5 ml" .
:sponge1 a :Sponge ; :on :table1 ; :y -0.12 ; :width 0.06 ; :saturation {} ; :absorbs :water1 . :water1 a :Water .
:hand1 a :Gripper ; :pitch 90 ; :y -0.12 ; :z 0.85 ; :opening 0.085 ."""
WIPING = "sequence([grasp(hand1, sponge1, 4, 0.01), wipe(hand1, sponge1, table1, [0, 0.24, 0], {}, {}, {})"
LIFTED = ", lift(hand1, 0.1), hold(hand1, 0.5)])"


def wiped(kind: str, strokes: int, force: float, speed: float, *, saturation: float = 0.3, particles: int = 400) -> Log:
    """Return the log of strokes over a puddle, and of a lift."""
    return run(WIPED.format(kind, saturation), WIPING.format(strokes, force, speed) + LIFTED, particles=particles)


def held(log: Log) -> FloatArray:
    """Return the share of the puddle that the sponge has in each frame [1], shape (F,)."""
    p = log.particles
    return (p.holder[:, p.stuff == log.index("liquid1")] == log.index("sponge1")).mean(axis=1)


@pytest.mark.parametrize(("force", "particles"), [(2.0, 400), (1.0, 400), (2.0, 800)])
def test_most_of_the_honey_leaves_the_table_in_four_strokes(force: float, particles: int) -> None:
    log = wiped("Honey", 4, force, 0.1, particles=particles)
    assert held(log)[-1] > 0.5
    p = log.particles
    assert set(np.unique(p.holder).tolist()) == {FREE, log.index("sponge1")}
    timeline = recognize(log)
    assert timeline.ask("holds(absorbs(sponge1, liquid1), T), occurs(wiping(sponge1, table1), T2), overlaps(T2, T)")


def test_as_much_goes_under_it_as_a_film_of_the_riding_height_takes_along(compare: Compare) -> None:
    log = wiped("Honey", 1, 2.0, 0.1)
    p, sponge = log.particles, log.index("sponge1")
    law = RidingLaw.of(log.things[sponge].quantities, smallest=0.03, thickness=0.03, face=66e-4)
    assert law is not None
    honey = p.stuff == log.index("liquid1")
    viscosity = log.things[log.index("liquid1")].quantities["viscosity"]
    edge = log.poses[p.tick, sponge, 1] + 0.03
    free = p.holder[:, honey] == FREE
    ahead = free & (p.position[:, honey, 1] > edge[:, None])
    first, last = (int(np.argmax(edge > y)) for y in (0.015, 0.06))
    film = law.height(viscosity, 0.1, 2.0)
    expected = 0.0
    for frame in range(first, last):
        touching = ahead[frame] & (p.position[frame, honey, 1] < edge[frame] + 0.75 * p.spacing)
        across: FloatArray = p.position[frame, honey, 0][touching].astype(np.float64)
        rows = {round(x / p.spacing) for x in across.tolist()}
        expected += film / 2 * len(rows) * p.spacing * float(edge[frame + 1] - edge[frame])
    volume = float((ahead[first] * p.volume[honey]).sum() - (ahead[last] * p.volume[honey]).sum())
    by = "half the riding height (Grubin) times width and way"
    compare("how much honey goes under a sponge", 1e6 * volume, 1e6 * expected, by=by, share=0.15, unit="ml")


def test_a_dry_sponge_takes_up_less_as_nothing_thins_the_honey() -> None:
    wet, nearly_dry = (held(wiped("Honey", 2, 2.0, 0.1, saturation=s))[-1] for s in (0.3, 0.05))
    assert nearly_dry < 0.7 * wet

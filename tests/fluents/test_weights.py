"""What a thing weighs is what it has to be borne with."""

from __future__ import annotations

import pytest
from tests.fluents.logs import Draft, floor, solid_box
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.fluents.observation import observe

SOAKED = (
    ":floor a :Floor . :sponge1 a :Sponge ; :length 0.06 ; :width 0.04 ; :height 0.02 ; :on :floor ; "
    ":saturation 0.5 ; :absorbs :liq1 . :liq1 a :Water ."
)


def test_what_a_sponge_has_soaked_up_weighs_with_it() -> None:
    log = run(SOAKED, duration=0.3, particles=100)
    held = log.particles.mass.sum()
    dry = log.things[log.index("sponge1")].mass
    assert observe(log).mass(log.index("sponge1"))[-1] == pytest.approx(dry + held)
    assert held > 5 * dry
    (borne,) = [f for f in recognize(log).select(type="supports") if f.args == ("floor", "sponge1")]
    # A tenth of the weight is noticed, and all of it is borne.
    assert borne.evidence["margin"] == pytest.approx(10.0, rel=0.2)


def test_what_an_egg_contains_is_counted_once() -> None:
    log = run(":floor a :Floor . :egg1 a :Egg ; :on :floor .", duration=0.1)
    egg = log.index("egg1")
    assert observe(log).mass(egg)[0] == log.things[egg].mass


@pytest.mark.parametrize(("share", "touches"), [(0.5, True), (0.02, True), (0.004, False)])
def test_what_hardly_presses_does_not_touch(share: float, touches: bool) -> None:
    draft = Draft(200, [floor(), solid_box("shard", mass=0.0001), solid_box("hand", mass=1.0, x=0.1)])
    draft.press("shard", "hand", 50, 51, (share * 0.0001 * 9.81, 0.0, 0.0), (1.0, 0.0, 0.0))
    assert bool(recognize(draft.log()).select(type="contacts")) == touches

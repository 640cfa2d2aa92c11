"""What a prompt shows of a run is a line: no arrays, no thousands of facts."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.synthetic import egg_drop_log

from prolepsis.campaigns.campaign import Outcomes, Row
from prolepsis.fluents import recognize
from prolepsis.log.timeline import Fact
from prolepsis.projection import Projection
from prolepsis.scenario.scenario import Scenario
from prolepsis.scene.scene import Scene

LOG = egg_drop_log()
TIMELINE = recognize(LOG)
SCENE = Scene(things=LOG.things, domain=TIMELINE.domain)
SCENARIO = Scenario(path=Path("drop.toml"), situation=Path("drop.ttl"), plan="wait(1.0)")
RUN = Projection(scenario=SCENARIO, scene=SCENE, log=LOG, timeline=TIMELINE, world="<mujoco/>")
FAILED = Outcomes(rows=(Row(values={"seed": 1}), Row(values={"seed": 2}, error="no")))
SHOWN: tuple[object, ...] = (
    *(RUN, LOG, TIMELINE, SCENE, FAILED),
    *(TIMELINE.domain, TIMELINE.facts[0], LOG.things[1]),
    *(LOG.contacts, LOG.joints, LOG.particles, LOG.detachments, *LOG.happenings.values()),
)


@pytest.mark.parametrize("shown", SHOWN, ids=lambda shown: type(shown).__name__)
def test_it_is_one_line(shown: object) -> None:
    assert len(repr(shown)) < 200 and "\n" not in repr(shown)
    assert repr(shown).startswith(type(shown).__name__ + "(")


def test_it_says_what_it_is() -> None:
    assert repr(RUN) == f"Projection(drop.toml: {LOG!r}, {TIMELINE!r})"
    assert repr(LOG) == "Log(800 ticks of 0.001 s, 8 things)"
    assert repr(Fact(kind="fluent", type="on", args=("egg1", "table1"), start=0.5, end=2.0)) == (
        "Fact(fluent on(egg1,table1), 0.5-2.0)"
    )
    assert repr(FAILED) == "Outcomes(2 runs, 1 of them failed)"

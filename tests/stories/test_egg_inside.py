"""What is inside an egg becomes liquid when its shell opens, and whether the yolk stays whole can be asked."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from tests.scenes import falling_egg, run

from prolepsis.fluents import recognize
from prolepsis.log.log import FREE, PARKED
from prolepsis.projection import Projection, project
from prolepsis.terms.errors import Note

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def cracked() -> Projection:
    return project(EXAMPLES / "egg_over_bowl.toml")


@pytest.fixture(scope="module")
def dropped() -> Projection:
    return project(EXAMPLES / "dropped_egg.toml")


def test_cracked_over_a_bowl_it_ends_with_its_contents_in_the_bowl(cracked: Projection) -> None:
    end = cracked.timeline.duration - 0.001
    assert cracked.ask(f"holds_at(contains(bowl1, white1), {end}), holds_at(contains(bowl1, yolk1), {end})")
    assert not cracked.ask(f"holds_at(spilled(_), {end})")
    with pytest.warns(Note, match=r"squeezing\(.*\) was crushed \(egg1 broke at .* of 60 N\)"):
        assert not cracked.ask(f"holds_at(contains(egg1, _), {end})")


@pytest.mark.filterwarnings("ignore:flowingOnto")  # what still flows is told with a no
def test_the_yolk_that_fell_into_the_bowl_is_unbroken_while_the_egg_is_broken(cracked: Projection) -> None:
    assert not cracked.ask("holds(broken(yolk1), _)")
    assert cracked.ask("holds(broken(egg1), _)")
    p = cracked.log.particles
    yolk = p.position[-1][p.stuff == cracked.log.index("yolk1")]
    width, _, height = np.ptp(yolk, axis=0) + p.spacing
    # A fresh yolk on a plate is between a third and a half as high as wide.
    assert 0.3 < height / width < 0.6


def test_its_inside_goes_with_the_egg_until_the_shell_opens(cracked: Projection, dropped: Projection) -> None:
    for projection in (cracked, dropped):
        for stuff in ("white1", "yolk1"):
            assert projection.ask(f"holds(contains(egg1, {stuff}), 0.0-E), occurs(breaking(egg1), S-_), S =< E")


def test_dropped_on_the_floor_they_are_spilled(dropped: Projection) -> None:
    end = dropped.timeline.duration - 0.001
    for stuff in ("white1", "yolk1"):
        assert dropped.ask(f"holds_at(spilled({stuff}), {end}), holds_at(supports(floor, {stuff}), {end})")


def test_no_particle_of_it_is_lost(cracked: Projection, dropped: Projection) -> None:
    for projection in (cracked, dropped):
        log = projection.log
        p = log.particles
        assert 300 <= len(p.mass) <= 500
        assert set(np.unique(p.holder).tolist()) <= {FREE, PARKED, log.index("egg1")}
        inside = [thing.mass for thing in log.things if "Stuff" in thing.roles]
        assert p.mass.sum() == pytest.approx(sum(inside), rel=1e-9)
        assert np.isfinite(p.position).all()


@pytest.mark.parametrize(("height", "breaks"), [(0.12, False), (0.25, True)])
def test_a_hard_blow_drives_the_edges_of_the_shell_into_the_yolk(height: float, breaks: bool) -> None:
    log = run(f":floor a :Floor . :egg1 a :Egg ; :z {0.022 + height} .", duration=math.sqrt(2 * height / 9.81) + 0.05)
    tears = log.detachments.tick[log.detachments.thing == log.index("yolk1")]
    assert bool(len(tears)) == breaks
    assert all(tears <= log.detachments.tick.min() + 5)


@pytest.mark.filterwarnings("ignore:spilling|flowingOnto|moving|flowingOut")  # what still flows is told with a no
def test_a_shell_that_is_nearly_whole_holds_most_of_what_is_in_it() -> None:
    """From 8 cm two pieces are pressed in, and the rest lies on its hole; from 40 cm it is crushed."""
    for height, kept in ((0.08, True), (0.4, False)):
        log = run(f":floor a :Floor . :egg1 a :Egg ; :z {0.022 + height} .", duration=1.0)
        timeline = recognize(log)
        for stuff in ("white1", "yolk1"):
            goal = f"evidence(contains(X, {stuff}), 0.9, fraction_at_end, F), F > 0.7, instance_of(X, 'EggShellPiece')"
            assert bool(timeline.ask(goal)) == kept
        assert bool(timeline.ask("evidence(spilled(white1), 0.9, fraction_at_end, F), F > 0.5")) != kept


@pytest.mark.filterwarnings("ignore:flowingOnto")  # what still flows is told with a no
@pytest.mark.parametrize(("force", "breaks"), [(0.01, True), (0.5, False)])
def test_whether_a_yolk_bursts_depends_on_its_membrane(force: float, breaks: bool) -> None:
    # From 12 cm the shell opens, and what is crushed of it does not reach the yolk.
    values = {"yolk1.membraneForce": force}
    log = run(":floor a :Floor . :egg1 a :Egg ; :z 0.142 .", values=values, duration=0.6)
    timeline = recognize(log)
    assert bool(timeline.ask("occurs(breaking(yolk1), _), holds(broken(yolk1), _)")) == breaks
    assert timeline.ask("occurs(breaking(egg1), _)")


@pytest.mark.parametrize(("height", "margin"), [(0.18, 0.92), (0.26, 1.11)])
def test_a_yolk_that_edges_nearly_reach_was_nearly_pierced(height: float, margin: float) -> None:
    timeline = recognize(run(falling_egg(height), duration=0.35))
    told = timeline.facts if margin > 1 else timeline.near_misses
    (fact,) = (fact for fact in told if str(fact.term) == "broken(yolk1)")
    assert fact.evidence["margin"] == pytest.approx(margin, abs=0.03)
    assert ("breaking(yolk1)" in {str(fact.term) for fact in timeline.facts}) == (margin > 1)

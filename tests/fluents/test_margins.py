"""What decides a fact over its threshold is its margin; what lies near it is told, and what nearly was can be asked."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.scenes import EGG_IN_HAND, run

from prolepsis.commands.timeline import rows
from prolepsis.fluents import recognize
from prolepsis.fluents.margins import nearly
from prolepsis.fluents.observation import observe
from prolepsis.log.domain import Domain
from prolepsis.log.happenings import Happening, film, film_area, happening_columns
from prolepsis.log.near import is_near
from prolepsis.log.saved import read_timeline_files, write_timeline_files
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.errors import GoalError, Note

BLOCK = ":floor a :Floor . :block1 a :Block ; :z {} ."


@pytest.mark.parametrize(("drop", "falls"), [(0.0045, False), (0.0055, True), (0.05, True)])
def test_a_fall_has_its_height_over_the_least_as_margin(drop: float, falls: bool) -> None:
    # The block is 10 cm high.
    timeline = recognize(run(BLOCK.format(0.05 + drop), duration=0.3))
    found = timeline.select(type="falling")
    assert bool(found) == falls
    # What rebounds falls again, from lower.
    for fact in found[:1]:
        assert fact.evidence["margin"] == pytest.approx(drop / 0.005, rel=0.1)
        assert is_near(fact.evidence) == (drop < 0.006)


@pytest.mark.parametrize(("force", "nearly"), [(10.0, False), (40.0, True)])
def test_a_load_near_the_strength_is_a_near_miss(force: float, nearly: bool) -> None:
    log = run(EGG_IN_HAND, f"sequence([close(hand1, {force}), hold(hand1, 0.1)])")
    timeline = recognize(log)
    assert not timeline.select(type="broken")
    found = [fact for fact in timeline.near_misses if fact.type == "broken"]
    assert len(found) == nearly
    for fact in found:
        assert fact.args == ("egg1",)
        assert fact.evidence["margin"] == pytest.approx(log.channels["egg1.load"].max() if nearly else 0)


def test_what_was_so_or_far_from_it_is_no_near_miss() -> None:
    observation = observe(run(BLOCK.format(0.05), duration=0.3))
    ratio = np.zeros(observation.tick_count)
    ratio[10:60], ratio[200:250] = 0.85, 0.95
    what = "fluent", "spilled", ("block1",)
    none = np.zeros((0, 2), dtype=np.int64)
    found = [each.fact for each in nearly(observation, what, ratio, none)]
    assert [(fact.start, fact.end, fact.evidence["margin"]) for fact in found] == [
        (0.01, 0.06, 0.85),
        (0.2, 0.25, 0.95),
    ]
    # On the way to what was so, and where a flicker above the threshold was too short to count.
    was = np.array([[60, 200]], dtype=np.int64)
    assert [*nearly(observation, what, ratio, was)] == []
    ratio[30] = 1.5
    assert [each.fact.start for each in nearly(observation, what, ratio, none)] == [0.2]
    assert [*nearly(observation, what, np.minimum(ratio, 0.79), none)] == []


@pytest.mark.parametrize(
    ("spacing", "areas", "margin"),
    [
        pytest.param(0.005, (2.5e-5,), 1.0, id="one coarse particle"),
        pytest.param(0.001, (1.36e-5,), 1.0, id="a drop of fine ones"),
        pytest.param(0.005, (2.5e-5, 2.5e-3), 184.2, id="a puddle that spreads"),
        pytest.param(0.001, (2.5e-5, 2.5e-3), 184.2, id="the same of finer particles"),
        pytest.param(0.005, (2.5e-3, 5.3e-5), 1.06, id="a puddle that is wiped off but for a fiftieth"),
        pytest.param(0.005, (2.5e-3, 2.5e-4), 5.0, id="a puddle that is wiped off but for a tenth"),
    ],
)
def test_a_film_is_near_its_threshold_when_a_drop_made_it_or_is_left_of_it(
    spacing: float, areas: tuple[float, ...], margin: float
) -> None:
    log = run(BLOCK.format(0.05), duration=0.3)
    floor, wetted = log.index("floor"), log.index("block1")
    rows: list[tuple[int, Happening]] = [(10, film(wetted, floor, wet=True))]
    rows += [(10 + 50 * k, film_area(wetted, area)) for k, area in enumerate(areas)]
    log = replace(log, happenings=happening_columns(rows), particles=replace(log.particles, spacing=spacing))
    facts = [fact for fact in recognize(log).facts if fact.type in ("wet", "dirty")]
    assert [(fact.type, fact.start) for fact in facts] == [("dirty", 0.01), ("wet", 0.01)]
    for fact in facts:
        assert fact.evidence["margin"] == pytest.approx(margin, rel=0.01)


def sample() -> Timeline:
    def spilled(start: float, margin: float, name: str = "liq1") -> Fact:
        return Fact(
            kind="fluent", type="spilled", args=(name,), start=start, end=start + 1, evidence={"margin": margin}
        )

    nearly = [spilled(4.0, 0.9, "liq2")]
    domain = Domain(instances=(("liq1", "Water"), ("liq2", "Water")))
    return make_timeline(
        [spilled(0.0, 1.05), spilled(2.0, 9.0)], dt=0.001, duration=9.0, near_misses=nearly, domain=domain
    )


def test_an_answer_that_rests_on_what_is_near_says_so() -> None:
    timeline = sample()
    with pytest.warns(Note, match=r"near its threshold.*: spilled\(liq1\) \(margin 1.05\)"):
        assert len(timeline.ask("holds(spilled(X), T)")) == 2
    assert timeline.ask("holds(spilled(X), 2.0-E)") == [{"X": "liq1", "E": 3.0}]
    assert timeline.ask("holds(spilled(X), T), evidence(spilled(X), T, margin, M), M > 2")
    with pytest.warns(Note, match=r"no, but nearly so: spilled\(liq2\) \(margin 0.9\)"):
        assert timeline.ask("holds(spilled(liq2), T)") == []
    assert timeline.ask("holds(broken(liq2), T)") == []


def test_what_nearly_was_can_be_asked() -> None:
    timeline = sample()
    assert timeline.ask("near_miss(spilled(X), S-E, M)") == [{"X": "liq2", "S": 4.0, "E": 5.0, "M": 0.9}]
    assert timeline.ask("near_miss(F, 4.5, M), M > 0.8, objOf(F, X)") == [
        {"F": timeline.near_misses[0].term, "M": 0.9, "X": "liq2"}
    ]
    assert timeline.ask("near_miss(F, 5.0, M)") == []
    with pytest.raises(GoalError, match="no fluent or event spiled/1"):
        timeline.ask("near_miss(spiled(X), T, M)")


def test_near_misses_are_saved_and_read_again(tmp_path: Path) -> None:
    timeline = sample()
    write_timeline_files(timeline, tmp_path)
    assert read_timeline_files(tmp_path) == timeline
    assert timeline != make_timeline(timeline.facts, dt=0.001, duration=9.0)


def test_the_timeline_marks_what_is_near() -> None:
    assert [row[-1] for row in rows(sample())[1:]] == ["margin=1.05, near its threshold", "margin=9"]

"""What is soft under an egg: the law of its force, the speed at which it gives way, and what becomes of the egg."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.scenes import run

from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import Log
from prolepsis.matter.shells.contact import local_stiffness
from prolepsis.matter.shells.padding import Padding, concentration
from prolepsis.terms.errors import KnowledgeError

SUBSTEPS = (1e-3, 1.25e-4, 6.25e-5)
MASS = 0.059
SEMI_AXES = np.array([0.0285, 0.022, 0.022])
GIRDLE = local_stiffness(SEMI_AXES, 0.0, 150e3, 1.3)
RADIUS = float(np.prod(SEMI_AXES)) / 0.022**2
SPONGE = Padding(modulus=12e3, thickness=0.05, yields=math.inf, flat=0.846, returned=0.09)
PULP = Padding(modulus=300e3, thickness=0.02, yields=30e3, flat=0.75, returned=0.04)


def dropped(soft: str, top: float, height: float, *, substep: float = 1e-3, after: float = 0.05) -> Log:
    return run(
        f"{soft} :egg1 a :Egg ; :z {top + 0.022 + height!r} .",
        duration=math.sqrt(2 * height / 9.81) + after,
        max_step=substep,
    )


def broken(log: Log) -> bool:
    return len(log.detachments.tick) > 0


def energy_balance(padding: Padding, height: float) -> float:
    """Return the greatest force on a lying egg by m g (h + x) = the integral of F dx: padding and shell in series."""
    given = np.linspace(1e-6, 0.9999 * padding.deepest, 20_000)
    force = np.array([padding.force(depth, RADIUS, 0.022)[0] for depth in given])
    both = given + force / GIRDLE
    work = np.concatenate([[0.0], np.cumsum((force[1:] + force[:-1]) / 2 * np.diff(both))])
    return float(force[int(np.argmax(work > MASS * 9.81 * (height + both)))])


@pytest.mark.parametrize("padding", [SPONGE, PULP], ids=["elastic", "crushed"])
@pytest.mark.parametrize("share", [0.05, 0.5, 0.9])
def test_the_force_of_a_padding_is_that_of_its_columns(padding: Padding, share: float) -> None:
    depth = share * padding.deepest
    step = min(depth, 0.022) / 100_000
    rise: FloatArray = np.arange(0.5, 100_000.0) * step
    force = float((padding.pressure(depth - rise) * 2 * math.pi * RADIUS * (1 - rise / 0.022)).sum()) * step
    found, rising = padding.force(depth, RADIUS, 0.022)
    assert found == pytest.approx(force, rel=1e-3)
    assert rising == pytest.approx((padding.force(depth + 1e-7, RADIUS, 0.022)[0] - found) / 1e-7, rel=1e-3)


def test_a_slight_dent_in_a_padding_is_that_of_a_paraboloid() -> None:
    assert SPONGE.force(1e-4, 0.02, 0.02)[0] == pytest.approx(math.pi * 0.02 * 12e3 * 1e-8 / 0.05, rel=0.01)


def test_a_load_on_a_patch_bends_a_shell_less() -> None:
    # The auxiliary function of the sine integral, Abramowitz and Stegun 5.2.7.
    for z, expected in ((0.01, 4.043386), (1.0, 0.343378), (10.0, 0.009489)):
        assert concentration(4 * z * 0.0015**2, 0.0015) == pytest.approx(expected, rel=1e-4)


@pytest.mark.laws
@pytest.mark.parametrize("substep", SUBSTEPS)
@pytest.mark.parametrize("height", [0.005, 0.05, 0.5, 1.0])
@pytest.mark.parametrize(
    ("soft", "top", "padding"),
    [
        (":floor a :Floor . :soft1 a :Sponge ; :on :floor ; :height 0.05 .", 0.05, SPONGE),
        (":floor a :Floor . :soft1 a :EggBox ; :on :floor .", 0.07, PULP),
    ],
    ids=["elastic", "crushed"],
)
def test_the_peak_of_a_drop_is_that_of_the_energy_balance(
    compare: Compare, soft: str, top: float, padding: Padding, height: float, substep: float
) -> None:
    log = dropped(soft, top, height, substep=substep, after=0.03)
    assert not broken(log)
    peak, by = log.channels["egg1.force"].max(), "`m g (h + x) = integral of F dx`"
    compare(
        "force on an egg that falls on what is soft", peak, energy_balance(padding, height), by=by, share=0.1, unit="N"
    )


@pytest.mark.parametrize("substep", [1e-3, pytest.param(6.25e-5, marks=pytest.mark.laws)])
def test_an_egg_that_falls_5_cm_onto_a_sponge_stays_whole_and_comes_to_rest(substep: float) -> None:
    sponge = ":floor a :Floor . :soft1 a :Sponge ; :on :floor ; :height 0.05 ."
    log = dropped(sponge, 0.05, 0.05, substep=substep, after=0.9)
    assert not broken(log)
    assert log.channels["egg1.force"].max() == pytest.approx(energy_balance(SPONGE, 0.05), rel=0.05)
    height = log.poses[-100:, log.index("egg1"), 2]
    assert np.ptp(height) < 1e-4
    assert SPONGE.force(0.072 - height[-1], RADIUS, 0.022)[0] == pytest.approx(MASS * 9.81, rel=0.15)


def test_an_egg_breaks_through_a_sheet_of_paper_and_not_through_a_folded_towel() -> None:
    assert broken(dropped(":floor a :Floor . :soft1 a :PaperTowel ; :on :floor .", 0.0005, 0.02))
    assert broken(dropped(":floor a :Floor . :soft1 a :Towel ; :on :floor .", 0.004, 0.3))
    assert not broken(dropped(":floor a :Floor . :soft1 a :Towel ; :on :floor ; :height 0.02 .", 0.02, 0.3))


def test_a_carpet_saves_an_egg_from_as_high_as_a_chair_and_not_from_a_ceiling() -> None:
    assert not broken(dropped(":floor a :Carpet .", 0.0, 0.4))
    assert broken(dropped(":floor a :Carpet .", 0.0, 3.0))


def test_any_solid_that_is_told_to_be_soft_is_so() -> None:
    soft = ":floor a :Floor . :soft1 a :Block ; :on :floor ; :youngsModulus 20000.0 ; :densificationStrain 0.9 ."
    assert not broken(dropped(soft, 0.1, 0.2))
    assert broken(dropped(":floor a :Floor . :soft1 a :Block ; :on :floor .", 0.1, 0.2))


def test_a_soft_ground_of_unknown_thickness_is_refused() -> None:
    with pytest.raises(KnowledgeError, match="floor .Floor. has a densificationStrain, but no paddingThickness"):
        dropped(":floor a :Floor ; :densificationStrain 0.9 ; :youngsModulus 20000.0 .", 0.0, 0.1)


def test_an_egg_that_opens_on_a_towel_stays_there_and_throws_nothing_up() -> None:
    log = dropped(":floor a :Floor . :soft1 a :Towel ; :on :floor ; :height 0.01 .", 0.01, 1.0, after=0.2)
    assert broken(log)
    first = int(log.detachments.tick[0]) + 2
    carriers = {log.carrier[-1, i] for i, thing in enumerate(log.things) if "Piece" in thing.roles}
    for moving in (*carriers, log.index("soft1")):
        height = log.poses[first:, moving, 2]
        # What lies loose under the rest may be tilted, at most till it stands on its edge.
        corners = np.array([v for geom in log.things[moving].shape.geoms if geom.type == "mesh" for v in geom.vertices])
        reach = np.linalg.norm(corners, axis=1).max() if len(corners) else 0.0
        assert height.max() < height[0] + reach + 1e-4
        assert height.min() > 0.004

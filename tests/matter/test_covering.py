"""The area of a film is that of the surface on which it lies, whatever the size of the particles."""

from __future__ import annotations

import numpy as np
import pytest

from prolepsis.geometry.shape import FloatArray, Geom, Shape
from prolepsis.geometry.signed_distance import field_of
from prolepsis.matter.films.covering import NOWHERE, Film
from prolepsis.matter.films.wetting import TOUCH_REACH

SPACINGS = [0.0063, 0.005, 0.004]
"""Of half as many, of so many and of twice as many particles [m]."""
LOOKS = 8


def box(*half: float) -> Shape:
    """Return a box of some half sizes [m]."""
    return Shape(geoms=(Geom(type="box", size=(half[0], half[1], half[2])),))


def washed(shape: Shape, spacing: float, beyond: tuple[float, float] = (1.0, -1.0)) -> Film:
    """Return the film of a shape that a liquid flows round, no further out than one length and above another [m]."""
    rng = np.random.default_rng(1)
    side = np.arange(-0.05, 0.05, spacing)
    lattice = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3)
    film = NOWHERE
    for _ in range(LOOKS):
        places: FloatArray = lattice + rng.uniform(0.0, spacing, 3) + rng.normal(0.0, 0.1 * spacing, lattice.shape)
        distance = field_of(shape).distance(places)
        near = (distance > 0.25 * spacing) & (distance < TOUCH_REACH * spacing) & (places[:, 2] > beyond[1])
        near &= (np.abs(places[:, :2]) < beyond[0]).all(axis=1)
        film = film.grown(shape, spacing, places[near])
    return film


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize(
    ("shape", "surface"),
    [
        (box(0.01, 0.01, 0.01), 0.0024),
        (box(0.03, 0.02, 0.0015), 0.0054),
        (Shape(geoms=(Geom(type="sphere", size=(0.012, 0.0, 0.0)),)), 4 * np.pi * 0.012**2),
        (Shape(geoms=(Geom(type="cylinder", size=(0.01, 0.015, 0.0)),)), 2 * np.pi * 0.01 * 0.04),
    ],
)
def test_what_is_wet_all_round_has_the_area_of_its_surface(shape: Shape, surface: float, spacing: float) -> None:
    assert 0.92 * surface < washed(shape, spacing).area < 1.03 * surface


@pytest.mark.parametrize("spacing", SPACINGS)
def test_a_plate_that_is_wet_on_one_side_is_not_so_on_the_other(spacing: float) -> None:
    assert washed(box(0.03, 0.03, 0.0015), spacing, (0.03, 0.0015)).area == pytest.approx(0.0036, rel=0.05)


def test_a_film_has_each_place_once_and_a_part_of_it_the_area_of_that() -> None:
    film = washed(box(0.01, 0.01, 0.01), 0.005)
    assert film.grown(box(0.01, 0.01, 0.01), 0.005, film.positions) is film
    upper = film.only(film.positions[:, 2] > 0.01)
    assert upper.area == pytest.approx(0.0004, rel=0.25)
    assert len(np.unique(film.cells)) == len(film.cells)

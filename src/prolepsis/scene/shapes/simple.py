"""Simple solids: box, cylinder, sphere, ellipsoid, plane, and a table's top on its legs."""

from __future__ import annotations

from collections.abc import Mapping

from prolepsis.geometry.shape import Geom, Shape

TABLE_TOP = 0.03
"""Thickness of a table's top [m]."""
LEG = 0.03
"""Half width of a table's leg [m]."""


def box(q: Mapping[str, float]) -> Shape:
    """Return a box of ``length`` x ``width`` x ``height`` about its centre [m]."""
    return Shape(geoms=(Geom(type="box", size=(q["length"] / 2, q["width"] / 2, q["height"] / 2)),))


def cylinder(q: Mapping[str, float]) -> Shape:
    """Return an upright cylinder of ``radius`` and ``height`` about its centre [m]."""
    return Shape(geoms=(Geom(type="cylinder", size=(q["radius"], q["height"] / 2, 0.0)),))


def sphere(q: Mapping[str, float]) -> Shape:
    """Return a sphere of ``radius`` [m]."""
    return Shape(geoms=(Geom(type="sphere", size=(q["radius"], 0.0, 0.0)),))


def ellipsoid(q: Mapping[str, float]) -> Shape:
    """Return a spheroid of ``length`` along x and ``breadth`` across [m]."""
    return Shape(geoms=(Geom(type="ellipsoid", size=(q["length"] / 2, q["breadth"] / 2, q["breadth"] / 2)),))


def plane(q: Mapping[str, float]) -> Shape:
    """Return level ground."""
    del q
    return Shape(geoms=(Geom(type="plane", size=(3.0, 3.0, 0.1)),))


def table(q: Mapping[str, float]) -> Shape:
    """Return a top of ``length`` x ``width`` whose surface is ``height`` above its four feet [m].

    The frame lies in the middle of the whole.
    """
    x, y, h = q["length"] / 2, q["width"] / 2, q["height"]
    leg = (h - TABLE_TOP) / 2
    top = Geom(type="box", size=(x, y, TABLE_TOP / 2), position=(0.0, 0.0, h / 2 - TABLE_TOP / 2))
    legs = tuple(
        Geom(type="box", size=(LEG, LEG, leg), position=(a * (x - LEG), b * (y - LEG), leg - h / 2))
        for a in (-1.0, 1.0)
        for b in (-1.0, 1.0)
    )
    return Shape(geoms=(top, *legs))

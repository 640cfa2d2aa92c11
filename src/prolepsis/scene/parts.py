"""What parts are, where more than one room asks for them: frozen values beside the things that they tell of."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Shard:
    """A piece that a shell may fall into."""

    name: str
    """The thing."""
    whole: str
    """The whole that has the shell."""
    area: float
    """[m^2]"""
    radius: float
    """Radius of the surface's curvature [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Bonds:
    """What joins the pieces of a whole until it gives way."""

    whole: str
    """The thing that consists of the pieces."""
    pairs: tuple[tuple[str, str], ...]
    """The two things that each bond joins."""
    widths: tuple[float, ...]
    """Length of the common edge of each [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Kernel:
    """What is firm inside a shell."""

    name: str
    """The thing."""
    whole: str
    """The whole that has the shell."""
    adhesion: float
    """Pull on each area at which the shell comes off it [Pa]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Panel:
    """A part of a wall that gives way for itself; the whole's own shape stands for it where it does not move."""

    name: str
    """The thing."""
    whole: str
    """The vessel."""
    lever: float
    """Distance of the rim from the hinge [m]."""
    moment: float
    """Moment at which it gives way [N m]."""
    stiffness: float
    """Moment over angle until then [N m/rad]."""

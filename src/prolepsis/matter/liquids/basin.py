"""The basin of a container as it stands: what part of its cavity would hold a liquid, and up to which height."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import ndimage  # pyright: ignore[reportMissingTypeStubs]

from prolepsis.geometry.cavity import BLOCKED, LEAST_DEPTH, spill_levels
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.scene.placed import Placed, placed

NODE_COUNT = 250_000
"""Nodes of the grid round a container: 1.3 mm apart for a cup of 10 cm, which gives its capacity within 1 %."""
MARGIN = 3
"""Free nodes beyond the container on every side."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Basin:
    """The largest depression of a container at its pose, on a grid whose third axis points up."""

    container: Placed
    """The container, its holes stopped."""
    origin: FloatArray
    """World position of the first node [m], shape (3,)."""
    step: float
    """Distance between nodes [m]."""
    nodes: BoolArray
    """Nodes in the depression, or next to it, shape (nx, ny, nz)."""
    areas: FloatArray
    """Free area of each layer of nodes [m^2], shape (nz,)."""
    brim: float
    """World height above which it spills [m]; its top if it is closed all round."""

    @property
    def capacity(self) -> float:
        """Volume up to the brim [m^3]."""
        return float(self.areas @ self._covered(self.brim))

    def level(self, volume: float) -> float:
        """Return the world height up to which ``volume`` [m^3] fills it [m], the brim at most."""
        low, high = float(self.origin[2]), self.brim
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if float(self.areas @ self._covered(middle)) < volume else (low, middle)
        return (low + high) / 2

    def within(self, points: FloatArray) -> BoolArray:
        """Return whether world points, shape (n, 3), that are in no matter are in the basin, shape (n,)."""
        place: IntArray = np.rint((points - self.origin) / self.step).astype(np.int64)
        shape = np.array(self.nodes.shape)
        inside: BoolArray = np.all((place >= 0) & (place < shape), axis=1, keepdims=False)
        place = np.clip(place, 0, shape - 1)
        return inside & self.nodes[tuple(place.T)]

    def _covered(self, height: float) -> FloatArray:
        """Return how much of each layer is below a height [m], shape (nz,)."""
        bottoms = self.origin[2] + self.step * (np.arange(len(self.areas)) - 0.5)
        return np.clip(height - bottoms, 0.0, self.step)


def basin_of(container: Thing) -> Basin | None:
    """Return the largest depression of a container as it stands, or None if it has none. Holes count as stopped."""
    whole = placed(replace(container, shape=replace(container.shape, holes=())))
    low, high = whole.low, whole.high
    step = float(np.prod(np.maximum(high - low, 1e-3)) / NODE_COUNT) ** (1 / 3)
    origin: FloatArray = low - MARGIN * step
    shape: IntArray = np.ceil((high - low) / step).astype(np.int64) + 2 * MARGIN + 1
    extent = (int(shape[0]), int(shape[1]), int(shape[2]))
    nodes = np.moveaxis(np.indices(extent, dtype=np.float64), 0, -1)
    distance = whole.distance((origin + step * nodes).reshape(-1, 3)).reshape(extent)
    heights: FloatArray = np.ascontiguousarray(origin[2] + step * nodes[..., 2])
    levels = spill_levels(heights, distance < BLOCKED * step)
    # Below an infinite level lies a closed hollow, but so does matter.
    hollow = (levels > heights) & (distance >= BLOCKED * step)
    numbers, count = _labelled(hollow)
    best = _largest(numbers, count, np.where(hollow, levels - heights, 0.0), step)
    if best is None:
        return None
    chosen = numbers == best
    around = _dilated(chosen)
    # A node stands for a cube, which a wall may cut.
    share = np.where(chosen, 1.0, np.clip(0.5 + distance / step, 0.0, 1.0)) * (around & (chosen | ~hollow))
    level = float(levels[chosen].max())
    if np.isfinite(level):
        at_brim = (levels == level) & (heights == level)
        # The way out passes above the rim, not through it.
        level -= min(float(distance[at_brim].min()), 1.5 * step)
        share = share * (heights <= level + step)
    else:
        level = float(heights[chosen].max()) + step
    return Basin(
        container=whole,
        origin=origin,
        step=step,
        nodes=around,
        areas=share.sum(axis=(0, 1)) * step**2,
        brim=level,
    )


def _labelled(mask: BoolArray) -> tuple[IntArray, int]:
    library: Any = ndimage
    numbers, count = library.label(mask)
    return numbers, int(count)


def _dilated(mask: BoolArray) -> BoolArray:
    library: Any = ndimage
    found: BoolArray = library.binary_dilation(mask, structure=np.ones((3, 3, 3), dtype=np.bool_))
    return found


def _largest(numbers: IntArray, count: int, depth: FloatArray, step: float) -> int | None:
    """Return the number of the largest depression that is no artefact of the grid."""
    sizes = np.bincount(numbers.ravel(), minlength=count + 1)[1:]
    deepest = np.zeros(count + 1)
    np.maximum.at(deepest, numbers.ravel(), depth.ravel())
    real = np.flatnonzero(deepest[1:] > (LEAST_DEPTH + 1) * step)
    return int(real[np.argmax(sizes[real])]) + 1 if len(real) else None

"""``wet(a)`` and ``dirty(a)``: a film lies on a's surface, as told or from when something made it so."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import runs
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import fluent
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.log.happenings import DROP, FILM, FILM_AREA, FILM_LEFT
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

FEW = 2.0
"""So many particles do not tell whether one of them did it by chance [1]."""


@fluent("wet", "o")
def wet(observation: Observation) -> Iterator[Fact]:
    """The thing's surface is wet: as told, or from when a drop touched it until something absorbent has wiped it."""
    yield from _filmed(observation, "wet")


@fluent("dirty", "o")
def dirty(observation: Observation) -> Iterator[Fact]:
    """Stuff sticks to the thing: as told, or from when a drop touched it until something absorbent has wiped it."""
    yield from _filmed(observation, "dirty")


def _filmed(observation: Observation, attribute: str) -> Iterator[Fact]:
    """Yield when a surface of each unit has a film."""
    things = observation.log.things
    told = {i for i, thing in enumerate(things) if thing.quantities.get(attribute)}
    stuffs_told = {things[i].name for i in told}
    told |= {i for i, thing in enumerate(things) if "Blob" in thing.roles and thing.whole in stuffs_told}
    films = observation.of(films_of_units)
    for unit in observation.units:
        mask, stuffs = films.get(unit, (np.zeros(observation.tick_count, dtype=np.bool_), ()))
        known = unit in told or not told.isdisjoint(observation.bodies(unit))
        mask = (mask | known) & observation.exists(unit)
        source: dict[str, float | str] = {"source": "told"} if known else {"by": " and ".join(dict.fromkeys(stuffs))}
        area = observation.of(areas_of_units).get(unit)
        for start, end in runs(mask):
            evidence = dict(source)
            if area is not None and area[start:end].any():
                evidence |= {"area": float(area[start:end].max()), "area_at_end": float(area[end - 1])}
                if not known:
                    evidence[MARGIN] = _margin(observation, area[start:end], end)
            yield observation.fact("fluent", attribute, (observation.unit_names[unit],), (start, end), evidence)


def _margin(observation: Observation, area: FloatArray, end: int) -> float:
    """Return the greatest area of a film over that of a drop, which makes a surface wet [1].

    One coarse particle is at the threshold, too, and of some it does not count how coarse they are. While it is being
    wiped off, it is the lesser of that and what is left over what counts as dry.
    """
    drop, particle, greatest = DROP ** (2 / 3), observation.log.particles.spacing**2, float(area.max())
    margin = greatest / (drop if greatest > FEW * particle else max(drop, particle))
    margin = max(margin, 1.0)
    wiped = end == observation.tick_count and area[-1] < greatest
    return min(margin, float(area[-1] / greatest) / FILM_LEFT) if wiped else margin


def films_of_units(observation: Observation) -> dict[int, tuple[BoolArray, tuple[str, ...]]]:
    """Return when each unit has a film on what its body carries, shape (T,), and with what."""
    found: dict[int, tuple[BoolArray, tuple[str, ...]]] = {}
    for thing, (mask, stuffs) in observation.of(film_masks).items():
        carrier = observation.log.carrier[:, thing]
        for body in sorted({*carrier[mask].tolist()} - {-1}):
            unit = int(observation.unit[body])
            known, others = found.get(unit, (np.zeros(observation.tick_count, dtype=np.bool_), ()))
            found[unit] = known | (mask & (carrier == body)), (*others, *stuffs)
    return found


def areas_of_units(observation: Observation) -> dict[int, FloatArray]:
    """Return the area of the films on what each unit's body carries [m^2], shape (T,), where it is known."""
    found: dict[int, FloatArray] = {}
    happenings = observation.log.happenings.get(FILM_AREA.name)
    films = observation.of(film_masks)
    if happenings is None:
        return found
    for thing in sorted({*happenings.things["thing"].tolist()} & films.keys()):
        area = np.zeros(observation.tick_count)
        for row in np.flatnonzero(happenings.things["thing"] == thing).tolist():
            area[int(happenings.tick[row]) :] = happenings.numbers["area"][row]
        area *= films[thing][0]
        carrier = observation.log.carrier[:, thing]
        for body in sorted({*carrier[area > 0].tolist()} - {-1}):
            unit = int(observation.unit[body])
            found[unit] = found.get(unit, np.zeros(observation.tick_count)) + area * (carrier == body)
    return found


def film_masks(observation: Observation) -> dict[int, tuple[BoolArray, tuple[str, ...]]]:
    """Return when each thing that becomes wet in the log is so, shape (T,), and with what."""
    happenings = observation.log.happenings.get(FILM.name)
    found: dict[int, tuple[BoolArray, tuple[str, ...]]] = {}
    if happenings is None:
        return found
    for row in range(len(happenings)):
        tick, is_wet = int(happenings.tick[row]), bool(happenings.numbers["wet"][row])
        thing, stuff = (int(happenings.things[each][row]) for each in ("thing", "stuff"))
        mask, stuffs = found.get(thing, (np.zeros(observation.tick_count, dtype=np.bool_), ()))
        mask[tick:] = is_wet
        found[thing] = mask, (*stuffs, observation.log.things[stuff].name) if is_wet else stuffs
    return found

"""What differs between individuals is drawn before a run: each quantity with a stated deviation, by seed and name."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from prolepsis.knowledge.values import Known
from prolepsis.knowledge.vocabulary import Property
from prolepsis.system.seeds import child_of

if TYPE_CHECKING:
    from prolepsis.knowledge.knowledge_base import KnowledgeBase

LEAST = 0.2
"""Share of its mean below which nothing positive is drawn [1]: so far out the normal distribution means nothing."""
TRIES = 100
"""Draws until one is within the bounds; if none is, the mean is taken."""


def draw(base: KnowledgeBase, seed: int) -> dict[tuple[str, str], Known]:
    """Return what is drawn of the physical objects, by individual and property, sorted.

    A quantity is drawn if it has its class default and that states a deviation: from the normal distribution, cut off
    at the bounds of the property and of the classes. Each is drawn by a generator of its own, a child of the seed by
    its name, so that no draw hangs on what else there is. What follows from others is not drawn, but follows.
    Individuals of one batch differ by the lesser deviation of a batch from a mean of their own, which the batch states
    or which is drawn for it.
    """
    found: dict[tuple[str, str], Known] = {}
    for name in base.objects:
        entries = [base.vocabulary.classes[c] for c in base.types.classes[name]]
        for property_name in sorted({d.property for entry in entries for d in entry.defaults if d.deviation}):
            known = base.find(name, property_name)
            if known is None or known.origin not in ("class default", "batch") or not known.deviation:
                continue
            batch = base.batch(name)
            if batch is not None and known.origin == "class default":
                known = _of_batch(known, child_of(seed, f"{batch}.{property_name}"))
            limits = [each for entry in entries for each in entry.limits if each.name == property_name]
            value = _drawn(
                known, [base.vocabulary.properties[property_name], *limits], child_of(seed, f"{name}.{property_name}")
            )
            found[name, property_name] = replace(
                known,
                value=value,
                origin="drawn",
                source=f"{known.value:g} +- {known.deviation:g} {known.unit}, {known.source}",
                certainty="",
                deviation=0.0,
            )
    return found


def _of_batch(known: Known, rng: np.random.Generator) -> Known:
    """Return the mean and deviation of one batch."""
    between = math.sqrt(known.deviation**2 - known.batch_deviation**2)
    return replace(known, value=float(known.value) + between * float(rng.normal()), deviation=known.batch_deviation)


def _drawn(known: Known, bounds: list[Property], rng: np.random.Generator) -> float:
    """Return the first draw within the bounds, in SI units; what can only be positive is not far below its mean."""
    mean = float(known.value)
    positive = any(low is not None and low >= 0.0 for each in bounds for low in (each.above, each.at_least))
    least = LEAST * mean if positive else -np.inf
    draws = rng.normal(mean, known.deviation, TRIES)
    for value in map(float, np.round(draws) if bounds[0].whole else draws):
        if math.isfinite(value) and value >= least and all(each.admits(value) for each in bounds):
            return value
    return mean

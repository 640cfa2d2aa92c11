"""Simulation-based temporal projection for everyday robot manipulation.

::

    import prolepsis

    projection = prolepsis.project("examples/dropped_egg.toml", out="out/drop")
    projection.ask("holds(broken(X), T)")

Names are imported when they are first used, so that ``import prolepsis`` is fast and needs no simulator.
"""

from __future__ import annotations

import importlib
import os

# The matrices here are small: more threads of the linear algebra library only get in each other's way, and while a
# run is computed there is one in any case (``threads``).
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

TYPE_CHECKING = False
"""As in ``typing``, whose import takes longer than all else here: Ctrl-C would come before anybody listens."""
if TYPE_CHECKING:
    from typing import Any

    from prolepsis.campaigns.campaign import Outcomes, sweep
    from prolepsis.campaigns.outcome import Grasp, judge_grasp
    from prolepsis.fluents import recognize
    from prolepsis.geometry.shape import Geom, Shape
    from prolepsis.knowledge import KnowledgeBase
    from prolepsis.log.domain import Domain
    from prolepsis.log.files import read_log, write_log
    from prolepsis.log.log import Log
    from prolepsis.log.things import Thing
    from prolepsis.log.timeline import Fact, Timeline
    from prolepsis.projection import Projection, project
    from prolepsis.scenario.scenario import Parameter, Scenario
    from prolepsis.terms.errors import (
        InputError,
        InvalidSimulationError,
        MissingToolError,
        ProlepsisError,
    )
    from prolepsis.terms.json_values import json_value
    from prolepsis.terms.reader import parse_term
    from prolepsis.terms.terms import Term, Variable, format_value

_HOMES = {
    "prolepsis.campaigns.campaign": ("Outcomes", "sweep"),
    "prolepsis.log.domain": ("Domain",),
    "prolepsis.terms.errors": ("InputError", "InvalidSimulationError", "MissingToolError", "ProlepsisError"),
    "prolepsis.fluents": ("recognize",),
    "prolepsis.knowledge": ("KnowledgeBase",),
    "prolepsis.log.log": ("Log",),
    "prolepsis.log.files": ("read_log", "write_log"),
    "prolepsis.campaigns.outcome": ("Grasp", "judge_grasp"),
    "prolepsis.projection": ("Projection", "project"),
    "prolepsis.scenario.scenario": ("Parameter", "Scenario"),
    "prolepsis.terms.json_values": ("json_value",),
    "prolepsis.terms.reader": ("parse_term",),
    "prolepsis.terms.terms": ("Term", "Variable", "format_value"),
    "prolepsis.geometry.shape": ("Geom", "Shape"),
    "prolepsis.log.things": ("Thing",),
    "prolepsis.log.timeline": ("Fact", "Timeline"),
}
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names}

__all__ = [
    "Domain",
    "Fact",
    "Geom",
    "Grasp",
    "InputError",
    "InvalidSimulationError",
    "KnowledgeBase",
    "Log",
    "MissingToolError",
    "Outcomes",
    "Parameter",
    "Projection",
    "ProlepsisError",
    "Scenario",
    "Shape",
    "Term",
    "Thing",
    "Timeline",
    "Variable",
    "format_value",
    "judge_grasp",
    "json_value",
    "parse_term",
    "project",
    "read_log",
    "recognize",
    "sweep",
    "write_log",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its home when it is first used."""
    home = _HOME_OF.get(name)
    if home is None:
        raise AttributeError(f"module 'prolepsis' has no attribute {name!r}")
    value = getattr(importlib.import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

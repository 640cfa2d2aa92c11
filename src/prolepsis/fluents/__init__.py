"""Fluents and events: how each is found in a log - of solids, liquids, agents -, one family a file."""

from __future__ import annotations

import importlib
import pkgutil

from prolepsis.fluents.recognition import recognize
from prolepsis.fluents.registry import event, fluent
from prolepsis.log.fact_types import fact_types

# Importing a family registers it, so a file put here is all that a new fluent takes.
for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["event", "fact_types", "fluent", "recognize"]

"""What hands and programs do, one family of events a file."""

from __future__ import annotations

import importlib
import pkgutil

# Importing a family registers it, so a file put here is all that a new fluent takes.
for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

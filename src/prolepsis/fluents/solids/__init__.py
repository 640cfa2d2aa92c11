"""What solids do to each other and to what they hold: one fluent or event, or a few that belong together, a file."""

from __future__ import annotations

import importlib
import pkgutil

# Importing a family registers it, so a file put here is all that a new fluent takes.
for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

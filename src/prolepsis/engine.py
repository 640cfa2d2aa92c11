"""MuJoCo as one untyped name: it has no type stubs, so this is the one place that says so."""

from __future__ import annotations

from typing import Any

import mujoco as _mujoco  # pyright: ignore[reportMissingTypeStubs]

mujoco: Any = _mujoco

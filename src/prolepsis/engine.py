"""MuJoCo as one untyped name: it has no type stubs, so this is the one place that says so."""

from __future__ import annotations

from typing import Any

import mujoco as _mujoco  # pyright: ignore[reportMissingTypeStubs]

mujoco: Any = _mujoco


def _say_nothing(message: str) -> None:
    """Keep MuJoCo from writing warnings to a file in the working folder; simulations count them and end."""
    del message


mujoco.set_mju_user_warning(_say_nothing)

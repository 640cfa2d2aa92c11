"""MuJoCo as one untyped name: it has no type stubs, so this is the one place that says so."""

from __future__ import annotations

import os
from typing import Any

from prolepsis.terms.errors import MissingToolError, brief

try:
    import mujoco as _mujoco  # pyright: ignore[reportMissingTypeStubs]
# It imports OpenGL, too, whose faults have many shapes.
except (ImportError, RuntimeError, AttributeError, OSError, TypeError) as error:
    chosen = os.environ.get("MUJOCO_GL", "off")
    cause = (
        f"cannot be imported ({brief(error)})" if chosen == "off" else f"does not start with MUJOCO_GL={brief(chosen)}"
    )
    cure = "pip install mujoco" if chosen == "off" else "unset MUJOCO_GL, or set it to egl or osmesa"
    raise MissingToolError(f"MuJoCo {cause}; {cure}") from error

mujoco: Any = _mujoco


def _say_nothing(message: str) -> None:
    """Keep MuJoCo from writing warnings to a file in the working folder; simulations count them and end."""
    del message


mujoco.set_mju_user_warning(_say_nothing)

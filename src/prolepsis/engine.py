"""MuJoCo as one untyped name: it has no type stubs, so this is the one place that says so."""

from __future__ import annotations

from typing import Any

import mujoco as _mujoco  # pyright: ignore[reportMissingTypeStubs]

mujoco: Any = _mujoco

# Otherwise MuJoCo writes its warnings to a file in the working folder. They are counted in the data, where the
# simulation looks after every tick.
mujoco.set_mju_user_warning(lambda _message: None)

"""A hard-boiled quail's egg is a quail's shell round one firm body: it cracks and does not run out."""

from __future__ import annotations

import pytest
from tests.scenes import run, scene

from prolepsis import recognize


def test_it_is_a_quail_s_shell_round_a_kernel() -> None:
    made = scene(":floor a :Floor . :egg1 a :HardBoiledQuailEgg ; :z 0.1 .")
    assert made.thing("egg1").mass == pytest.approx(0.0127, rel=1e-3)
    assert made.thing("kernel1").kind == "QuailEggKernel"


def test_it_breaks_where_a_quail_s_egg_breaks_and_nothing_is_spilled() -> None:
    timeline = recognize(run(":floor a :Floor . :egg1 a :HardBoiledQuailEgg ; :z 0.32 .", duration=0.6))
    assert timeline.select(type="broken")
    assert not timeline.select(type="spilled")

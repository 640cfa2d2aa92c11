"""What is too small, light or large for the engine is refused in our words: what, where, and what is allowed."""

from __future__ import annotations

import numpy as np
import pytest
from tests.scenes import scene

from prolepsis.engine.world import compile_world
from prolepsis.matter.shells import parts
from prolepsis.terms.errors import KnowledgeError

FLOOR = ":floor a :Floor . "
REFUSED = {
    ":k a :Block ; :on :floor ; :mass 1e-300 .": r"k: mass = 1e-300: must be finite and at least 1e-09 and at most 1",
    ":k a :Block ; :on :floor ; :length 1e-6 .": r"k: length = 1e-06: must be finite and at least 1e-05",
    ":k a :Block ; :on :floor ; :length 1e-5 ; :width 1e-5 ; :height 1e-5 .": r"k: mass = 6e-13 kg .density",
    ":k a :Block ; :on :floor ; :density 1e-300 .": r"k: density = 1e-300: must be finite and at least 0\.1",
    ":k a :Block ; :on :floor ; :length 90 ; :width 90 ; :height 90 .": r"k: mass = .* kg .density \* length .* most",
    ":k a :Cup ; :on :floor ; :thickness 1e-9 .": r"k: thickness = 1e-09: must be finite and at least 1e-05",
    ":k a :Egg ; :on :floor ; :mass 1e-9 .": r"k: its mass, 1e-09 kg, in its volume, .* is 1\.73e-05 kg/m3: must be",
    ":k a :Egg ; :on :floor ; :mass 50000 .": r"k: its mass, 5e\+04 kg, in its volume, .* kg/m3: must be",
    ":k a :Ball ; :on :floor ; :radius 2e-4 .": r"k is too small or light: k of 2.01e-08 kg and 0.4 x 0.4 x 0.4 mm has",
    ":k a :Beads ; :on :floor ; :hasPart :l . :l a :Bead ; :radius 1e-4 .": r"k is too small or light: l of",
    ":k a :MandM ; :z 0.1 ; :length 4e-3 ; :breadth 4e-3 ; :mass 1e-8 .": r"k is too small or light: k/kernel of",
    ":k a :Water ; :on :floor ; :volume 1e-300 .": r"k: volume = 1e-300: must be finite and at least 1e-10",
    ":k a :Solid ; :shape :openBox ; :z 1 ; :length 0.1 ; :width 0.1 ; :height 0.1 ; :mass 1 ; :thickness 0.06 .": (
        r"k .Solid.: thickness 0.06 m leaves no cavity; allowed: less than half its length and width"
    ),
}


@pytest.mark.parametrize(("turtle", "message"), REFUSED.items(), ids=list(REFUSED))
def test_what_is_too_small_or_large_is_refused(turtle: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message) as caught:
        compile_world(scene(FLOOR + turtle, particles=100))
    assert "mjMINVAL" not in str(caught.value)


@pytest.mark.parametrize("egg", ["MandM", "HardBoiledEgg", "Egg", "Coconut"])
def test_a_shell_that_leaves_no_room_is_refused(egg: str) -> None:
    with pytest.raises(KnowledgeError, match=r"k/shell .\w+.: shellThickness = 0.05 m: allowed: at most .* a quarter"):
        scene(f"{FLOOR}:k a :{egg} ; :on :floor .", {"k/shell.shellThickness": 0.05})


@pytest.mark.parametrize("extents", [":length 1e-3", ":height 2.0 ; :width 1e-2", ":length 0.5 ; :width 5e-4"])
def test_a_thin_sheet_soaks_up(extents: str) -> None:
    made = scene(f"{FLOOR}:s a :Sponge ; :on :floor ; :absorbs :w ; :saturation 0.5 ; {extents} . :w a :Water .")
    assert len(made.pools[0].position) == 2000


SOLIDS = (
    ":k a :Block ; :length {0} ; :width {1} ; :height {2} ; :mass {3}",
    ":k a :Ball ; :radius {0} ; :mass {3}",
    ":k a :Solid ; :shape :cylinder ; :radius {0} ; :height {1} ; :mass {3}",
    ":k a :Cup ; :radius {0} ; :height {1} ; :thickness 1e-5 ; :mass {3}",
    ":k a :Bowl ; :radius {0} ; :height {1} ; :thickness 1e-5 ; :mass {3}",
)


@pytest.mark.parametrize("solid", SOLIDS)
def test_whatever_is_within_its_bounds_is_built_or_refused_by_name(solid: str) -> None:
    rng = np.random.default_rng(1)
    for _ in range(30):
        extents, mass = 10 ** rng.uniform(-4.9, -1.0, 3), 10 ** rng.uniform(-9, 0)
        try:
            compile_world(scene(f"{solid.format(*extents, mass)} ; :z 1 ."))
        except KnowledgeError as error:
            told = ("is too small or light: k of", "leaves no cavity", "kg/m3: must be at least 0.1 and at most 30000")
            assert any(text in str(error) for text in told)


def test_the_content_of_a_nearly_empty_shell_is_where_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    known = [scene(f"{FLOOR}:k a :Egg ; :on :floor ; :mass {mass} .").pools for mass in (0.058, 0.02, 0.007)]
    monkeypatch.setattr(parts, "ROOMY", np.inf)
    whole = [scene(f"{FLOOR}:k a :Egg ; :on :floor ; :mass {mass} .").pools for mass in (0.058, 0.02, 0.007)]
    for near, far in zip(known, whole, strict=True):
        assert [pool.position.tolist() for pool in near] == [pool.position.tolist() for pool in far]
    monkeypatch.undo()
    assert scene(f"{FLOOR}:k a :Egg ; :on :floor ; :mass 0.005 .").pools

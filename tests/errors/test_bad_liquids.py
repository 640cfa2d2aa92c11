"""Liquids, vessels, meshes and sponges that cannot be: refused in one line before anything runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.cli import main

SITUATION = """\
@prefix : <https://w3id.org/prolepsis#> .
:floor a :Floor .
:table1 a :Table .
:cup1 a :Cup ; :on :table1 ; :contains :liq1 .
:liq1 a :Water ; :volume 0.0002 .
"""
SCENARIO = 'situation = "s.ttl"\nplan = "wait(0.01)"\n'
TRIANGLE = """\
solid open
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 0.1 0 0
vertex 0 0.1 0
endloop
endfacet
endsolid open
"""

REFUSED: list[tuple[str, str, str]] = [
    (
        ":cup1 a :Cup ;",
        ":cup1 a :Cup ; :roll 180.0 ;",
        "cup1 contains a liquid at the start, but as it stands it has no cavity that would hold any",
    ),
    (
        ":cup1 a :Cup ;",
        ":cup1 a :Block ;",
        "liq1 cannot be in the Block cup1, which has no cavity; needed: a Container",
    ),
    (":volume 0.0002", ":volume 0.0004", "liq1: 400 ml are to be in cup1, which holds 327.2 ml as it stands"),
    (":volume 0.0002", ":fill 1.1", "liq1: fill = 1.1: must be finite and at least 0.0001 and at most 1"),
    (
        ":liq1 a :Water ; :volume 0.0002",
        ":liq2 a :Honey ; :volume 0.0002 . :cup1 :contains :liq2 .\n:liq1 a :Water ; :volume 0.0002",
        "liq2 and liq1: 400 ml are to be in cup1, which holds 327.2 ml as it stands",
    ),
    (":volume 0.0002", ":volume -1.0", "liq1: volume = -1.0: must be finite and at least 1e-10"),
    (":volume 0.0002", ":x 0.0", "liq1 (Water) has no volume; state :volume, :mass or :fill"),
    (
        ":volume 0.0002",
        ":volume 0.0002 ; :viscosity 0.0",
        "viscosity = 0.0: must be finite and at least 1e-06 and",
    ),
    (
        ":volume 0.0002",
        ":volume 0.0002 ; :viscosity 101.0",
        "viscosity = 101.0: must be finite and at least 1e-06 and",
    ),
    (":volume 0.0002", ":volume 0.0002 ; :viscosity -1.0", "viscosity = -1.0: must be finite and at least 1e-06"),
    (
        ":volume 0.0002",
        ":volume 0.0002 ; :density 50.0",
        "liq1: density = 50 kg/m3: must be at least 100 and at most 20000 kg/m3 for a Water",
    ),
    (":volume 0.0002", ":volume 0.0002 ; :density 25000.0", "density = 25000 kg/m3: must be at least 100 and"),
    (
        ":liq1 a :Water",
        ":liq1 a :Honey ; :temperature 90.0",
        "liq1: temperature = 363.15 K: the viscosity of Honey is known from 287.15 to 343.15 K only",
    ),
    (" ; :contains :liq1", "", "liq1 (Water) is nowhere; state what :contains it, what it is :on, or what :absorbs it"),
    (
        ":liq1 a :Water",
        ":cup2 a :Cup ; :on :table1 ; :x 0.2 ; :contains :liq1 .\n:liq1 a :Water",
        "liq1 (Water) is in several places: cup1, cup2; name a liquid for each",
    ),
    (
        ":cup1 a :Cup ; :on :table1 ; :contains :liq1",
        ":sponge1 a :Block ; :on :table1 ; :saturation 0.5 ; :absorbs :liq1",
        "sponge1 (Block) absorbs liq1, but has no absorbentCapacity; state it",
    ),
    (
        ":cup1 a :Cup ; :on :table1 ; :contains :liq1",
        ":sponge1 a :Sponge ; :on :table1 ; :absorbs :liq1",
        "sponge1 (Sponge) absorbs liq1; state its :saturation, above 0 and at most 1",
    ),
    (
        ":floor a :Floor .",
        ":floor a :Floor . :sponge1 a :Sponge ; :on :table1 ; :x 0.2 ; :saturation 0.5 .",
        "sponge1 has the saturation 0.5, but of what? State the liquid that it :absorbs",
    ),
    (
        ":cup1 a :Cup ; :on :table1 ; :contains :liq1 .\n:liq1 a :Water",
        ":liq1 a :Water ; :on :table1 ; :x 0.39",
        "liq1: 200 ml would be a puddle of",
    ),
    (
        ":cup1 a :Cup ; :on :table1",
        ':cup1 a :Vessel ; :shape :mesh ; :density 2300.0 ; :file "open.stl" ; :on :table1',
        "open.stl: the mesh is not watertight; allowed: a closed surface",
    ),
    (
        ":cup1 a :Cup ; :on :table1",
        ':cup1 a :Vessel ; :shape :mesh ; :density 2300.0 ; :file "none.stl" ; :on :table1',
        "none.stl: cannot read the mesh: No such file",
    ),
    (
        ":cup1 a :Cup ; :on :table1",
        ':cup1 a :Vessel ; :shape :mesh ; :density 2300.0 ; :file "s.ttl" ; :on :table1',
        "s.ttl: cannot read the mesh: .ttl format; known: .stl, .obj, .ply, .off",
    ),
    (
        ":cup1 a :Cup ; :on :table1",
        ":cup1 a :Vessel ; :shape :mesh ; :density 2300.0 ; :on :table1",
        "cup1 (Vessel) is a mesh but has no file",
    ),
    (
        ":cup1 a :Cup ;",
        ":cup1 a :Cup ; :holeRadius 0.005 ; :holeHeight 0.088 ;",
        "cup1 (Cup): a hole of radius 0.005 m at the height 0.088 m does not fit into the wall",
    ),
    (":cup1 a :Cup ;", ":cup1 a :Cup ; :thickness 0.05 ;", "cup1 (Cup): thickness 0.05 m leaves no cavity; allowed:"),
]
PARTICLES: list[tuple[str, str]] = [
    ("particles=300000", "scenario.toml: particles = 300000: allowed: 20 to 200000"),
    ("particles=5", "scenario.toml: particles = 5: allowed: 20 to 200000"),
    ("particles=2.5", "scenario.toml: particles = 2.5: must be a whole number"),
    ("particles=many", "scenario.toml: particles = many: must be a whole number"),
]


def refused(folder: Path, capfd: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Return the one line that the command prints when it refuses."""
    assert main(["project", str(folder / "scenario.toml"), "--out", str(folder / "run"), *arguments]) == 2
    printed = capfd.readouterr()
    assert printed.out == "" and not (folder / "run").exists()
    (line,) = printed.err.splitlines()
    return line.replace(f"{folder}/", "")


@pytest.mark.parametrize(("old", "new", "message"), REFUSED, ids=[new[:60] for _, new, _ in REFUSED])
def test_what_cannot_be_filled(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], old: str, new: str, message: str
) -> None:
    assert SITUATION.count(old) == 1
    (tmp_path / "s.ttl").write_text(SITUATION.replace(old, new))
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    (tmp_path / "open.stl").write_text(TRIANGLE)
    assert message in refused(tmp_path, capfd)


@pytest.mark.parametrize(("setting", "message"), PARTICLES, ids=[setting for setting, _ in PARTICLES])
def test_too_many_or_too_few_particles(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], setting: str, message: str
) -> None:
    (tmp_path / "s.ttl").write_text(SITUATION)
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    assert message in refused(tmp_path, capfd, "--set", setting)


def test_more_particles_than_fit_into_memory_all_together(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    more = ":cup2 a :Cup ; :on :table1 ; :x 0.2 ; :contains :liq2 . :liq2 a :Water ; :volume 0.0002 .\n"
    (tmp_path / "s.ttl").write_text(SITUATION + more)
    (tmp_path / "scenario.toml").write_text("particles = 150000\n" + SCENARIO)
    line = refused(tmp_path, capfd)
    assert "particles = 150000 makes 300000 particles of all liquids; allowed: at most 200000" in line


def test_a_liquid_that_would_be_a_few_particles(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "s.ttl").write_text(SITUATION + ':liq2 a :Water ; :on :table1 ; :x 0.2 ; :volume "1 ml" .\n')
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    line = refused(tmp_path, capfd)
    assert "liq2 would be 10 particles at particles = 2000" in line and "from particles = 4000 on" in line

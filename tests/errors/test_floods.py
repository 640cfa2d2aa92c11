"""Every number that sizes something has a bound, and is held against it before anything is built."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from tests.scenes import EGG_IN_HAND, run

from prolepsis.campaigns.campaign import sweep
from prolepsis.cli import main
from prolepsis.engine.world import compile_world
from prolepsis.geometry.meshes import read_surface
from prolepsis.geometry.shape import Geom, Shape
from prolepsis.log.files import write_log
from prolepsis.log.things import FIXED, FREE, Mount, Thing
from prolepsis.report.render import render_frames, render_strip, render_video
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import InputError

EXAMPLES = Path(__file__).parents[2] / "examples"
LOG = run(EGG_IN_HAND, "wait(0.01)")


@pytest.mark.parametrize("count", [0, 20_001, 1_000_000_000])
def test_frames_without_number_are_refused(tmp_path: Path, count: int) -> None:
    with pytest.raises(InputError, match=f"{count} pictures: allowed: 1 to 20000"):
        render_frames(LOG, tmp_path / "frames", count=count)
    assert list(tmp_path.iterdir()) == []


def test_pictures_without_number_are_refused_by_the_command(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_log(LOG, tmp_path / "log")
    assert main(["render", str(tmp_path / "log"), "--frames", str(tmp_path / "f"), "--count", "1000000000"]) == 2
    assert main(["render", str(tmp_path / "log"), "--strip", str(tmp_path / "s.png"), "--count", "1000000000"]) == 2
    times = ",".join(["0"] * 101)
    assert main(["render", str(tmp_path / "log"), "--strip", str(tmp_path / "s.png"), "--times", times]) == 2
    lines = capfd.readouterr().err.splitlines()
    assert len(lines) == 3 and all(len(line) <= 300 for line in lines)
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


def test_a_strip_without_end_is_refused(tmp_path: Path) -> None:
    for times, size in (
        ([], (100, 100)),
        ([0.0] * 101, (100, 100)),
        ([0.0] * 2, (5000, 100)),
        ([0.0] * 9, (4000, 4000)),
    ):
        with pytest.raises(InputError, match="allowed: "):
            render_strip(LOG, tmp_path / "s.png", times=times, size=size)
    with pytest.raises(InputError, match="a picture of 36000 by 42000 pixels"):
        render_strip(LOG, tmp_path / "s.png", part=(0.0, 0.0, 0.01, 0.01))


def test_a_video_without_end_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a picture of 8000 by 16 pixels"):
        render_video(LOG, tmp_path / "v.mp4", size=(8000, 16))
    long = run(EGG_IN_HAND, "wait(0.7)")
    with pytest.raises(InputError, match=r"would have 36030 frames; allowed: 20000, so a speed of at least 0.0018"):
        render_video(long, tmp_path / "v.mp4", speed=0.001)


def test_a_sweep_without_end_is_refused() -> None:
    over = {"Force": list(range(1, 2000)), "seed": list(range(2000))}
    with pytest.raises(InputError, match="3998000 combinations of values; allowed: 10000"):
        sweep(EXAMPLES / "grasp_egg.toml", over)


def things(count: int, *, mount: Mount, solids: int = 1) -> Scene:
    """Return a scene of as many balls."""
    shape = Shape(geoms=(Geom(type="sphere", size=(0.01, 0.0, 0.0)),) * solids)
    return Scene(
        things=tuple(
            Thing(name=f"b{k}", kind="Ball", shape=shape, position=(0.1 * k, 0.0, 0.0), mass=0.01, mount=mount)
            for k in range(count)
        )
    )


def test_a_scene_that_is_too_large_is_told_so() -> None:
    with pytest.raises(InputError, match="the scene has 5000 things that move; allowed: 2000, since what MuJoCo"):
        compile_world(things(5000, mount=FREE))
    with pytest.raises(InputError, match="the scene has 30000 convex solids; allowed: 20000"):
        compile_world(things(10, mount=FIXED, solids=3000))
    assert np.isfinite(compile_world(things(20, mount=FREE)).model.body_mass).all()


def test_a_mesh_that_is_no_file_or_too_large_is_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.stl")
    with pytest.raises(InputError, match="it is a pipe, not a file"):
        read_surface(tmp_path / "pipe.stl")
    with (tmp_path / "large.stl").open("wb") as file:
        file.truncate(10**10)
    with pytest.raises(InputError, match="the mesh is too long: more than 67,108,864 bytes"):
        read_surface(tmp_path / "large.stl")


def test_an_error_in_a_mesh_repeats_nothing_of_it(tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_text("v secret secret secret\nf 1 2 3\n")
    with pytest.raises(InputError) as caught:
        read_surface(tmp_path / "m.obj")
    assert "secret" not in str(caught.value)


def test_too_many_individuals_are_refused_before_anything_is_concluded_of_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def conclude(*arguments: object, **named: object) -> None:
        raise AssertionError("they were counted too late")

    monkeypatch.setattr("prolepsis.knowledge.reasoning.infer_types", conclude)
    blocks = "".join(f":b{k} a :Block ; :x {k} .\n" for k in range(4001))
    (tmp_path / "s.ttl").write_text(f"@prefix : <https://w3id.org/prolepsis#> .\n{blocks}")
    (tmp_path / "s.toml").write_text('situation = "s.ttl"\nplan = "wait(0.1)"\n')
    assert main(["project", str(tmp_path / "s.toml")]) == 2
    assert capfd.readouterr().err.strip().endswith("s.ttl: has 4001 individuals; allowed: 4000")

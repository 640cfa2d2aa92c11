"""A recorded stream of a gripper is done again by a hand that flies and by one on an arm, or refused in one line."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pyarrow.csv as csv  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.parquet as parquet  # pyright: ignore[reportMissingTypeStubs]
import pytest
from tests.scenes import scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.geometry.rotations import product
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import Log
from prolepsis.programs import read_program
from prolepsis.programs.recording import read_recording
from prolepsis.projection import project
from prolepsis.robots.pr2 import PR2
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import InputError
from prolepsis.terms.reader import parse_term

EXAMPLES = Path(__file__).parents[2] / "examples"
HAND = ":floor a :Floor . :hand1 a :Gripper ; :z 1.0 ."
ROBOT = ":floor a :Floor . :pr2 a :PR2 ; :hasPart :rightGripper , :leftGripper . " + (
    ":rightGripper a :Gripper . :leftGripper a :Gripper ."
)
BLOCK = (
    HAND.replace("1.0", "0.72 ; :pitch 90.0")
    + " :table1 a :Table . :block1 a :Block ; :on :table1 ; :length 0.04 ; :width 0.04 ; :height 0.04 ."
)
ARM = [joint.name for joint in PR2.arms[0].joints]
HOME = [joint.home for joint in PR2.arms[0].joints]


FULL = {"time": [0.0, 0.1, 0.2], "dx": [0.0, 0.01, 0.02], "dy": [0.0] * 3, "dz": [0.0] * 3}


def write(file: Path, columns: Mapping[str, object]) -> None:
    """Write columns as CSV, each a list of cells."""
    cells = [np.asarray(values, dtype=object) for values in columns.values()]
    rows = [",".join(str(column[k]) for column in cells) for k in range(len(cells[0]))]
    file.write_text("\n".join([",".join(columns), *rows]) + "\n", encoding="utf-8")


@cache
def composed(turtle: str) -> Scene:
    return scene(turtle)


def replayed(folder: Path, turtle: str, columns: Mapping[str, object], hand: str = "hand1") -> Log:
    """Return the log of a hand that replays columns."""
    write(folder / "a.csv", columns)
    here = replace(composed(turtle), folder=folder)
    return simulate(compile_world(here), read_program(parse_term(f"replay({hand}, 'a.csv')"), here))


def pads_of(log: Log) -> FloatArray:
    """Return where the frame of the PR2's right gripper was: place and orientation, shape (T, 7)."""
    palm = log.poses[:, log.index("pr2/r_gripper_palm_link")]
    w, x, y, z = palm[:, 3:].T
    forward = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=1)
    return np.concatenate([palm[:, :3] + 0.18 * forward, palm[:, 3:]], axis=1)


def loop(seconds: float) -> tuple[FloatArray, FloatArray]:
    """Return times of a loop [s] and displacements along x, y, z from its start [m], shape (n, 3)."""
    time = np.round(np.arange(0.0, seconds + 1e-9, 0.05), 3)
    share = time / seconds
    phase = 2 * np.pi * share**3 * (10 - 15 * share + 6 * share**2)
    return time, np.stack([0.05 * np.cos(phase) - 0.05, 0.08 * np.sin(phase), 0.05 * np.sin(2 * phase)], axis=1)


def test_a_free_hand_is_where_it_was_recorded(tmp_path: Path) -> None:
    time, ways = loop(2.0)
    yaws = 0.4 * np.sin(np.pi * time)
    columns = {"time": time, "dx": ways[:, 0], "dy": ways[:, 1], "dz": ways[:, 2]}
    log = replayed(tmp_path, HAND, {**columns, "yaw": yaws, "pitch": 0 * yaws, "roll": 0 * yaws})
    (action,) = log.actions
    assert (str(action.term), action.outcome) == ("replay(hand1,'a.csv')", "done")
    rows = action.start + np.rint(time * 1000).astype(int)
    palm = log.poses[rows, log.index("hand1/palm")]
    # The servo lags by some hundredths of a millimetre where the speed changes.
    assert palm[:, :3] == pytest.approx(ways + (0.0, 0.0, 1.0), abs=1e-3)
    assert 2 * np.arctan2(palm[:, 6], palm[:, 3]) == pytest.approx(yaws, abs=0.01)


def test_an_arm_is_where_it_was_recorded(tmp_path: Path) -> None:
    hand = composed(ROBOT).thing("rightGripper")
    time, ways = loop(2.5)
    places = ways + hand.position
    rotations = [
        product((math.cos(a / 2), 0.0, 0.0, math.sin(a / 2)), hand.orientation) for a in 0.3 * np.sin(3 * time)
    ]
    columns = {"time": time, **dict(zip("xyz", places.T, strict=True))}
    columns |= dict(zip(("qw", "qx", "qy", "qz"), np.array(rotations).T, strict=True))
    log = replayed(tmp_path, ROBOT, columns, "rightGripper")
    assert log.actions[0].outcome == "done"
    seen = pads_of(log)[np.rint(time * 1000).astype(int) + log.actions[0].start]
    # At up to 4 m/s^2, a servo of 10 Hz lags by 4 / (2 pi 10)^2 = 1 mm; those of several joints add up.
    assert np.linalg.norm(seen[:, :3] - places, axis=1).max() < 5e-3
    assert np.abs((seen[:, 3:] * rotations).sum(axis=1)).min() > math.cos(0.02)
    assert float(log.actions[0].evidence["behind"]) < 3e-3


def test_joints_of_an_arm_are_replayed_too(tmp_path: Path) -> None:
    time = np.arange(0.0, 1.51, 0.1)
    still = {name: np.full(16, home) for name, home in zip(ARM, HOME, strict=True)}
    columns = {**still, "time": time, ARM[0]: HOME[0] - 0.3 * (1 - np.cos(2 * np.pi * time / 3.0))}
    log = replayed(tmp_path, ROBOT, columns, "rightGripper")
    assert log.actions[0].outcome == "done"
    shoulder = np.array(composed(ROBOT).thing("pr2/r_shoulder_pan_link").position)
    start, end = (pads_of(log)[k, :2] - shoulder[:2] for k in (0, -1))
    turned = np.arctan2(*end[::-1]) - np.arctan2(*start[::-1])
    assert turned == pytest.approx(-0.6, abs=5e-3)


def test_the_gripper_does_what_was_recorded(tmp_path: Path) -> None:
    time = np.round(np.arange(0.0, 3.01, 0.1), 2)
    force = np.where((time > 0.3) & (time < 2.5), 8.0, 0.0)
    rise = 0.05 * np.clip((time - 1.7) / 0.5, 0.0, 1.0)
    columns = {"time": time, "dx": 0 * time, "dy": 0 * time, "dz": rise, "opening": 0 * time + 0.05, "force": force}
    log = replayed(tmp_path, BLOCK, columns)
    assert log.actions[0].evidence["peak_pad_force"] == pytest.approx(8.0, rel=0.03)
    block = log.poses[:, log.index("block1"), 2]
    # It is lifted, and falls back when the gripper opens.
    assert block.max() - block[0] == pytest.approx(0.05, abs=2e-3)
    assert block[-1] == pytest.approx(block[0], abs=1e-3)


def test_a_hand_goes_to_where_the_recording_starts(tmp_path: Path) -> None:
    time = np.array([0.0, 0.1, 0.2])
    log = replayed(tmp_path, HAND, {"time": time + 5.0, "x": time / 10 + 0.2, "y": 0 * time, "z": 0 * time + 1.1})
    assert log.actions[0].end > 900
    assert log.poses[-1, log.index("hand1/palm"), :3] == pytest.approx((0.22, 0.0, 1.1), abs=1e-3)


def test_parquet_tells_the_same_as_csv(tmp_path: Path) -> None:
    rotations = {"yaw": [0.0, 0.1, 0.2], "pitch": [0.5] * 3, "roll": [0.0] * 3}
    write(tmp_path / "a.csv", {**FULL, **rotations})
    parquet.write_table(csv.read_csv(tmp_path / "a.csv"), tmp_path / "a.parquet")  # pyright: ignore
    first, second = (read_recording(tmp_path / f"a.{kind}", []) for kind in ("csv", "parquet"))
    assert first.displacements is not None and second.displacements is not None and first.orientations is not None
    assert (first.displacements == second.displacements).all() and (first.time == second.time).all()
    assert np.linalg.norm(first.orientations, axis=1) == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["wipe_replayed", "pr2_wipe_replayed"])
def test_a_shown_wiping_cleans_the_table(name: str) -> None:
    made = project(EXAMPLES / f"{name}.toml", settings={"particles": 120})
    assert made.ask("occurs(replaying(_, 'wipe_replayed.csv'), T), after(T2, T), holds(absorbs(sponge1, liq1), T2)")
    cleaned = made.ask("occurs(replaying(_, _), T1), holds(spilled(liq1), T2), allen(R, T2, T1)")
    assert [str(answer["R"]) for answer in cleaned] == ["overlaps"]


REFUSED: list[tuple[str, dict[str, object], str]] = [
    ("gap", {"time": [0.0, 0.1, 0.5]}, "a.csv: a gap of 0.4 s from 0.1 s to 0.5 s; allowed 0.2 s"),
    ("falling time", {"time": [0.0, 0.1, 0.1]}, "a.csv: row 3: time does not rise: 0.1 s after 0.1 s"),
    ("nan", {"dy": [0.0, "nan", 0.0]}, "a.csv: row 2: dy is no finite number"),
    ("hole", {"dy": [0.0, "", 0.0]}, "a.csv: row 2: dy is no finite number"),
    ("text", {"dy": [0.0, "left", 0.0]}, "a.csv: column dy holds something that is no number"),
    ("unknown", {"wrist": [0.0] * 3}, "a.csv: no column or joint named 'wrist'; known: dx, dy, dz, force, opening, "),
    ("half a quaternion", {"qw": [1.0] * 3}, "a.csv: there is qw but no qx; needed: qw, qx, qy, qz or none"),
    (
        "a long quaternion",
        {"qw": [1.0, 1.0, 2.0], "qx": [0] * 3, "qy": [0] * 3, "qz": [0] * 3},
        "a.csv: row 3: the quaternion's norm is 2, not 1",
    ),
    (
        "too fast a turn",
        {"yaw": [0.0, 0.1, 1.1], "pitch": [0.0] * 3, "roll": [0.0] * 3},
        "a.csv: row 3 (0.2 s): hand1 turns at 10 rad/s, allowed 6 rad/s",
    ),
    (
        "too wide",
        {"opening": [0.0, 0.12, 0.0]},
        "row 2 (0.1 s): opening of hand1 is 0.12 m, allowed 0 to 0.09 m",
    ),
    ("too strong", {"force": [0.0, 0.0, 120.0]}, "row 3 (0.2 s): force of hand1 is 120 N, allowed 0 to 100 N"),
    (
        "two places",
        {"x": [0.0] * 3, "y": [0.0] * 3, "z": [1.0] * 3},
        "one of x, y, z or dx, dy, dz or the arm's joints must tell where the hand is; given: x, y, z and dx, dy, dz",
    ),
]


@pytest.mark.parametrize(("columns", "message"), [row[1:] for row in REFUSED], ids=[row[0] for row in REFUSED])
def test_a_bad_stream(tmp_path: Path, columns: dict[str, object], message: str) -> None:
    write(tmp_path / "a.csv", {**FULL, **columns})
    with pytest.raises(InputError, match=re.escape(message)):
        read_program(parse_term("replay(hand1, 'a.csv')"), replace(composed(HAND), folder=tmp_path))


@pytest.mark.parametrize(
    ("plan", "message"),
    [
        ("replay(hand1, 'b.csv')", r"plan: file of replay\(hand1,'b.csv'\): there is no file .*b\.csv"),
        ("replay(hand1, 3)", r"file of replay\(hand1,3\) must be the name of a file, such as 'wipe.csv'"),
        ("replay(hand1, 'far.csv')", r"far.csv: row 2 \(0.1 s\): out of reach of hand1: 1.60 m away, allowed 1.5 m"),
        ("replay(hand1, 'short.csv')", r"short.csv: 1 rows; at least 2 are needed"),
        ("replay(hand1, 'timeless.csv')", r"timeless.csv: there is no column time \[s\]"),
        ("replay(hand1, 'bad.parquet')", r"bad.parquet: cannot read the recording"),
    ],
)
def test_a_bad_file(tmp_path: Path, plan: str, message: str) -> None:
    write(tmp_path / "far.csv", {"time": [0.0, 0.1], "x": [1.4, 1.6], "y": [0.0, 0.0], "z": [1.0, 1.0]})
    write(tmp_path / "short.csv", {"time": [0.0], "dx": [0.0], "dy": [0.0], "dz": [0.0]})
    write(tmp_path / "timeless.csv", {"dx": [0.0] * 2, "dy": [0.0] * 2, "dz": [0.0] * 2})
    (tmp_path / "bad.parquet").write_text("no table", encoding="utf-8")
    with pytest.raises(InputError, match=message):
        read_program(parse_term(plan), replace(composed(HAND), folder=tmp_path))


JOINTS: list[tuple[str, dict[str, object], str]] = [
    ("another robot's", {"panda_joint1": [0.0] * 3}, "no column or joint named 'panda_joint1'; known: "),
    ("missing", {}, "a.csv: there is no column r_wrist_roll_joint; needed: all joints of the arm, r_shoulder_pan"),
    (
        "out of range",
        {ARM[6]: [0.0] * 3, ARM[3]: [-1.6, -1.6, 0.2]},
        "a.csv: row 3 (0.2 s): joint r_elbow_flex_joint is 0.2 rad, allowed -2.321 to 0 rad",
    ),
    (
        "too fast",
        {ARM[6]: [0.0, 0.3, 0.9]},
        "a.csv: row 3 (0.2 s): joint r_wrist_roll_joint at 6 rad/s, allowed 3.6 rad/s",
    ),
]


@pytest.mark.parametrize(("columns", "message"), [row[1:] for row in JOINTS], ids=[row[0] for row in JOINTS])
def test_a_stream_of_joints_that_do_not_suit(tmp_path: Path, columns: dict[str, object], message: str) -> None:
    usual = {name: [home] * 3 for name, home in zip(ARM[:6], HOME[:6], strict=True)}
    write(tmp_path / "a.csv", {"time": [0.0, 0.1, 0.2], **usual, **columns})
    with pytest.raises(InputError, match=re.escape(message)):
        read_program(parse_term("replay(rightGripper, 'a.csv')"), replace(composed(ROBOT), folder=tmp_path))


def test_what_an_arm_cannot_follow_is_an_outcome(tmp_path: Path) -> None:
    time = np.arange(0.0, 3.01, 0.1)
    columns = {"time": time, "dx": 0.4 * time, "dy": 0 * time, "dz": 0 * time}
    (action,) = replayed(tmp_path, ROBOT, columns, "rightGripper").actions
    assert action.outcome == "unreachable"
    assert re.search(r"rightGripper: \d+ mm away from the recording at \d\.\d+ s", str(action.evidence["reason"]))


def test_a_free_hand_that_is_held_up_has_not_reached_the_end_of_the_recording(tmp_path: Path) -> None:
    def deep(depth: float) -> dict[str, list[float]]:
        time = [0.1 * k for k in range(11)]
        return {"time": time, "dx": [0.0] * 11, "dy": [0.0] * 11, "dz": [-depth * each for each in time]}

    above = ":floor a :Floor . :table1 a :Table . :hand1 a :Gripper ; :pitch 90.0 ; :z 0.9 ."
    (replaying,) = replayed(tmp_path, above, deep(0.25)).actions
    assert replaying.outcome == "not_reached"
    assert " mm and 0.0" in str(replaying.evidence["reason"])
    (replaying,) = replayed(tmp_path, above, deep(0.15)).actions
    assert replaying.outcome == "done"

"""An effector of another kind, with no joints to open it: a suction cup, as one class that is registered."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic.dataclasses import dataclass

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.projection import project
from prolepsis.robots.commands import CloseGripper, Command, OpenGripper
from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.effectors.kind import KINDS, EffectorKind
from prolepsis.robots.effectors.pinching import frame
from prolepsis.robots.touch import whole_of
from prolepsis.scenario.own_robot import STRICT, Name, OwnGripper
from prolepsis.scene.robot import Effector
from prolepsis.scene.running import Running

EXAMPLES = Path(__file__).parents[2] / "examples"
CUP = """<body name="cup" pos="0.05 0 0"><inertial pos="0.01 0 0" mass="0.02" diaginertia="6e-6 6e-6 6e-6"/>
  <geom type="cylinder" size="0.012 0.012" pos="0.014 0 0" euler="0 1.5708 0"/></body>"""


@dataclass(frozen=True, kw_only=True, slots=True, config=STRICT)
class Keys:
    """The keys of a suction cup."""

    cup: Name


class Suction(EffectorKind[Keys]):
    """A cup that holds what it touches by a pull; it takes things of equal sides."""

    name = "suction"
    table = Keys

    def fit(self, spec: Any, model: Any, table: Keys, given: OwnGripper, where: str) -> tuple[str, ...]:
        return ()

    def read(
        self, spec: Any, model: Any, joints: tuple[str, ...], table: Keys, given: OwnGripper, where: str
    ) -> Effector:
        return Effector(
            kind=self.name,
            palm=given.palm,
            joints=joints,
            pads=(table.cup,),
            tool=given.tool,
            tool_orientation=frame(given.forward, np.array([0.0, 1.0, 0.0]), where),
            max_force=given.max_force or 0.0,
        )

    def gap(self, spec: Any, model: Any, effector: Effector, where: str) -> Gap:
        return Gap(first=0.0, step=1.0, gaps=(0.0, 1.0), levers=(1.0, 1.0), ahead=(0.0, 0.5), across=(0.0, 0.0))

    def edit(self, spec: Any, effector: Effector, robot: str, name: str) -> None:
        pass

    def control(self, state: Running, effector: Effector, gap: Gap, robot: str, name: str) -> Sucking:
        return Sucking(state, f"{robot}/{effector.pads[0]}", name)


class Sucking:
    """Its controller."""

    def __init__(self, state: Running, cup: str, name: str) -> None:
        self.motion, self.command, self.pad_force, self.opening = 0, 0.0, 0.0, 0.0
        self._state, self._cup, self._tool, self._own = state, cup, f"{name}/tool", state.scene.index(name)
        self._held = -1
        self.bind(state)

    def bind(self, state: Running) -> None:
        self._body = int(state.model.body(self._cup).id)

    def accept(self, command: Command) -> None:
        if isinstance(command, CloseGripper):
            self.command, self.motion = command.force, -1
        elif isinstance(command, OpenGripper):
            self.command, self.motion, self.opening = 0.0, 0, command.width

    def act(self, dt: float) -> None:
        state, held = self._state, self.command > 0.0 and self._held >= 0
        bodies: IntArray = np.array([self._body, self._held] if held else [], dtype=np.int64)
        wrenches = np.zeros((len(bodies), 6))
        if held:
            site = state.data.site(self._tool)
            pull = self.command * site.xmat.reshape(3, 3)[:, 0]
            for row, body, force in zip(wrenches, bodies, (pull, -pull), strict=True):
                row[:] = [*force, *np.cross(site.xpos - state.data.xipos[body], force)]
            self.motion = 0
        state.stick(self, [(self._own, int(state.body_thing[self._held]))] if held else [])
        state.push(self, bodies, wrenches)

    def measure(self, forces: list[tuple[int, int, int, float]]) -> None:
        felt = [(force, a if b == self._body else b) for _, a, b, force in forces if self._body in (a, b)]
        self.pad_force = sum(force for force, _ in felt)
        self._held = max(felt)[1] if felt else self._held if self.command > 0.0 else -1

    def between(self, own: Collection[int], middle: FloatArray) -> tuple[str, ...]:
        return (whole_of(self._state, self._held),) if self._held >= 0 else ()

    def held(self, own: Collection[int], middle: FloatArray) -> tuple[str, ...]:
        return self.between(own, middle)


def test_a_cup_without_joints_sucks_a_block_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KINDS, "suction", Suction())
    model = (EXAMPLES / "own_jaw.xml").read_text(encoding="utf-8")
    start, end = model.index('<body name="fixed_jaw">'), model.index("</body>", model.index('<body name="moving_jaw"'))
    model = model[:start] + CUP + model[end + len("</body>") :]
    (tmp_path / "own_jaw.xml").write_text(re.sub(r'<motor joint="jaw".*?/>', "", model), encoding="utf-8")
    (tmp_path / "own_jaw.ttl").write_text((EXAMPLES / "own_jaw.ttl").read_text(encoding="utf-8"), encoding="utf-8")
    scenario = (EXAMPLES / "own_jaw.toml").read_text(encoding="utf-8")
    kept = [line for line in scenario.splitlines() if not line.startswith(("jaw", "pads", "tool"))]
    keys = ['cup = "cup"', "max_force = 10", "tool = [0.076, 0, 0]"]
    (tmp_path / "own_jaw.toml").write_text("\n".join([*kept, *keys]), encoding="utf-8")
    made = project(tmp_path / "own_jaw.toml", Force=5)
    # The arm presses the cup on the block harder than it sucks: the grasp has not the force that was asked for.
    assert {action.term.functor: action.outcome for action in made.log.actions} == {
        "grasp": "not_reached",
        **dict.fromkeys(("reach", "lift", "hold"), "done"),
    }
    lifted = made.log.poses[:, made.log.index("block1"), 2]
    assert lifted[-1] - lifted[0] == pytest.approx(0.06, abs=0.01)
    assert made.ask("holds(attached(gripper1, block1), A), occurs(lifting(gripper1, _), L), during(L, A)")

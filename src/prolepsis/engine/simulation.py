"""The one loop: program -> targets; physics step; kinds of matter; channels -> log."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from prolepsis.engine.approaching import Approaching
from prolepsis.engine.binding import Binding
from prolepsis.engine.channels import Channels, chosen_channels
from prolepsis.engine.crossing import crossings
from prolepsis.engine.gaining import Surroundings, gains
from prolepsis.engine.impacts import Impacts, moves
from prolepsis.engine.reaching import reaches
from prolepsis.engine.recording import Frames, Recorder
from prolepsis.engine.sinking import sinkings
from prolepsis.engine.state import State
from prolepsis.engine.world import World
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.happenings import happening_columns
from prolepsis.log.log import Action, Contacts, Log
from prolepsis.log.things import Thing
from prolepsis.programs.program import Program
from prolepsis.robots.commands import Begin, Command, End, Sense
from prolepsis.robots.control import Controls
from prolepsis.scene.kind import Controller
from prolepsis.scene.running import MAX_STEP, TICK
from prolepsis.system.mujoco import mujoco
from prolepsis.system.threads import one_thread
from prolepsis.terms.errors import InvalidSimulationError, Note, PlanError, ScenarioError, brief_list
from prolepsis.terms.terms import Term, format_value

SETTLING = 0.5
"""A run without a given duration goes on for this long after its program has ended [s]."""
LONGEST = 600.0
"""No run is longer than this [s]; each second of it takes about one to compute."""
LONG = 60.0
"""A run without a given duration that is longer than this [s] says so, for it may never end."""
THIN = 0.003
"""What is thinner than this [m] is named as the reason when something has gone through it."""
MAX_SPEED = 200.0
"""No thing of a household moves faster [m/s]; what does has diverged."""


@one_thread()
def simulate(
    world: World,
    program: Program,
    *,
    duration: float | None = None,
    seed: int = 1,
    max_step: float = MAX_STEP,
    monitors: Mapping[str, Sequence[str]] | None = None,
    progress: Callable[[float], None] | None = None,
    checking: Callable[[], None] | None = None,
) -> Log:
    """Run a program in a world and return the log.

    Args:
        world: The compiled scene; it is not changed.
        program: The control program.
        duration: Simulated time [s]; the program's length plus settling when None.
        seed: Seed of all that is random in the run.
        max_step: Longest substep [s]; kinds of matter ask for shorter ones.
        monitors: Thing to the names of what is logged of it; the defaults for things that are not named.
        progress: Called now and then with the simulated time [s].
        checking: Called when the run has ended and is looked through for what physics does not allow.

    Raises:
        ScenarioError: If the duration is out of range, or a monitor does not suit its thing.
        PlanError: If the plan does not end.
        InvalidSimulationError: If the physics diverges, or something passes through solid matter; the message says
            when and where.
    """
    if duration is not None and not TICK <= duration <= LONGEST:
        raise ScenarioError(f"duration: {duration:g} s is not between {TICK:g} and {LONGEST:g} s")
    state = State.of(world, seed)
    things = world.scene.things
    going = [controller for kind in world.scene.kinds for controller in kind.start(state)]
    binding = Binding(state=state, going=going)
    binding.renew()
    # Most controllers leave most of it to others.
    beginning, stepping, looking, working, ending = (
        _having(going, step) for step in ("begin_tick", "longest_step", "is_steady", "act", "end_tick")
    )
    controls = Controls.of(state)
    recorder = Recorder()
    approaching, impacts = Approaching(), Impacts()
    approaching.bind(state)
    impacts.bind(state)
    frames = Frames()
    channels = Channels(chosen_channels(world.scene, monitors))
    running: dict[Term, list[Action]] = {}
    actions: list[Action] = []
    sensed = _senses(state, controls)
    behaviour = program.start(sensed(0.0))
    ended_at: int | None = None

    def renewed() -> bool:
        if not binding.renew():
            return False
        recorder.note_version(state)
        controls.bind(state)
        approaching.bind(state)
        impacts.bind(state)
        return True

    tick = 0
    while True:
        if duration is not None:
            if tick >= round(duration / TICK):
                break
        elif ended_at is not None and tick >= ended_at + round(SETTLING / TICK):
            break
        elif tick >= round(LONGEST / TICK):
            raise PlanError(f"plan: {_going(running)} not ended after {LONGEST:g} s; shorten it or give a duration")
        elif tick == round(LONG / TICK):
            going = f"{_going(running)} not ended after {LONG:g} s"
            warnings.warn(f"plan: {going}; without a duration it is given up at {LONGEST:g} s", Note, 2)
        if progress is not None and tick % 100 == 0:
            progress(tick * TICK)

        # Program -> targets.
        for command in behaviour.step(sensed(tick * TICK)):
            _note(command, tick, running, actions)
            controls.accept(command)
        if behaviour.ended and ended_at is None:
            ended_at = tick
        controls.act(state, TICK)
        controls.publish(state)

        recorder.note_version(state)
        recorder.tick(state)
        frames.tick(state, tick)
        channels.tick(state)

        for each in beginning:
            each.begin_tick(state)
            if state.version != binding.version:
                renewed()
        if state.splits:
            state.softening.renew(state.data)
        fast = moves(state)
        needed = approaching.longest_step(state) if fast else max_step
        step = min(max_step, needed)
        for each in stepping:
            step = min(step, each.longest_step(state))
        count = math.ceil(TICK / step - 1e-9)
        model, data = state.model, state.data
        model.opt.timestep = TICK / count
        together = 1 if needed < max_step or [each for each in looking if not each.is_steady()] else count
        left = count
        while left:
            # Physics step.
            made, hit = together, False
            if fast or state.softening.applies:
                made = 0
                # A blow is over within a substep, and recorded by itself.
                while made < together and left > made and not hit:
                    hit = impacts.step(model, data, state.softening, hits=fast)
                    made += 1
            else:
                mujoco.mj_step(model, data, together)
            left -= made
            velocity = data.qvel * approaching.lever
            if not velocity.dot(velocity) <= MAX_SPEED**2 * model.nv:
                _refuse(state, tick)
            recorder.substep(state, tick, TICK * (1 if hit else made) / count, blows=needed < max_step)
            # Matter, in its one order.
            for acting in working:
                acting.act(state)
                if state.version != binding.version and renewed():
                    model, data = state.model, state.data
                    model.opt.timestep = TICK / count
                    # The forces are now those of the rebuilt model, which no step has used and no row holds yet.
                    break
        if state.warnings or any(data.warning.number.tolist()):
            _refuse(state, tick)
        for each in ending:
            each.end_tick(state)
            if state.version != binding.version:
                renewed()
        controls.measure(state)
        tick += 1
        state.tick = tick

    if checking is not None:
        checking()
    actions += [replace(action, end=tick) for begun in running.values() for action in begun]
    poses, carriers = recorder.pose_columns()
    contacts, particles = recorder.contact_columns(TICK), frames.table(state)
    _refuse_passed(things, recorder, poses, contacts)
    _refuse_gained(things, recorder, poses, recorder.surroundings(contacts, particles), np.array(world.scene.gravity))
    return Log(
        dt=TICK,
        things=things,
        time=np.arange(tick, dtype=np.float64) * TICK,
        poses=poses,
        carrier=carriers,
        contacts=contacts,
        joints=recorder.joint_columns(),
        happenings=happening_columns(state.happenings),
        channels=channels.columns(),
        actions=tuple(sorted((a for a in actions if a.end > a.start), key=lambda a: (a.start, -a.end, str(a.term)))),
        particles=particles,
        gravity=world.scene.gravity,
    )


def _having(going: Sequence[Controller], step: str) -> list[Controller]:
    """Return the controllers that do something at a step, in their order."""
    nothing: object = getattr(Controller, step)
    return [each for each in going if getattr(type(each), step) is not nothing]


def _senses(state: State, controls: Controls) -> Callable[[float], Sense]:
    """Return what tells all that can be sensed at a time [s]."""
    position, orientation = state.position, state.orientation
    pressing, attribute = state.pressing, state.attribute

    def sensed(time: float) -> Sense:
        hands, robots = controls.sense()
        return Sense(
            time=time,
            hands=hands,
            position=position,
            orientation=orientation,
            pressing=pressing,
            attribute=attribute,
            robots=robots,
        )

    return sensed


def _going(running: Mapping[Term, Sequence[Action]]) -> str:
    """Return what goes on, to be continued with what it has not done."""
    terms = [format_value(term) for term, begun in running.items() if begun]
    return f"{brief_list(terms)} {'have' if len(terms) > 1 else 'has'}" if terms else "it has"


def _note(command: Command, tick: int, running: dict[Term, list[Action]], actions: list[Action]) -> None:
    if isinstance(command, Begin):
        begun = Action(
            term=command.term, arguments=dict(command.arguments), start=tick, end=tick + 1, outcome="unfinished"
        )
        # The same action may run twice at once, as two waits that are done together.
        running.setdefault(command.term, []).append(begun)
    elif isinstance(command, End):
        begun = running[command.term].pop(0)
        evidence = dict(command.evidence)
        actions.append(replace(begun, end=max(tick, begun.end), outcome=command.outcome, evidence=evidence))


def _refuse(state: State, tick: int) -> None:
    """End the run: the physics has diverged.

    Raises:
        InvalidSimulationError: Always.
    """
    data: Any = state.data
    worst = int(np.nan_to_num(np.abs(data.qvel), nan=np.inf).argmax())
    body = state.model.body(state.model.dof_bodyid[worst]).name
    kinds = [mujoco.mjtWarning(int(k)).name for k in np.flatnonzero(data.warning.number)]
    why = f" ({', '.join(kinds)})" if kinds else ""
    raise InvalidSimulationError(f"the simulation became unstable at {tick * TICK:.3f} s at {body}{why}")


def _refuse_passed(things: Sequence[Thing], recorder: Recorder, poses: FloatArray, contacts: Contacts) -> None:
    """End the run if something has gone through solid matter, stayed in it, or touches something through it.

    Raises:
        InvalidSimulationError: If so; the message names what did it first, and when.
    """
    names, stretches = [thing.name for thing in things], recorder.stretches()
    found = [
        (each.tick, f"{names[each.mover]} has gone into {names[each.obstacle]} or through it", each.thickness)
        for each in crossings(things, poses, stretches)
    ]
    found += [
        (each.tick, f"{names[each.first]} is pressed {each.depth * 1000:.1f} mm into {names[each.second]}", np.inf)
        for each in sinkings(things, recorder.overlaps(), recorder.matters(), TICK)
    ]
    found += [
        (each.tick, f"{names[each.first]} reaches {names[each.second]} through {names[each.between]}", each.thickness)
        for each in reaches(things, poses, contacts, stretches, TICK)
    ]
    if found:
        tick, what, thickness = min(found)
        why = "contacts are too soft for such speeds or weights"
        if thickness < THIN:
            why = f"contacts are too soft for what is {thickness * 1000:.2g} mm thick"
        raise InvalidSimulationError(f"at {tick * TICK:.3f} s {what}: {why}")


def _refuse_gained(
    things: Sequence[Thing], recorder: Recorder, poses: FloatArray, around: Surroundings, gravity: FloatArray
) -> None:
    """End the run if something has gained energy from nothing.

    Raises:
        InvalidSimulationError: If so; the message names what did it first, and when.
    """
    found = min(
        gains(things, poses, around, recorder.stretches(), gravity, TICK),
        key=lambda gain: (gain.tick, gain.thing),
        default=None,
    )
    if found is not None:
        what = "is thrown back by a liquid with more than" if found.returned else "moves with more energy than"
        whose = "half of the energy that it came with" if found.returned else "it had or was given"
        raise InvalidSimulationError(
            f"at {found.tick * TICK:.3f} s {things[found.thing].name} {what} {whose}: it can rise "
            f"{found.height * 1000:.0f} mm higher than it should"
        )

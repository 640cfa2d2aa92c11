"""Breaking: a fragile thing is one rigid body until its bonds give way under the forces of contact.

Each substep the contact forces on the body load the bonds of its shell. Overloaded bonds detach, their
neighbours weaken, the load is redistributed at once (a cascade), and where the graph falls apart the parts
go on as bodies of their own, which may break again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.log.happenings import Happening, detachment
from prolepsis.matter.shells.bond_graph import BondGraph
from prolepsis.matter.shells.calibration import calibrated_graph
from prolepsis.matter.shells.cascade import Cascade, Cracking, Pressing, cascade
from prolepsis.matter.shells.contact import DAMPING_RATIO, ShellContact, closing_speed, shares_before
from prolepsis.matter.shells.crushing_front import CrushingFront, come_out, stop
from prolepsis.matter.shells.dents import ShellDents
from prolepsis.matter.shells.fragment import Fragment, calm_force
from prolepsis.matter.shells.parts import Shell
from prolepsis.matter.shells.reach import would_bear, would_go_in
from prolepsis.matter.shells.seam import begun_seam
from prolepsis.matter.shells.slow_cracks import SlowCracks
from prolepsis.matter.shells.yielding import ShellPadding, pressing_on
from prolepsis.scene.kind import Controller
from prolepsis.scene.running import MAX_STEP, Running

CONTACT_STEP = 2.5e-4
"""Substep [s] while something is near an intact shell: an egg's impact lasts some 1.5 ms, so six substeps."""
CONTACT_PHASE = 0.66
"""Greatest phase by which a shell that bounces on its contact goes on in a substep [rad]: that of a light egg, of 50 g,
at its pole. What is lighter and stiffer takes shorter ones."""
STEADY_STEP = 2.0
"""Under one steady contact a substep is longer by this factor [1]: there is no impact to follow, and contact is stable
below 2 rad. Several contacts are as stiff as all of them together."""
IMPACT_SHARE = 0.2
"""What comes closer does so in a substep by at most this part of what the shell gives until it breaks [1]."""
LINGERING = 0.9
"""What has met something presses most a millisecond later, when it no longer comes closer: by this factor a tick less
fast is it taken to be for the substep [1]."""
SHORTEST_STEP = 1.5e-5
"""No substep is shorter than this [s]."""
SQUEEZED, SQUEEZED_STEP = 1.0, 2.5e-4
"""What presses more on a fragment than this [N] gets this substep [s]: a hand that closes on pieces of some 0.2 g
shoots them away, and in one of a millisecond the solver comes to no end."""
DAMPED = 0.1
"""Share of the force under which a dent goes in that damping makes at most [1]."""
LIGHT = 0.2
"""A fragment that is pressed less than this [N] is not computed: shards break at some newtons."""
LOOK_TICKS = 4
"""Under steady forces the loads are computed anew every so many ticks."""
GROWN = 1.2
"""So are those of a fragment, whose contacts are never steady, unless its forces have grown by this factor [1]."""
STEADY_CHANGE = 0.02
"""Contact forces are steady while they change by less than this part of what the screen allows [1] ..."""
STEADY_TIME = 3.0e-3
"""... nothing is about to touch: it is farther away than the fastest motion goes in this time, three ticks [s] ..."""
STEADY_LOAD = 0.8
"""... and no bond bears more than this part of its strength [1]."""


class Breaking(Controller):
    """The controller of one fragile thing."""

    def __init__(self, state: Running, shell: Shell) -> None:
        """Look after the whole that has a ``shell``."""
        names = {thing.name: i for i, thing in enumerate(state.scene.things)}
        self.thing = thing = state.scene.thing(shell.whole)
        self.shell_name = shell.name
        self.index = names[thing.name]
        self.pieces = [names[shard] for shard in shell.shards]
        self.kernels = [names[kernel] for kernel in shell.kernels]
        a, b, c = thing.shape.geoms[0].size
        quantities = state.scene.thing(shell.name).quantities
        breaking_force = quantities["breakingForce"]
        self._cracking = Cracking(
            weakening=quantities["crackTipWeakening"],
            bears=quantities["crackedForceShare"] * breaking_force,
            most_relief=quantities["crackReliefShare"],
        )
        graph = calibrated_graph(
            (a, b, c),
            len(self.pieces),
            thickness=quantities["shellThickness"],
            youngs_modulus=quantities["youngsModulus"],
            poisson_ratio=quantities["poissonRatio"],
            fracture_strain=quantities["fractureStrain"],
            mass=thing.mass,
            breaking_force=breaking_force,
            membrane_strength=quantities.get("shellMembraneStrength", 0.0),
            membrane_stretch=quantities.get("shellMembraneStretch", 1.0),
        )
        whole = Fragment(body=thing.name, graph=graph, origin=np.zeros(3), calm=calm_force(graph))
        whole.slow = SlowCracks.of(quantities)
        self._toughness = math.sqrt(quantities["youngsModulus"] * quantities.get("fractureEnergy", 0.0))
        """Stress intensity at which a crack runs [Pa m^0.5]; 0 if it is not known."""
        self.fragments = [whole]
        self.intact = True
        self.load = 0.0
        """Greatest bond load in the tick over what it bears [1]; 0 while the screen shows that none can break."""
        self.force = 0.0
        """Greatest sum of normal forces on one body in the tick [N]."""
        self.pressed_in = 0.0
        """Depth of the deepest dent so far, over that at which it is pressed through [1]."""
        self._pressed_most, self._touches = -1, 0
        self._changed, self._fresh = False, True
        self._reached = 0.0
        """Load to which what broke it would have come [1], in that tick."""
        self._ticks = 0
        self._steady = False
        self._calm = False
        self._active = -1
        self._last: tuple[int, dict[int, float]] = (-1, {})
        self._time, self._elapsed = float(state.data.time), 0.0
        """When its loads were last looked at, and how long before that they had been [s]."""
        self._approach = 0.0
        """Speed with which something comes closer [m/s]."""
        self._fast = 0.0
        """That for which the substep is chosen [m/s]."""
        self._before: list[tuple[int, int, int, float]] = []
        """Contact forces in the substep before."""
        self._watched: dict[int, Fragment] = {}
        self._number, self._is_near, self._squeezed = -1, False, False
        self._contact = ShellContact(state, thing, quantities["plateStiffness"], quantities["poleStiffnessRatio"])
        self.front = CrushingFront()
        self.padding = ShellPadding(thing, quantities, self._contact)
        self._dents = ShellDents(thing, self.padding, self._cracking.bears, quantities.get("shellMembraneStretch", 0.0))
        self._contact.update(state, -1)
        stiffest = 2 * quantities["plateStiffness"] * math.sqrt(quantities["poleStiffnessRatio"])
        self._mass, self._give = thing.mass, breaking_force / stiffest
        self._contact_step = min(CONTACT_STEP, CONTACT_PHASE * math.sqrt(thing.mass / stiffest))

    def bind(self, state: Running) -> None:
        """Look up what it needs in a model that is new."""
        bodies = {fragment.body: fragment for fragment in self.fragments if len(fragment.graph.bonds)}
        self._watched = {state.model.body(name).id: fragment for name, fragment in bodies.items()}
        if self.intact:
            self._number = int(state.model.geom(f"{self.thing.name}/0").id)
            self.padding.bind(state)
            self._dents.bind(state)

    def begin_tick(self, state: Running) -> None:
        """Begin to look for the greatest load and force, and bring the contact's stiffness up to date."""
        self._calm = self._steady and self.load < STEADY_LOAD
        self._squeezed = not self.intact and self.force > SQUEEZED
        self.force, self.load, self._reached = 0.0, 0.0, 0.0
        self._ticks += 1
        self._fresh = self._ticks % LOOK_TICKS == 0
        self._is_near = self.intact and self._near(state)
        self._approach = closing_speed(state, self._number) if self._is_near else 0.0
        self._fast = max(self._approach, LINGERING * self._fast)
        if self.intact and (self._fresh or not self._calm):
            pressed = self._is_near and 0 <= self._pressed_most < state.data.ncon
            self._contact.update(state, self._pressed_most if pressed else -1, self._damping())

    def longest_step(self, state: Running) -> float:
        """Return the longest substep that it can do with in the coming tick [s]."""
        if not self._is_near:
            return SQUEEZED_STEP if self._squeezed else MAX_STEP
        longer = STEADY_STEP / math.sqrt(self._touches) if self._calm and self._touches else 1.0
        step = self._contact_step * max(longer, 1.0)
        return min(step, max(IMPACT_SHARE * self._give / max(self._fast, 1e-9), SHORTEST_STEP))

    def is_steady(self) -> bool:
        """Return whether no bond can come to break within a tick, so that its substeps need no look one by one.

        So it is while no contact is new or about to close and the forces hardly change.
        """
        return self._calm

    def act(self, state: Running) -> None:
        """Break what the contact forces of the last substep overload."""
        self._elapsed, self._time = float(state.data.time) - self._time, float(state.data.time)
        if not state.data.ncon:
            self._steady = False
            return
        if self.intact and self.padding:
            self.padding.give_way(state)
        totals = self._contact_totals(state)
        if self.intact and self._foresees(state, totals):
            state.renew_forces()
            totals = self._contact_totals(state)
        self._compare(state, totals)
        detached: list[Happening] = []
        for body, total in totals.items():
            fragment = self._watched[body]
            if total < fragment.calm:
                fragment.whole = 0.0
            elif self.intact or self._fresh or total > GROWN * fragment.total:
                fragment.total = total
                detached += self._check(state, body, fragment)
        self._fresh = False
        detached += self._part_at_seams(state, totals)
        if self.intact and self._dents:
            self._steady = False
            through = self._dents.grow(state)
            beyond = would_go_in(state, self._number, self._dents.yields, self._dents.deepest) if through else 1.0
            self.pressed_in = max(self.pressed_in, beyond * self._dents.share)
            if through and not self.fragments[0].parts:
                detached += self._punch(state, through, beyond)
            totals = {} if through else self._contact_totals(state)
        self.force = max(self.force, *totals.values(), 0.0)
        if self.intact:
            self._before = state.normal_forces()
        for each in detached:
            state.report(each)
        if self._changed:
            self._changed = False
            state.set_attribute(self.thing.name, "broken", 1.0)
            state.set_attribute(self.shell_name, "broken", 1.0)
            self._fall_apart(state)

    def end_tick(self, state: Running) -> None:
        """Tell load, force and how far it is pressed in."""
        told = {"load": self._reached or self.load, "force": self.force, "pressed_in": self.pressed_in}
        for name, value in told.items():
            state.set_attribute(self.thing.name, name, value)

    def _compare(self, state: Running, totals: dict[int, float]) -> None:
        """Find out whether the contacts are as they were when last looked at."""
        count, before = self._last
        self._last = (self._active, totals)
        self._steady = self._active == count and totals.keys() == before.keys()
        if self._steady:
            self._steady = all(abs(totals[b] - before[b]) < STEADY_CHANGE * self._watched[b].calm for b in totals)
        if self._steady and self._active < state.data.ncon:
            contact = state.data.contact
            distances: list[float] = contact.dist.tolist()
            speeds: list[float] = state.data.qvel.tolist()
            apart = [d for d, row in zip(distances, contact.efc_address.tolist(), strict=True) if row < 0]
            self._steady = min(apart) > STEADY_TIME * max(map(abs, speeds))

    def _contact_totals(self, state: Running) -> dict[int, float]:
        """Return the sum of the normal forces on each body that may break [N], by body."""
        totals = dict.fromkeys(self._watched, 0.0)
        self._pressed_most, self._touches, greatest = -1, 0, 0.0
        if not self.intact:
            # Shards have many contacts, and nobody asks which of theirs presses most.
            contact = state.data.contact
            rows = contact.efc_address[contact.efc_address >= 0]
            bodies = state.model.geom_bodyid[contact.geom[contact.efc_address >= 0]]
            self._active = len(rows)
            sums = np.bincount(bodies.ravel(), np.repeat(state.data.efc_force[rows], 2), state.model.nbody)
            return {body: float(sums[body]) for body in totals}
        forces = state.normal_forces()
        self._active = len(forces)
        for contact, first, second, force in forces:
            for body in (first, second):
                if body in totals:
                    totals[body] += force
                    self._touches += 1
                    if force > greatest:
                        self._pressed_most, greatest = contact, force
        return totals

    def _check(self, state: Running, body: int, fragment: Fragment) -> list[Happening]:
        """Return what breaks of a fragment that is pressed hard enough to look at its bonds."""
        if not len(fragment.graph.response):
            fragment.graph = fragment.graph.assembled()
            fragment.calm = calm_force(fragment.graph)
        forces = state.data.efc_force
        # Between looks nothing slides far: if the forces stay, so do the loads.
        if not self._fresh and fragment.is_steady(forces):
            self.load = max(self.load, fragment.stays(self._elapsed))
            return []
        pressing = self._pressing(state, body, fragment)
        shares = self._easing(state, pressing)
        # A crack runs faster than what presses moves: the force falls before that has come any farther.
        first, graph = shares(None), fragment.graph
        if self.intact:
            before = shares_before(state, self._number, self._before, pressing.numbers)
            first, graph = fragment.borne(pressing, np.minimum(before, first), first, self._elapsed)
        made = self._cascade(graph, pressing, first, shares)
        fragment.load = made.load * graph.hardening
        fragment.rows = forces.copy()
        if not made.changed:
            return []
        self._changed = True
        broken, parts = list(made.broken), made.parts
        if made.broken and not fragment.graph.cracked.any() and self.intact:
            self._reached = would_bear(state, self._number, float(first @ pressing.normal / pressing.normal.sum()))
            if self._toughness and len(parts) == 1:
                # A crack runs while the force falls to what the dent bears.
                forces = (first + made.shares) / 2 * pressing.normal
                fragment.seam = seam = begun_seam(state, self.thing, pressing, forces, parts[0], self._toughness)
                if seam:
                    cracked = seam.cracked(parts[0], self._cracking.weakening)
                    broken += parts[0].joined(cracked.cracked & ~parts[0].cracked)
                    parts = (cracked.settled(pressing.points, made.shares[:, None] * pressing.forces),)
        fragment.set(parts)
        if self.intact:
            eased, borne = made.shares < 1, made.shares * pressing.normal
            self._dents.begin(state, pressing.numbers[eased], borne[eased], self._contact.stiffness)
            self._contact.update(state, self._pressed_most, self._damping())
        return self._detached(broken, float((first * pressing.normal).max()))

    def _part_at_seams(self, state: Running, totals: Mapping[int, float]) -> list[Happening]:
        """Let fragments fall in two whose seams what presses on them draws or bends open."""
        detached: list[Happening] = []
        for body, fragment in self._watched.items():
            graph, seam = fragment.graph, fragment.seam
            if seam is None or fragment.parts or not totals[body] or not seam.across(graph).any():
                continue
            pressing = self._pressing(state, body, fragment)
            opens = seam.opens(graph, pressing.points, pressing.forces, self._toughness)
            if opens >= 1:
                crossed = seam.across(graph)
                self.pressed_in = max(self.pressed_in, opens)
                detached += self._detached(graph.joined(crossed & ~graph.cracked), float(pressing.normal.max()))
                fragment.set(graph.without(crossed).fragments())
                self._changed = True
        return detached

    def _easing(self, state: Running, pressing: Pressing) -> Callable[[float | None], FloatArray]:
        """Return what tells the shares of forces that a shell bears, cracked with a relief or before that (None)."""
        if not self.intact:
            return lambda _: np.ones(len(pressing.normal))
        return lambda relief: self._dents.shares(state, pressing.numbers, pressing.normal, relief)

    def _foresees(self, state: Running, totals: dict[int, float]) -> bool:
        """Return whether what comes closer may press hard enough in the coming substep for something to give way."""
        rise = self._contact.stiffness * self._approach * float(state.model.opt.timestep)
        limit = min(self.fragments[0].calm, self._dents.yields)
        return rise > STEADY_CHANGE * limit and max(totals.values(), default=0.0) + rise >= limit

    def _damping(self) -> float:
        """Return the damping ratio of its contacts [1]: so small that what yields is not pressed by damping alone."""
        fast = 2 * self._approach * math.sqrt(self._contact.stiffness * self._mass)
        return min(DAMPING_RATIO, DAMPED * self._dents.yields / max(fast, 1e-9))

    def _cascade(
        self, graph: BondGraph, pressing: Pressing, shares: FloatArray, ease: Callable[[float], FloatArray]
    ) -> Cascade:
        made = cascade(graph, pressing, self._cracking, shares, ease)
        self.load = max(self.load, made.worst)
        return made

    def _punch(self, state: Running, contacts: Sequence[int], beyond: float) -> list[Happening]:
        """Let the pieces come loose that a crushing front takes along from where contacts press the shell through."""
        fragment = self.fragments[0]
        graph, body = fragment.graph, state.data.body(fragment.body)
        centres = (graph.centres - fragment.origin) @ body.xmat.reshape(3, 3).T + body.xpos
        self.front.go_in(state, self._number, contacts, self._dents.yields, (self._dents.deepest, beyond))
        loose = self.front.loosens(state, centres)
        for point in state.data.contact.pos[contacts]:
            loose[np.linalg.norm(centres - point, axis=1).argmin()] = True
        pieces = np.flatnonzero(loose)
        cracking = graph.round_pieces(pieces) & ~graph.cracked
        cracked = graph.after_breaking(cracking, self._cracking.weakening)
        self._changed = True
        if not self.padding.is_pressed:
            # What is soft has stopped it otherwise.
            for contact in contacts:
                stop(state, self.thing.name, self._number, contact)
            state.renew_forces()
        fragment.set(cracked.without(cracked.round_pieces(pieces)).fragments())
        return self._detached(graph.joined(cracking), self._dents.yields)

    def _pressing(self, state: Running, body: int, fragment: Fragment) -> Pressing:
        """Return what presses on a fragment."""
        return pressing_on(state, body, fragment.origin, self.padding if self.intact else None)

    def _detached(self, broken: Sequence[tuple[int, int]], force: float) -> list[Happening]:
        return [detachment(self.index, self.pieces[a], self.pieces[b], force) for a, b in broken]

    def _fall_apart(self, state: Running) -> None:
        """Give the parts of a graph that is no longer connected bodies of their own."""
        new: list[Fragment] = []
        for fragment in self.fragments:
            parts = fragment.parts
            if not parts:
                new.append(fragment)
                continue
            groups = [[self.pieces[int(k)] for k in part.nodes] for part in parts]
            if self.intact:
                self.padding.come_out(state)
            dented = self._dents.pressing(state) if self.intact else []
            # What is firm inside goes on as a body of its own.
            firm = [[kernel] for kernel in self.kernels] if self.intact else []
            state.split(fragment.body, groups + firm)
            self.intact = False
            for part, group in zip(parts, groups, strict=True):
                part = part.with_local_peaks(self._cracking.weakening)
                lead = state.scene.things[group[0]].name
                calm = LIGHT if len(part.bonds) else math.inf
                new.append(
                    Fragment(body=lead, graph=part, origin=part.centres[0].copy(), calm=calm, seam=fragment.seam)
                )
            come_out(state, groups, dented)
        self.fragments = new

    def _near(self, state: Running) -> bool:
        """Return whether anything is near the intact thing."""
        number = self._number
        return bool(state.data.ncon) and bool([pair for pair in state.touching() if number in pair])

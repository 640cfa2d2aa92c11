"""Shells: what has a brittle shell breaks, falls apart into shards and lets out what it has inside."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from types import MappingProxyType

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.happenings import DETACHMENT
from prolepsis.log.things import Thing, friction_of, own_solids
from prolepsis.matter.shells.contact import NEAR
from prolepsis.matter.shells.parts import Membraned, Shell, egg_pools, shelled
from prolepsis.scene.kind import Building, Channel, Controller, Draft, Individuals, Kind, Made
from prolepsis.scene.running import Running
from prolepsis.scene.scene import Pool
from prolepsis.terms.errors import KnowledgeError, brief_list

OF_A_SHELL = (
    "cushionedBreakingForce",
    "plateStiffness",
    "poleStiffnessRatio",
    "fractureStrain",
    "crackTipWeakening",
    "crackedForceShare",
    "crackReliefShare",
    "crackGrowthExponent",
    "breakingTime",
    "briefForceRatio",
    "shellMembraneStrength",
    "shellMembraneStretch",
    "shellThickness",
    "fractureEnergy",
    "pieceCount",
    "poissonRatio",
)
"""What decides how a shell breaks, beside its breakingForce."""


class Shells(Kind):
    """The kind of what has a brittle shell."""

    order = 20
    claims = "Shelled"
    roles = frozenset({"Breakable", "Membraned"})
    quantities = MappingProxyType(
        {
            **dict.fromkeys(("membraneForce", "probeRadius"), "ShellContent"),
            **dict.fromkeys(OF_A_SHELL, "Shell"),
            "adhesionStrength": "Kernel",
        }
    )
    channels = (
        Channel(
            name="load",
            doc="the greatest bond load over what it bears so fast [1], or 0 where a screen shows that none can break; "
            "once a bond breaks, what the load would have come to",
            role="Breakable",
            default=True,
        ),
        Channel(
            name="force",
            doc="the sum of the normal forces on it, greatest within the tick [N]",
            role="Breakable",
            default=True,
        ),
        Channel(
            name="pressed_in",
            doc="depth of its deepest dent so far, over that at which what lines its shell tears and it opens [1]; "
            "once it has opened, how deep it would have become",
            role="Breakable",
            default=True,
        ),
        Channel(
            name="membrane_load",
            doc="the greater of the tension round it over that at which it tears, and of how deep a blow drives edges "
            "into its egg over how deep it lies [1]",
            role="Membraned",
            default=True,
        ),
        Channel(name="broken", doc="1 once one of its bonds has detached, else 0", begins="BrokenThing"),
    )
    happenings = (DETACHMENT,)

    def refuse(self, kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
        """Refuse what is told to break that no kind breaks: none that tells of detachments claims it."""
        breaking = [kind.claims for kind in kinds if kind.claims is not None and DETACHMENT in kind.happenings]
        for name in kb.objects:
            _refuse_strength(kb, name, breaking)
            _refuse_padding(kb, name)

    def parts(self, individuals: Individuals, whole: Thing) -> Made:
        """Return it with its parts."""
        return shelled(individuals, whole)

    def fill(self, draft: Draft) -> tuple[Mapping[str, tuple[Thing, ...]], tuple[Pool, ...]]:
        """Return what flows of it once all solids are at their places."""
        found: dict[str, tuple[Thing, ...]] = {}
        pools = draft.pools
        for name, things in draft.things.items():
            if not draft.individuals.kb.is_a(name, "Shelled"):
                continue
            spacing = next((pool.spacing for pool in pools), None)
            stuffs, inside = egg_pools(things[0], [thing for thing in things if "Liquid" in thing.roles], spacing)
            known = {stuff.name: stuff for stuff in stuffs}
            found[name] = tuple(known.get(thing.name, thing) for thing in things)
            pools += inside
        return found, pools[len(draft.pools) :]

    def edit(self, building: Building) -> None:
        """Give each an explicit contact with everything else, whose stiffness breaking sets."""
        scene = building.scene
        shelled, own = {shell.whole for shell in scene.each(Shell)}, own_solids(scene.things)
        for thing in scene.things:
            for other in scene.things if thing.name in shelled else ():
                twice = other.name in shelled and other.name < thing.name
                if other is not thing and not other.emerges and not twice:
                    friction = min(friction_of(thing), friction_of(other))
                    for i, j in product(range(len(thing.shape.geoms)), own[other.name]):
                        building.add_pair(f"{thing.name}/{i}", f"{other.name}/{j}", friction, NEAR)

    def start(self, state: Running) -> Sequence[Controller]:
        """Return its controllers in one run."""
        from prolepsis.matter.shells.breaking import Breaking
        from prolepsis.matter.shells.crushing_front import CrushingFront
        from prolepsis.matter.shells.inside import Membrane, Opening

        shells, particles = state.scene.each(Shell), state.particles
        breaking = [Breaking(state, shell) for shell in shells]
        if particles is None:
            return breaking
        opening = [Opening(state, each.thing.name, each.padding) for each in breaking if particles.holds(each.index)]
        fronts = {each.index: each.front for each in breaking}
        membranes: list[Membrane] = []
        for stuff in state.scene.each(Membraned):
            own = particles.stuff == state.scene.index(stuff.name)
            membranes.append(Membrane(state, stuff, fronts.get(int(particles.holder[own][0]), CrushingFront())))
        return [*breaking, *opening, *membranes]


def _refuse_strength(kb: KnowledgeBase, name: str, breaking: Sequence[str]) -> None:
    """Refuse what does not break here though it is told to: its strength would never come to bear.

    Args:
        kb: The situation.
        name: The individual.
        breaking: The classes of what breaks.
    """
    if kb.is_a(name, "Shell") or any(kb.is_a(name, each) for each in breaking if each != Shells.claims):
        return
    known = kb.find(name, "breakingForce")
    if known is not None and known.origin != "derived":
        shells = [part for part in kb.parts(name) if kb.is_a(part, "Shell")]
        if shells:
            raise KnowledgeError(
                f"{kb.location(name)}: {name} breaks by its shell; state the breakingForce of {shells[0]}"
            )
        raise _unbreakable(kb, name, "has a breakingForce", breaking)
    if kb.whole(name) is None and kb.is_a(name, "Breakable") and not kb.is_a(name, "Shelled"):
        raise _unbreakable(kb, name, "is Breakable", breaking)


def _refuse_padding(kb: KnowledgeBase, name: str) -> None:
    """Refuse what is soft but not known how thick or stiff."""
    if kb.find(name, "densificationStrain") is None:
        return
    needed = ["youngsModulus", *(["paddingThickness"] if kb.is_a(name, "Floor") else [])]
    unknown = [each for each in needed if kb.number(name, each) is None]
    if unknown:
        raise KnowledgeError(
            f"{kb.location(name)}: {name} ({kb.kind(name)}) has a densificationStrain, but no {', '.join(unknown)}"
        )


def _unbreakable(kb: KnowledgeBase, name: str, told: str, breaking: Sequence[str]) -> KnowledgeError:
    kinds = brief_list(c for c in kb.class_names() if {*breaking} & {*kb.vocabulary.told_classes((c,))})
    return KnowledgeError(
        f"{kb.location(name)}: {name} ({kb.kind(name)}) {told}, but does not break here; what does: {kinds}"
    )


KIND = Shells()

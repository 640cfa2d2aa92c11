"""Liquids: what flows by itself, as particles that fill containers, lie on surfaces or soak what absorbs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.things import Thing
from prolepsis.matter.liquids.liquids import is_liquid, liquid_thing, placement_of, refuse_amounts
from prolepsis.scene.kind import Controller, Draft, Kind
from prolepsis.scene.running import Running
from prolepsis.scene.scene import Pool


class Liquids(Kind):
    """The kind of what flows."""

    order = 10
    quantities = MappingProxyType(
        dict.fromkeys(
            ("viscosity", "surfaceTension", "contactAngle", "recedingAngle", "volume", "fill", "relativeMolecularMass"),
            "Liquid",
        )
    )

    def flowing(self, kb: KnowledgeBase) -> Sequence[str]:
        """Return the liquids that are no part of anything."""
        return [name for name in kb.objects if is_liquid(kb, name)]

    def refuse(self, kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
        """Refuse what is told of it that cannot be so."""
        for name in self.flowing(kb):
            placement_of(kb, name)
            refuse_amounts(kb, name)

    def fill(self, draft: Draft) -> tuple[Mapping[str, tuple[Thing, ...]], tuple[Pool, ...]]:
        """Return what flows of it once all solids are at their places."""
        names = self.flowing(draft.individuals.kb)
        if not names:
            return {}, ()
        # The import takes longer than a scene without liquids.
        from prolepsis.matter.liquids.filling import fill

        liquids = [liquid_thing(draft.individuals.kb, name, draft.individuals.roles(name)) for name in names]
        placements = {name: placement_of(draft.individuals.kb, name) for name in names}
        solids = {name: tuple(thing for thing in made if thing.is_body) for name, made in draft.things.items()}
        filled, pools = fill(liquids, placements, solids, draft.resting_height, draft.particles)
        return {each.name: (each,) for each in filled}, pools

    def start(self, state: Running) -> Sequence[Controller]:
        """Return its controllers in one run."""
        if not state.scene.pools:
            return ()
        from prolepsis.matter.liquids.flowing import Flowing

        return [Flowing(state)]


KIND = Liquids()

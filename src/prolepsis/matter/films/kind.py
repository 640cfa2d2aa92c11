"""Films: what touches a liquid becomes wet, dirty and slippery, and shards that are wet stick to what they touch."""

from __future__ import annotations

from collections.abc import Sequence

from prolepsis.log.happenings import FILM, FILM_AREA
from prolepsis.scene.kind import Channel, Controller, Kind
from prolepsis.scene.parts import Kernel, Shard
from prolepsis.scene.running import Running


class Films(Kind):
    """The kind of what wets and what sticks."""

    order = 50
    channels = (
        Channel(name="wet", doc="1 while its surface is wet, else 0", begins="WetThing"),
        Channel(name="dirty", doc="1 while stuff sticks to it, else 0", begins="DirtyThing"),
    )
    happenings = (FILM, FILM_AREA)

    def start(self, state: Running) -> Sequence[Controller]:
        """Return its controllers in one run."""
        from prolepsis.matter.films.sticking import Sticking
        from prolepsis.matter.films.wetting import Wetting

        wet = state.particles is not None
        sticks = state.scene.each(Shard) and (wet or state.scene.each(Kernel))
        return [*([Wetting(state)] if wet else []), *([Sticking(state)] if sticks else [])]


KIND = Films()

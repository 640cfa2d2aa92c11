"""What solids there are now, and how far points are from them."""

from __future__ import annotations

from prolepsis.fields.signed_distance import field_of
from prolepsis.fields.solids import matrix
from prolepsis.state import State
from prolepsis.things import FloatArray


def solids_of(state: State) -> list[int]:
    """Return the things that are solid now: the own shape of an intact whole stands for its pieces."""
    things = state.world.scene.things
    return [
        i
        for i, thing in enumerate(things)
        if thing.shape.geoms
        and (carrier := int(state.carrier[i])) >= 0
        and (carrier == i or not state.world.is_body(things[carrier]))
    ]


def distance_to(state: State, index: int, places: FloatArray) -> FloatArray:
    """Return the distance of world points, shape (n, 3), to a thing where it is now [m], shape (n,)."""
    thing = state.world.scene.things[index]
    pose = state.pose(thing.name)
    return field_of(thing.shape).distance((places - pose[:3]) @ matrix(pose[3:]))

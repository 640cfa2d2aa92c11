"""From knowledge to a scene of frozen values, and from a scene to a world that can be simulated."""

from prolepsis.scene.compose import compose
from prolepsis.scene.scene import Scene
from prolepsis.scene.world import World, compile_world

__all__ = ["Scene", "World", "compile_world", "compose"]

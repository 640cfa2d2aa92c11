"""A scene of all kinds that there are, from what is known."""

from __future__ import annotations

from prolepsis.engine.placing import resting_height
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.matter.kinds import known_kinds
from prolepsis.scenario.file import DEFAULT_PARTICLES
from prolepsis.scene.compose import compose
from prolepsis.scene.robot import Robot
from prolepsis.scene.scene import Scene


def compose_scene(kb: KnowledgeBase, *, robot: Robot | None = None, particles: int = DEFAULT_PARTICLES) -> Scene:
    """Return the scene of a situation.

    Args:
        kb: The situation.
        robot: What an individual of class Robot is whose class says no more.
        particles: Number of particles of the largest liquid.

    Raises:
        KnowledgeError: If something has no shape or place that can be simulated.
    """
    return compose(kb, known_kinds(robot), resting_height, particles)

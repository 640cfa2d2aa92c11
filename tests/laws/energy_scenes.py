"""Scenes in which things fall, bounce, slide, roll and meet, as a user would write them, and how high they rebound."""

from __future__ import annotations

from tests.laws.rest_scenes import FLOOR, TABLE, ball, block, cube, cup, disc

HARD, LIQUID = 1.0, 0.25
"""Greatest height of a rebound over that of the drop [1]: of what falls on something hard, and of what falls into a
liquid, which it sets in motion."""
RAMP = FLOOR + (
    ":ramp a :Obstacle ; :z 0.3 ; :length 1.0 ; :width 0.3 ; :height 0.02 ; :pitch 20.0 ; :friction {friction!r} . "
)
"""A board that goes down by 20 degrees towards x; its upper surface is at 0.31064 m in the middle."""
SPONGE = ":b a :Sponge ; :length 0.03 ; :width 0.03 ; :height 0.03 "
SCENES: dict[str, tuple[str, float]] = {
    **{
        f"a cube of 5 cm from {high:g} m": (FLOOR + cube("b", 0.05, f":z {high + 0.025!r}"), HARD)
        for high in (0.001, 0.01, 0.1, 0.5, 1.0, 2.0)
    },
    **{
        f"a cube of {edge * 1000:g} mm from 0.3 m": (FLOOR + cube("b", edge, f":z {0.3 + edge / 2!r}"), HARD)
        for edge in (0.005, 0.01, 0.02, 0.2)
    },
    **{
        f"a ball of {radius * 1000:g} mm from 0.5 m": (FLOOR + ball("b", radius, f":z {0.5 + radius!r}"), HARD)
        for radius in (0.005, 0.03, 0.2)
    },
    "a cube on its edge from 0.3 m": (FLOOR + cube("b", 0.05, ":z 0.4 ; :pitch 45.0"), HARD),
    "a cube on its corner from 0.3 m": (FLOOR + cube("b", 0.05, ":z 0.4 ; :pitch 35.26 ; :roll 45.0"), HARD),
    "a pencil that topples": (FLOOR + disc("b", 0.004, 0.15, ":z 0.076 ; :pitch 4.0"), HARD),
    "a plank on its end that topples": (FLOOR + block("b", (0.02, 0.1, 0.5), ":z 0.252 ; :pitch 5.0"), HARD),
    "a sheet of 2 mm from 0.2 m": (FLOOR + block("b", (0.2, 0.1, 0.002), ":z 0.2"), HARD),
    "a tilted sheet of 2 mm from 0.2 m": (FLOOR + block("b", (0.2, 0.1, 0.002), ":z 0.25 ; :pitch 20.0"), HARD),
    "a coin on its edge from 0.1 m": (FLOOR + disc("b", 0.012, 0.002, ":z 0.12 ; :pitch 80.0"), HARD),
    "a ruler over the edge of a table": (TABLE + block("b", (0.3, 0.03, 0.003), ":x 0.45 ; :z 0.702"), HARD),
    "a block that slides down a slope": (
        RAMP.format(friction=0.1) + block("b", (0.1, 0.1, 0.05), ":x -0.3 ; :z 0.447 ; :pitch 20.0 ; :friction 0.1"),
        HARD,
    ),
    "a block that sticks on a slope": (
        RAMP.format(friction=0.8) + block("b", (0.1, 0.1, 0.05), ":x -0.3 ; :z 0.447 ; :pitch 20.0 ; :friction 0.8"),
        HARD,
    ),
    "a ball that rolls down a slope": (RAMP.format(friction=0.5) + ball("b", 0.03, ":x -0.3 ; :z 0.453"), HARD),
    "a ball that rolls in a bowl": (TABLE + ":c a :Bowl ; :on :table1 . " + ball("b", 0.01, ":x 0.05 ; :z 0.79"), HARD),
    "a heavy cube on a light one from 0.1 m": (
        FLOOR + cube("a", 0.05, ":on :floor ; :mass 0.1") + cube("b", 0.05, ":z 0.176 ; :mass 3.0"),
        HARD,
    ),
    "a light cube on a heavy one from 0.3 m": (
        FLOOR + cube("a", 0.05, ":on :floor ; :mass 3.0") + cube("b", 0.05, ":z 0.376 ; :mass 0.03"),
        HARD,
    ),
    "a light ball on a heavy ball from 0.3 m": (
        FLOOR + ball("a", 0.05, ":on :floor ; :mass 3.0") + ball("b", 0.03, ":z 0.431 ; :mass 0.03"),
        HARD,
    ),
    "two balls that fall together, the light one above": (
        FLOOR + ball("a", 0.05, ":z 0.35 ; :mass 3.0") + ball("b", 0.02, ":z 0.4205 ; :mass 0.03"),
        9.0,
    ),
    "five cubes that fall together": (
        FLOOR + "".join(cube(f"b{k}", 0.05, f":z {0.2 + 0.0505 * k!r}") for k in range(5)),
        HARD,
    ),
    "a ball into a pile of cubes": (
        FLOOR
        + "".join(cube(f"b{k}", 0.05, f":on :floor ; :y {0.051 * (k - 1)!r}") for k in range(3))
        + cube("d", 0.05, ":on :b1")
        + ball("b", 0.04, ":z 0.5 ; :x 0.01"),
        HARD,
    ),
    "a hard candy from 0.5 m": (FLOOR + ":b a :MandM ; :z 0.5 .", HARD),
    "an egg from 1 cm": (FLOOR + ":b a :Egg ; :z 0.032 .", HARD),
    "a boiled egg from 1 cm": (FLOOR + ":b a :HardBoiledEgg ; :z 0.032 .", HARD),
    "a cup from 2 cm": (FLOOR + ":b a :Cup ; :z 0.066 .", HARD),
    "a sponge from 0.3 m": (FLOOR + ":b a :Sponge ; :z 0.3 .", HARD),
    "a cube on a sponge from 0.1 m": (TABLE + ":a a :Sponge ; :on :table1 . " + cube("b", 0.05, ":z 0.856"), HARD),
    "a block of 1 g into water": (cup(0.4, cube("b", 0.02, ":z 0.95 ; :mass 0.001")), LIQUID),
    "a dry sponge into water": (cup(0.5, SPONGE + "; :z 1.0 ."), LIQUID),
    "a dry sponge from 5 cm into water": (cup(0.5, SPONGE + "; :z 0.81 ."), LIQUID),
    "a sponge that is let go over water": (cup(0.5, SPONGE + "; :z 0.772 ."), HARD),
    "a sponge into a bowl of water": (cup(0.5, ":b a :Sponge ; :z 0.9 .", "Bowl"), LIQUID),
    "a wooden cube into water": (cup(0.5, cube("b", 0.02, ":z 0.84")), LIQUID),
    "a steel ball into water": (cup(0.4, ball("b", 0.01, ":z 0.85 ; :density 7800.0")), LIQUID),
    "a wooden ball into a bowl of water": (cup(0.5, ball("b", 0.015, ":z 0.85"), "Bowl"), LIQUID),
    "a wooden ball that is let go over water": (cup(0.5, ball("b", 0.015, ":z 0.765"), "Bowl"), HARD),
    "water that falls into a cup with a jolt": (
        FLOOR + ":c a :Cup ; :z 0.055 ; :contains :l . :l a :Water ; :fill 0.5 .",
        HARD,
    ),
}
"""What happens, by what a person would call it: the situation, and the greatest height of a rebound."""

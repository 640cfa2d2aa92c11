"""Scenes at rest, as a user would write them: each stands so that a person would say that nothing will move."""

from __future__ import annotations

import itertools

FLOOR = ":floor a :Floor . "
TABLE = FLOOR + ":table1 a :Table . "


def block(name: str, size: tuple[float, float, float], rest: str) -> str:
    """Return a block of a length, width and height [m]."""
    x, y, z = size
    return f":{name} a :Block ; :length {x!r} ; :width {y!r} ; :height {z!r} ; {rest} . "


def cube(name: str, edge: float, rest: str) -> str:
    """Return a cube of an edge [m]."""
    return block(name, (edge, edge, edge), rest)


def ball(name: str, radius: float, rest: str) -> str:
    """Return a ball of a radius [m]."""
    return f":{name} a :Ball ; :radius {radius!r} ; {rest} . "


def disc(name: str, radius: float, height: float, rest: str) -> str:
    """Return an upright cylinder of a radius and height [m]."""
    return (
        f":{name} a :Solid ; :shape :cylinder ; :radius {radius!r} ; :height {height!r} ; :density 2400.0 ; {rest} . "
    )


def tower(count: int, size: tuple[float, float, float], rest: str = ":density 600.0", on: str = "table1") -> str:
    """Return blocks of one size on each other."""
    names = [on, *(f"b{k}" for k in range(count))]
    return "".join(block(upper, size, f":on :{lower} ; {rest}") for lower, upper in itertools.pairwise(names))


def masses(edge: float, *values: float) -> str:
    """Return cubes of masses [kg] on each other, the first lowest."""
    names = ["table1", *(f"b{k}" for k in range(len(values)))]
    return "".join(
        cube(upper, edge, f":on :{lower} ; :mass {mass!r}")
        for (lower, upper), mass in zip(itertools.pairwise(names), values, strict=True)
    )


def cup(fill: float, inside: str, kind: str = "Cup") -> str:
    """Return a vessel on a table with water up to a share of it, and something more."""
    return TABLE + f":c a :{kind} ; :on :table1 ; :contains :l . :l a :Water ; :fill {fill!r} . " + inside


SIZES = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 2.0)
SCENES: dict[str, str] = {
    **{f"a cube of {edge * 1000:g} mm on the floor": FLOOR + cube("b", edge, ":on :floor") for edge in SIZES},
    **{f"a cube of {edge * 1000:g} mm on a table": TABLE + cube("b", edge, ":on :table1") for edge in SIZES[:5]},
    **{
        f"a sheet of {thick * 1000:g} mm on a table": TABLE + block("b", (0.2, 0.1, thick), ":on :table1")
        for thick in (0.0002, 0.0005, 0.001, 0.002, 0.005)
    },
    **{
        f"a sheet of {thick * 1000:g} mm on the floor": FLOOR + block("b", (0.2, 0.1, thick), ":on :floor")
        for thick in (0.0005, 0.002)
    },
    **{f"ten sheets of {thick * 1000:g} mm": TABLE + tower(10, (0.2, 0.1, thick)) for thick in (0.001, 0.003)},
    **{
        f"a tower of {count} cubes of 5 cm": TABLE + tower(count, (0.05, 0.05, 0.05))
        for count in (2, 3, 5, 8, 10, 15, 20)
    },
    **{f"a tower of {count} flat blocks": TABLE + tower(count, (0.1, 0.1, 0.02)) for count in (5, 10, 20)},
    "a tower of 5 cubes of 1 cm": TABLE + tower(5, (0.01, 0.01, 0.01)),
    "a tower of 10 cubes of 1 cm": TABLE + tower(10, (0.01, 0.01, 0.01)),
    "a tower of 5 cubes of 30 cm": FLOOR + tower(5, (0.3, 0.3, 0.3), on="floor"),
    "a tower of 10 steel cubes": TABLE + tower(10, (0.05, 0.05, 0.05), ":density 7800.0"),
    **{
        f"{heavy:g} kg on {light:g} kg": TABLE + masses(0.07, light, heavy)
        for light, heavy in ((1.0, 1.0), (0.1, 1.0), (0.1, 3.0), (0.1, 10.0), (0.01, 10.0))
    },
    **{
        f"{light:g} kg on {heavy:g} kg": TABLE + masses(0.07, heavy, light)
        for light, heavy in ((0.1, 1.0), (0.1, 10.0), (0.01, 10.0))
    },
    "a light cube between two heavy ones": TABLE + masses(0.07, 10.0, 0.05, 10.0),
    "four cubes, each a third of the next": TABLE + masses(0.05, 0.1, 0.3, 0.9, 2.7),
    "a pyramid of six cubes": TABLE
    + "".join(cube(f"b{k}", 0.05, f":on :table1 ; :y {(k - 1) * 0.052:.3f}") for k in range(3))
    + "".join(cube(f"c{k}", 0.05, f":on :b{k}, :b{k + 1}") for k in range(2))
    + cube("d", 0.05, ":on :c0, :c1"),
    "a bridge": TABLE
    + cube("left", 0.05, ":on :table1 ; :y -0.1")
    + cube("right", 0.05, ":on :table1 ; :y 0.1")
    + block("plank", (0.05, 0.3, 0.01), ":on :left, :right"),
    "a plank that reaches over the edge by a third": TABLE + block("b", (0.3, 0.05, 0.01), ":on :table1 ; :x 0.35"),
    "a pencil on its end": TABLE + disc("b", 0.004, 0.06, ":on :table1"),
    "a coin": TABLE + disc("b", 0.012, 0.002, ":on :table1"),
    "ten coins": TABLE
    + "".join(disc(f"b{k}", 0.012, 0.002, f":on :{'table1' if k == 0 else f'b{k - 1}'}") for k in range(10)),
    "a plate on a tumbler": TABLE + disc("a", 0.03, 0.1, ":on :table1") + disc("b", 0.1, 0.01, ":on :a"),
    **{
        f"a ball of {radius * 1000:g} mm": TABLE + ball("b", radius, ":on :table1")
        for radius in (0.002, 0.01, 0.03, 0.1)
    },
    "a ball of 1 m": FLOOR + ball("b", 1.0, ":on :floor"),
    "a brick on a slope of 10 degrees": FLOOR
    + ":ramp a :Obstacle ; :z 0.3 ; :length 0.6 ; :width 0.3 ; :height 0.02 ; :pitch 10.0 . "
    + block("b", (0.2, 0.1, 0.05), ":z 0.33557 ; :pitch 10.0"),
    "an egg on a table": TABLE + ":b a :Egg ; :on :table1 .",
    "three eggs in a row": TABLE + "".join(f":b{k} a :Egg ; :on :table1 ; :y {0.06 * k!r} . " for k in range(3)),
    "an egg in a bowl": TABLE + ":c a :Bowl ; :on :table1 . :b a :Egg ; :on :c .",
    "an M&M": TABLE + ":b a :MandM ; :on :table1 .",
    "an empty cup": TABLE + ":c a :Cup ; :on :table1 .",
    "two bowls apart": TABLE + "".join(f":c{k} a :Bowl ; :on :table1 ; :y {0.17 * k - 0.2:.2f} . " for k in range(2)),
    "a cup on a cup's lid": TABLE
    + ":c a :Cup ; :on :table1 . "
    + disc("cover", 0.045, 0.004, ":on :c")
    + ":d a :Cup ; :on :cover .",
    "a cube in a cup": TABLE + ":c a :Cup ; :on :table1 . " + cube("b", 0.02, ":on :c"),
    "a ball in a bowl": TABLE + ":c a :Bowl ; :on :table1 . " + ball("b", 0.02, ":on :c"),
    "a coin in a bowl": TABLE + ":c a :Bowl ; :on :table1 . " + disc("b", 0.012, 0.002, ":on :c"),
    "a dry sponge": TABLE + ":b a :Sponge ; :on :table1 .",
    "a cup on a sponge": TABLE + ":b a :Sponge ; :on :table1 . :c a :Cup ; :on :b .",
    "a brick of 2 kg on a sponge": TABLE
    + ":b a :Sponge ; :on :table1 . "
    + block("d", (0.1, 0.06, 0.05), ":on :b ; :mass 2.0"),
    "a book on a paper": TABLE
    + block("a", (0.2, 0.1, 0.0005), ":on :table1")
    + block("b", (0.2, 0.15, 0.04), ":on :a ; :mass 1.0"),
    "a wardrobe": FLOOR + block("b", (1.0, 0.6, 2.0), ":on :floor ; :mass 80.0"),
    "a cup of water": cup(0.5, ""),
    "a bowl of water": cup(0.5, "", "Bowl"),
    "a steel cube on the bottom of a cup of water": cup(0.3, cube("b", 0.02, ":on :c ; :density 7800.0")),
    "a glass ball on the bottom of a bowl of water": cup(0.3, ball("b", 0.015, ":on :c ; :density 2500.0"), "Bowl"),
    "a cup of water on a block": TABLE
    + block("a", (0.12, 0.12, 0.05), ":on :table1")
    + ":c a :Cup ; :on :a ; :contains :l . :l a :Water ; :fill 0.5 .",
}
"""What stands where, by what a person would call it."""

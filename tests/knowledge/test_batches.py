"""What a batch states, each of its individuals takes; what none would take is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from situations import load

from prolepsis.terms.errors import InputError, KnowledgeError

OF_BLOCKS = ":b a :Batch ; {said} . :block1 a :Block ; :batch :b . :block2 a :Block ; :batch :b ."
OF_EGGS = ":b a :Batch ; {said} . :egg1 a :Egg ; :batch :b ."
OF_BOTH = f"{OF_BLOCKS} :egg1 a :Egg ; :batch :b ."


@pytest.mark.parametrize(
    ("text", "said", "message"),
    [
        (OF_BLOCKS, ":poreSize 0.001", "takes no poreSize from it; allowed: density, friction, height, length, rest"),
        (OF_BLOCKS, ":viscosity 1", "takes no viscosity"),
        (OF_BLOCKS, ":x 0.3", "takes no x from"),
        (OF_BLOCKS, ":wet true", "takes no wet"),
        (OF_BLOCKS, ":breakingForce 10", "b is a batch of Block, of which block1 takes no breakingForce"),
        # It follows from density and extents.
        (OF_BLOCKS, ":mass 10", "takes no mass"),
        # The shell, the white and the yolk have one each.
        (OF_EGGS, ":mass 0.06", "takes no mass"),
        (OF_EGGS, ":radius 0.06 ; :grainCount 3", "takes no grainCount"),
        (OF_BOTH, ":breakingForce 10", "b is a batch of Block, Egg, of which block1 takes no breakingForce"),
        (":b a :Batch ; {said} .", ":mass 10", "b is a batch to which nothing belongs"),
        (OF_EGGS, ":shape :sphere", "contradicts itself: b is a Batch"),
    ],
)
def test_what_no_individual_takes_of_its_batch_is_refused(tmp_path: Path, text: str, said: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        load(tmp_path, text.format(said=said))


@pytest.mark.parametrize(
    ("text", "said", "name"),
    [
        (OF_BLOCKS, "density 700.0", "block2"),
        (OF_BLOCKS, "friction 0.4", "block1"),
        (OF_EGGS, "breakingForce 38.0", "eggshell1"),
        (OF_EGGS, "length 0.06", "egg1"),
        (OF_BOTH, "restitution 0.2", "block1"),
    ],
)
def test_what_each_individual_takes_of_its_batch_is_known_of_it(
    tmp_path: Path, text: str, said: str, name: str
) -> None:
    word, value = said.split()
    known = load(tmp_path, text.format(said=f":{said}")).value(name, word)
    assert (known.value, known.origin) == (float(value), "batch")


def test_a_batch_that_is_told_more_later_is_refused_then(tmp_path: Path) -> None:
    base = load(tmp_path, OF_BLOCKS.format(said=":density 700.0"))
    with pytest.raises(KnowledgeError, match="override: b is a batch of Block, .* takes no viscosity"):
        base.with_values({"b.viscosity": 1.0})

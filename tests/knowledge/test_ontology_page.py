"""The example in ``docs/ontology.md`` does what the page says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase

PAGE = Path(__file__).parents[2] / "docs" / "ontology.md"


def test_the_example_of_the_page_loads_and_uses_its_class_defaults(tmp_path: Path) -> None:
    match = re.search(r"```turtle\n(.*?)```", PAGE.read_text(), re.S)
    assert match is not None
    path = tmp_path / "page.ttl"
    path.write_text(match.group(1))
    base = KnowledgeBase.load(path)
    assert base.kind("egg1") == "QuailEgg" and base.is_a("egg1", "LiquidContainer")
    assert base.quantity("egg1", "length") == 0.0349
    assert sum(base.quantity(part, "mass") for part in base.parts("egg1")) == pytest.approx(0.0127)

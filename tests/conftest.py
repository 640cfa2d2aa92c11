"""What all tests may ask for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from tests.comparing import Compare, comparing


@pytest.fixture
def compare(record_property: Callable[[str, Any], None]) -> Compare:
    """Compares with a closed form or a published number, for the page "How right is it?"."""
    return comparing(record_property)

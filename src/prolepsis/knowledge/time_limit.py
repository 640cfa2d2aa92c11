"""How long the reasoner may take, which needs no reasoner."""

from __future__ import annotations

import math
import os

from prolepsis.terms.errors import KnowledgeError

LIMIT_VARIABLE = "PROLEPSIS_REASONER_SECONDS"
"""Environment variable: seconds of the processor that one consistency check may take."""
TIME_LIMIT = 10.0
"""The same when the variable is not set [s]. A check of the built-in ontology takes a few tenths."""


def time_limit() -> float:
    """Return how long one consistency check may take [s].

    Raises:
        KnowledgeError: If the environment variable is no positive number.
    """
    text = os.environ.get(LIMIT_VARIABLE, "").strip()
    try:
        seconds = float(text) if text else TIME_LIMIT
    except ValueError:
        seconds = math.nan
    if not (math.isfinite(seconds) and seconds > 0.0):
        raise KnowledgeError(f"{LIMIT_VARIABLE} must be a number of seconds greater than 0, not {text!r}")
    return seconds

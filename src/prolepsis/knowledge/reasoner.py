"""The OWL DL reasoner, and its limit: have these axioms a model? This is the one place that knows pyhermit."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING

from prolepsis.errors import KnowledgeError, UndecidedError
from prolepsis.knowledge.axioms import Axiom

if TYPE_CHECKING:
    from pyhermit import Reasoner

LIMIT_VARIABLE = "PROLEPSIS_REASONER_SECONDS"
"""Environment variable: seconds that one consistency check may take."""

TIME_LIMIT = 10.0
"""The same when the variable is not set [s]. A check of the built-in ontology takes a few tenths."""


def ontology_text(axioms: tuple[Axiom, ...]) -> str:
    """Return the axioms as one ontology in functional syntax."""
    return "Ontology(\n" + "\n".join(axiom.text for axiom in axioms) + "\n)\n"


def _open(text: str, seconds: float) -> Reasoner:
    """Return a reasoner over an ontology in functional syntax."""
    from pyhermit import Reasoner, ReasonerConfig
    from pyowl_core import DocumentFormat, LoadOptions, load_snapshot

    return Reasoner(
        load_snapshot(text.encode(), options=LoadOptions(format=DocumentFormat.FUNCTIONAL)),
        config=ReasonerConfig(timeout=seconds),
    )


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


def is_consistent(axioms: tuple[Axiom, ...]) -> bool:
    """Return whether the axioms have a model.

    Raises:
        UndecidedError: If the reasoner runs out of time.
    """
    from pyhermit import ReasonerInterruptedError, ReasonerTimeoutError

    seconds = time_limit()
    try:
        with _open(ontology_text(axioms), seconds) as reasoner:
            return reasoner.is_consistent()
    except (ReasonerTimeoutError, ReasonerInterruptedError):
        raise UndecidedError(
            f"the reasoner could not decide within {seconds:g} s whether the knowledge base contradicts itself; "
            f"allow more with the environment variable {LIMIT_VARIABLE}, or write the new axioms more simply"
        ) from None

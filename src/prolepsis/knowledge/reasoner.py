"""The OWL DL reasoner, and its limit: have these axioms a model? This is the one place that knows pyhermit."""

from __future__ import annotations

import math
import os
import re
from typing import TYPE_CHECKING

from prolepsis.errors import KnowledgeError, UndecidedError
from prolepsis.knowledge.axioms import Axiom

if TYPE_CHECKING:
    from pyhermit import Reasoner

LIMIT_VARIABLE = "PROLEPSIS_REASONER_SECONDS"
"""Environment variable: seconds that one consistency check may take."""

TIME_LIMIT = 10.0
"""The same when the variable is not set [s]. A check of the built-in ontology takes a few tenths."""

_DECLARATION = "Declaration("
_IRI = re.compile(r"<[^<>]*>")


def ontology_text(axioms: tuple[Axiom, ...]) -> str:
    """Return the axioms as one ontology in functional syntax, without declarations of what they do not mention."""
    mentioned = {iri for axiom in axioms if not axiom.text.startswith(_DECLARATION) for iri in _IRI.findall(axiom.text)}
    # The reasoner spends most of its time on reading, and on few axioms most of that on declarations.
    texts = [
        a.text for a in axioms if not a.text.startswith(_DECLARATION) or mentioned.issuperset(_IRI.findall(a.text))
    ]
    return "Ontology(\n" + "\n".join(texts) + "\n)\n"


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
        KnowledgeError: If the axioms are not OWL 2 DL.
    """
    from pyhermit.exceptions import PyHermiTError, ReasoningAbortedError
    from pyowl_core import PyOWLCoreError

    seconds = time_limit()
    try:
        with _open(ontology_text(axioms), seconds) as reasoner:
            return reasoner.is_consistent()
    except ReasoningAbortedError:
        raise UndecidedError(
            f"the reasoner could not decide within {seconds:g} s whether the knowledge base contradicts itself; "
            f"allow more with the environment variable {LIMIT_VARIABLE}, or write the new axioms more simply"
        ) from None
    except (PyHermiTError, PyOWLCoreError) as error:
        raise KnowledgeError(f"the reasoner refuses the axioms: {' '.join(str(error).split())}") from error

"""The OWL DL reasoner, and its limit: have these axioms a model? This is the one place that knows pyhermit."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.counting import counted_on_the_right
from prolepsis.knowledge.time_limit import LIMIT_VARIABLE, time_limit
from prolepsis.terms.errors import KnowledgeError, UndecidedError

if TYPE_CHECKING:
    from pyhermit import Reasoner

CHECKS = 6
"""All checks of one knowledge base together may take so many times as long."""
LOOKING = 0.02
"""So often is looked at how much was spent [s]."""
CHARACTERS = 200_000
"""A text with more characters for each allowed second is not even read."""
MOST_SAID = 200
"""Longest text of the reasoner that is passed on."""

_UNCERTAIN = (("ObjectOneOf(", "ObjectHasValue("), ("Inverse", "Symmetric"), ("Cardinality(",))
"""Where one of each is in the axioms, pyhermit 0.2.3 finds contradictions that there are, but not all."""

_DECLARATION = "Declaration("
_IRI = re.compile(r"<[^<>]*>")


def ontology_text(axioms: tuple[Axiom, ...]) -> str:
    """Return the axioms as one ontology in functional syntax, without declarations of what they do not mention."""
    mentioned = {iri for axiom in axioms if not axiom.text.startswith(_DECLARATION) for iri in _IRI.findall(axiom.text)}
    # The reasoner spends most of its time on reading, and on few axioms most of that on declarations.
    texts = [
        a.text for a in axioms if not a.text.startswith(_DECLARATION) or mentioned.issuperset(_IRI.findall(a.text))
    ]
    return "Ontology(\n" + "\n".join(counted_on_the_right(texts)) + "\n)\n"


class Budget:
    """What the reasoner may spend on one knowledge base, in seconds of the processor: not of the clock, so that the
    answer does not depend on what else the machine does."""

    def __init__(self) -> None:
        self.each = time_limit()
        """For one check [s]."""
        self.left = CHECKS * self.each
        """For all that are to come [s]."""


@contextmanager
def _interrupted_after(reasoner: Reasoner, budget: Budget) -> Generator[None]:
    """Interrupt the reasoner when it has spent what it may."""
    began, allowed, done = time.process_time(), min(budget.each, budget.left), threading.Event()

    def watch() -> None:
        while not done.wait(LOOKING):
            if time.process_time() - began > allowed:
                reasoner.interrupt()

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        done.set()
        watcher.join()
        budget.left -= time.process_time() - began


def is_consistent(axioms: tuple[Axiom, ...], budget: Budget | None = None) -> bool:
    """Return whether the axioms have a model.

    Raises:
        UndecidedError: If the reasoner runs out of time.
        KnowledgeError: If the axioms are not OWL 2 DL.
    """
    budget = budget or Budget()
    undecided = UndecidedError(
        f"the reasoner could not decide within {budget.each:g} s of the processor whether the knowledge base "
        f"contradicts itself; allow more with the environment variable {LIMIT_VARIABLE}, or write the new axioms "
        f"more simply"
    )
    text = ontology_text(axioms)
    if budget.left <= 0.0 or len(text) > budget.each * CHARACTERS:
        raise undecided
    # Importing the reasoner takes longer than all the rest of loading a knowledge base.
    from pyhermit import Reasoner
    from pyhermit.exceptions import PyHermiTError, ReasoningAbortedError
    from pyowl_core import DocumentFormat, LoadOptions, PyOWLCoreError, load_snapshot

    try:
        snapshot = load_snapshot(text.encode(), options=LoadOptions(format=DocumentFormat.FUNCTIONAL))
        with Reasoner(snapshot) as reasoner, _interrupted_after(reasoner, budget):
            consistent = reasoner.is_consistent()
    except ReasoningAbortedError:
        raise undecided from None
    except (PyHermiTError, PyOWLCoreError) as error:
        raise KnowledgeError(f"the reasoner refuses the axioms: {_short(str(error))}") from error
    if consistent and all(any(word in text for word in words) for words in _UNCERTAIN):
        raise UndecidedError(
            "the reasoner overlooks contradictions where counts, inverses and individuals named in axioms of classes "
            "meet; say the new axioms without one of these"
        )
    return consistent


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= MOST_SAID else f"{line[: MOST_SAID - 3]}..."

"""From Turtle files to what they say and what follows from it, which is kept for the next time.

To parse the ontology and to import what parses it takes several times as long as all that is done with it then.
"""

from __future__ import annotations

import pickle
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from prolepsis.knowledge.inferred import Types
from prolepsis.knowledge.kept import keep_reading, read_reading
from prolepsis.knowledge.situation import Situation
from prolepsis.knowledge.sources import Source
from prolepsis.knowledge.time_limit import time_limit
from prolepsis.knowledge.vocabulary import Vocabulary
from prolepsis.system.sources import digest_of, digest_of_texts, sources_in

if TYPE_CHECKING:
    from prolepsis.knowledge.turtle import Document

Reading = tuple[Vocabulary, Situation, Types]
"""Classes and properties, individuals and what is said of them, and their inferred classes."""
MADE_BY = ("rdflib", "pyhermit")


def read(sources: tuple[Source, ...], *, check: bool, most: int | None) -> Reading:
    """Return what Turtle files say, as ``KnowledgeBase.load`` tells.

    Raises:
        InputError: If a file, a name, a value or the structure of parts is wrong, or the axioms contradict each other.
    """
    # Told wrongly it is refused, whether or not there is anything to check.
    time_limit()
    key = digest_of_texts((_readers(), check, most), [(_known(each), each.text) for each in sources])
    kept = read_reading(key)
    if kept is not None:
        # Its seal has been checked; nothing else may come here.
        return pickle.loads(kept)
    found = _read(sources, check=check, most=most)
    if not found[2].unchecked:
        keep_reading(key, pickle.dumps(found))
    return found


def infer(sources: tuple[Source, ...], vocabulary: Vocabulary, situation: Situation) -> Types:
    """Return the inferred classes when individuals are as a situation says, and all else as the files do.

    Raises:
        InconsistentError: If the axioms contradict each other.
    """
    from prolepsis.knowledge.reasoning import infer_types

    return infer_types(_documents(sources), vocabulary, situation, check=True)


def _read(sources: tuple[Source, ...], *, check: bool, most: int | None) -> Reading:
    from prolepsis.knowledge.constructs import refuse_unread
    from prolepsis.knowledge.declarations import read_vocabulary
    from prolepsis.knowledge.individuals import read_situation
    from prolepsis.knowledge.reasoning import infer_types
    from prolepsis.knowledge.spelling import refuse_unknown_names

    documents = _documents(sources)
    vocabulary = read_vocabulary(documents)
    refuse_unknown_names(documents, vocabulary)
    situation = read_situation(documents, vocabulary, most)
    refuse_unread(documents)
    return vocabulary, situation, infer_types(documents, vocabulary, situation, check=check)


@lru_cache(maxsize=4)
def _documents(sources: tuple[Source, ...]) -> tuple[Document, ...]:
    from prolepsis.knowledge.turtle import built_in_documents, parse_turtle

    return (*built_in_documents(), *(parse_turtle(each) for each in sources if not each.built_in))


def _known(source: Source) -> object:
    return str(source.path), str(source.path.absolute()), source.built_in, source.numbered


@lru_cache(maxsize=1)
def _readers() -> str:
    """Return a digest of all that reads and infers."""
    package = Path(__file__).parent.parent
    files = (file for room in ("knowledge", "terms") for file in sources_in(package / room, "py"))
    return digest_of([version(name) for name in MADE_BY], files)

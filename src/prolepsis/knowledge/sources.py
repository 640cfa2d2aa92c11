"""The Turtle files of a knowledge base as they are written, before anything is read of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from prolepsis.system.sources import sources_in
from prolepsis.system.text_files import read_text
from prolepsis.terms.errors import KnowledgeError

LONGEST_FILE = 16_000_000
"""Longest Turtle file [bytes]; one of so many takes a minute to read."""
NAMESPACE = "https://w3id.org/prolepsis#"
"""Every name of the ontology begins with this."""
ONTOLOGY_FOLDER = Path(__file__).parent / "ontology"
"""The Turtle files that belong to every knowledge base."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Source:
    """The text of one Turtle file."""

    path: Path
    """Where it is from."""
    text: str
    """What is written there."""
    built_in: bool = False
    """True for the ontology that comes with the package."""
    numbered: bool = True
    """Whether the lines of the text are those of the file."""


def read_source(path: Path, *, built_in: bool = False) -> Source:
    """Return the text of one Turtle file.

    Raises:
        KnowledgeError: If the file cannot be read.
    """
    text = read_text(path, "Turtle file", most=LONGEST_FILE, error=KnowledgeError)
    return Source(path=path, text=text, built_in=built_in)


@cache
def built_in_sources() -> tuple[Source, ...]:
    """Return the files of the ontology that comes with the package, sorted by name."""
    return tuple(read_source(path, built_in=True) for path in sources_in(ONTOLOGY_FOLDER, "ttl"))


def sources_of(given: Sequence[Path | Source]) -> tuple[Source, ...]:
    """Return the built-in ontology and then the files at the paths that are given, or what was read already."""
    return (*built_in_sources(), *(each if isinstance(each, Source) else read_source(each) for each in given))

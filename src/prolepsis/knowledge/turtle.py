"""Turtle files become graphs; a syntax error is told with file and line."""

from __future__ import annotations

import logging
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rdflib import Graph, URIRef
from rdflib.exceptions import ParserError
from rdflib.plugins.parsers.notation3 import BadSyntax

from prolepsis.system.text_files import read_text
from prolepsis.terms.errors import KnowledgeError, brief

# Its warnings about literals come with tracebacks; what matters of them is told where a value is read.
logging.getLogger("rdflib").addHandler(logging.NullHandler())

LONGEST_FILE = 16_000_000
"""Longest Turtle file [bytes]; one of so many takes a minute to read."""
NAMESPACE = "https://w3id.org/prolepsis#"
"""Every name of the ontology begins with this."""

ONTOLOGY_FOLDER = Path(__file__).parent / "ontology"
"""The Turtle files that belong to every knowledge base."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Document:
    """One Turtle file."""

    path: Path
    """Where it was read."""
    graph: Graph
    """Its triples."""
    built_in: bool = False
    """True for the ontology that comes with the package."""
    lines: Mapping[str, int]
    """Local name to the number of the line on which it is first written."""

    def where(self, iri: URIRef) -> str:
        """Return file and line at which ``iri`` is first written, or the file alone."""
        line = self.lines.get(local_name(iri))
        return str(self.path) if line is None else f"{self.path}:{line}"


_NAME = re.compile(r":([\w-]+(?:\.[\w-]+)*)|<[^>]*[#/]([^>#/]+)>")


def first_lines(text: str) -> Mapping[str, int]:
    """Return the number of the line on which each local name is first written, comments left out."""
    found: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("#"):
            continue
        for match in _NAME.finditer(line.split(" #", 1)[0]):
            found.setdefault(match.group(1) or match.group(2), number)
    return found


def local_name(iri: URIRef) -> str:
    """Return the name behind the last ``#`` or ``/`` of ``iri``."""
    return re.split(r"[#/]", str(iri))[-1]


def read_turtle(path: Path, *, built_in: bool = False) -> Document:
    """Read one Turtle file.

    Raises:
        KnowledgeError: If the file cannot be read or its syntax is wrong.
    """
    text = read_text(path, "Turtle file", most=LONGEST_FILE, error=KnowledgeError)
    return parse_turtle(text, path, built_in=built_in)


def parse_turtle(text: str, path: Path, *, built_in: bool = False) -> Document:
    """Return the document that ``text`` is; ``path`` is where it is from.

    Raises:
        KnowledgeError: If its syntax is wrong.
    """
    graph = Graph(bind_namespaces="none")
    try:
        graph.parse(data=text, format="turtle", publicID=path.absolute().as_uri())
    except BadSyntax as error:
        raise KnowledgeError(f"{path}:{error.lines + 1}: Turtle syntax: {_reason(error)}") from error
    except RecursionError as error:
        raise KnowledgeError(f"{path}: Turtle syntax: blank nodes or lists are nested too deeply") from error
    except (ParserError, ValueError) as error:
        raise KnowledgeError(f"{path}: Turtle syntax: {brief(error, 200)}") from error
    except (LookupError, AttributeError, TypeError, AssertionError, ArithmeticError) as error:
        # The parser stumbles over a text that ends, or turns to something else, where it does not look.
        raise KnowledgeError(f"{path}: Turtle syntax: a statement does not end as it must") from error
    return Document(path=path, graph=graph, built_in=built_in, lines=first_lines(text))


@cache
def built_in_documents() -> tuple[Document, ...]:
    """Return the files of the ontology that comes with the package, sorted by name."""
    return tuple(read_turtle(path, built_in=True) for path in sorted(ONTOLOGY_FOLDER.glob("*.ttl")))


def _reason(error: BadSyntax) -> str:
    rest = error._str.decode()[error._i :].split("\n", 1)[0].strip()  # pyright: ignore[reportPrivateUsage]
    why = brief(error._why)  # pyright: ignore[reportPrivateUsage]
    # One word: the file may be one that was not meant to be shown.
    return f"{why} at {brief(repr(rest.split()[0]), 24)}" if rest else why


def documents_of(sources: Sequence[Path | Document]) -> tuple[Document, ...]:
    """Return the built-in ontology and then the files at the paths in ``sources``, or what was read already."""
    return (*built_in_documents(), *(s if isinstance(s, Document) else read_turtle(s) for s in sources))

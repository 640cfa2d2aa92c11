"""Turtle files become graphs; a syntax error is told with file and line."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rdflib import BNode, Graph, URIRef
from rdflib.exceptions import ParserError
from rdflib.plugins.parsers.notation3 import BadSyntax

from prolepsis.errors import KnowledgeError

NAMESPACE = "https://w3id.org/prolepsis#"
"""Every name of the ontology begins with this."""

ONTOLOGY_FOLDER = Path(__file__).parent / "ontology"
"""The Turtle files that belong to every knowledge base."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Document:
    """One Turtle file."""

    path: Path
    """Where it was read."""
    text: str
    """What it says."""
    graph: Graph
    """Its triples."""
    built_in: bool = False
    """True for the ontology that comes with the package."""

    def where(self, iri: URIRef) -> str:
        """Return file and line at which ``iri`` is first written, or the file alone."""
        local = re.escape(local_name(iri))
        token = re.compile(rf"(?:[\w.-]*:{local}(?![\w-]))|<[^>]*[#/]{local}>")
        for number, line in enumerate(self.text.splitlines(), start=1):
            if token.search(line.split(" #", 1)[0] if not line.lstrip().startswith("#") else ""):
                return f"{self.path}:{number}"
        return str(self.path)


def local_name(iri: URIRef) -> str:
    """Return the name behind the last ``#`` or ``/`` of ``iri``."""
    return re.split(r"[#/]", str(iri))[-1]


def read_turtle(path: Path, *, built_in: bool = False) -> Document:
    """Read one Turtle file.

    Raises:
        KnowledgeError: If the file cannot be read or its syntax is wrong.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise KnowledgeError(f"{path}: cannot read the Turtle file: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise KnowledgeError(f"{path}: the Turtle file is not UTF-8 text") from error
    graph = Graph(bind_namespaces="none")
    try:
        graph.parse(data=text, format="turtle", publicID=path.absolute().as_uri())
    except BadSyntax as error:
        raise KnowledgeError(f"{path}:{error.lines + 1}: Turtle syntax: {_reason(error)}") from error
    except (ParserError, ValueError) as error:
        raise KnowledgeError(f"{path}: Turtle syntax: {' '.join(str(error).split())}") from error
    return Document(path=path, text=text, graph=graph, built_in=built_in)


def built_in_documents() -> tuple[Document, ...]:
    """Return the files of the ontology that comes with the package, sorted by name."""
    return tuple(read_turtle(path, built_in=True) for path in sorted(ONTOLOGY_FOLDER.glob("*.ttl")))


def _reason(error: BadSyntax) -> str:
    rest = error._str.decode()[error._i :].split("\n", 1)[0].strip()  # pyright: ignore[reportPrivateUsage]
    return f"{error._why} at {rest[:40]!r}" if rest else str(error._why)  # pyright: ignore[reportPrivateUsage]


def documents_of(paths: Sequence[Path]) -> tuple[Document, ...]:
    """Return the built-in ontology and then the files at ``paths``."""
    return (*built_in_documents(), *(read_turtle(path) for path in paths))


def is_blank(node: object) -> bool:
    """Return whether ``node`` is a blank node."""
    return isinstance(node, BNode)

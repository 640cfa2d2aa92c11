"""Turtle files become graphs; a syntax error is told with file and line."""

from __future__ import annotations

import logging
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rdflib import RDF, Graph, URIRef
from rdflib.exceptions import ParserError
from rdflib.plugins.parsers.notation3 import BadSyntax
from rdflib.term import Node

from prolepsis.knowledge.sources import NAMESPACE, Source, built_in_sources
from prolepsis.terms.errors import KnowledgeError, brief

# Its warnings about literals come with tracebacks; what matters of them is told where a value is read.
logging.getLogger("rdflib").addHandler(logging.NullHandler())

SUFFIXES = (".ttl", ".turtle")
"""How the names of Turtle files end."""
NOT_SHOWN = (
    f"this is no statement of Turtle (what it says is only shown of a file that ends in {' or '.join(SUFFIXES)})"
)
_NO_PREFIX = 'Prefix ":" not bound'


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

    def where(self, iri: Node) -> str:
        """Return file and line at which ``iri`` is first written, or the file alone."""
        line = self.lines.get(local_name(iri)) if isinstance(iri, URIRef) else None
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


def parse_turtle(source: Source) -> Document:
    """Return the document that is written.

    Raises:
        KnowledgeError: If its syntax is wrong, or a list in it is none.
    """
    path, text = source.path, source.text
    graph = Graph(bind_namespaces="none")
    try:
        graph.parse(data=text, format="turtle", publicID=path.absolute().as_uri())
    except BadSyntax as error:
        raise KnowledgeError(f"{path}:{error.lines + 1}: Turtle syntax: {_reason(error, path)}") from error
    except RecursionError as error:
        raise KnowledgeError(f"{path}: Turtle syntax: blank nodes or lists are nested too deeply") from error
    except (ParserError, ValueError) as error:
        shown = brief(error, 200) if _is_shown(path) else NOT_SHOWN
        raise KnowledgeError(f"{path}: Turtle syntax: {shown}") from error
    except (LookupError, AttributeError, TypeError, AssertionError, ArithmeticError) as error:
        # The parser stumbles over a text that ends, or turns to something else, where it does not look.
        raise KnowledgeError(f"{path}: Turtle syntax: a statement does not end as it must") from error
    lines = first_lines(text if source.numbered else "")
    _refuse_broken_lists(graph, path)
    return Document(path=path, graph=graph, built_in=source.built_in, lines=lines)


def _refuse_broken_lists(graph: Graph, path: Path) -> None:
    """Refuse a list that does not come to its end, or forks on its way: whoever follows one relies on that."""
    whole: set[Node] = {RDF.nil}
    for start in {*graph.subjects(RDF.first), *graph.subjects(RDF.rest)}:
        node, seen = start, dict[Node, None]()
        while node not in whole:
            links = [list(graph.objects(node, word)) for word in (RDF.first, RDF.rest)]
            if node in seen or any(len(each) != 1 for each in links):
                raise KnowledgeError(
                    f"{path}: a list that is written with rdf:first and rdf:rest has no end or no member somewhere; "
                    "allowed: ( ... ), or one of each and rdf:nil at the end"
                )
            seen[node] = None
            node = links[1][0]
        whole.update(seen)


@cache
def built_in_documents() -> tuple[Document, ...]:
    """Return the files of the ontology that comes with the package, sorted by name."""
    return tuple(map(parse_turtle, built_in_sources()))


def _is_shown(path: Path) -> bool:
    """Return whether a message may repeat what a file says: another file may be one that was not meant to be shown."""
    return path.suffix.lower() in SUFFIXES


def _reason(error: BadSyntax, path: Path) -> str:
    if not _is_shown(path):
        return NOT_SHOWN
    rest = error._str.decode()[error._i :].split("\n", 1)[0].strip()  # pyright: ignore[reportPrivateUsage]
    why = brief(error._why)  # pyright: ignore[reportPrivateUsage]
    if why == _NO_PREFIX:
        why += f" (write '@prefix : <{NAMESPACE}> .' before)"
    return f"{why} at {brief(repr(rest.split()[0]), 24)}" if rest else why

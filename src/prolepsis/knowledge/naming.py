"""What an individual, class or property may be called, so that plans, logs and the engine can tell things apart."""

from __future__ import annotations

import unicodedata

from rdflib import OWL, RDF, URIRef

from prolepsis.knowledge.turtle import Document, local_name
from prolepsis.terms.errors import KnowledgeError, brief

LONGEST_NAME = 100
"""Longest name [characters]."""
RESERVED = {"world": "what everything stands in"}
"""Names that the engine has given already. Those of parts that are made have a slash, which no stated name can."""


def refuse_unusable_names(document: Document) -> None:
    """Check the name of everything that a file speaks of.

    Raises:
        KnowledgeError: With file and line, if one could not be told from others, or means something else already.
    """
    graph = document.graph
    ontologies = set(graph.subjects(RDF.type, OWL.Ontology))
    for subject in sorted({s for s in graph.subjects() if isinstance(s, URIRef)} - ontologies):
        name = local_name(subject)
        where = document.where(subject)
        if not name:
            raise KnowledgeError(f"{where}: <{brief(subject)}> has no name: nothing is behind the last # or /")
        usual = unicodedata.normalize("NFKC", name)
        if not _is_word(usual) or len(name) > LONGEST_NAME:
            allowed = f"letters, digits, _, - and ., at most {LONGEST_NAME}, the first no - or ."
            raise KnowledgeError(f"{where}: {brief(repr(name))} cannot be a name; allowed: {allowed}")
        if usual != name:
            raise KnowledgeError(f"{where}: {brief(ascii(name))} looks like {brief(repr(usual))}; write it so")
        if name in RESERVED:
            raise KnowledgeError(f"{where}: {name} is {RESERVED[name]}; name it otherwise")


def _is_word(name: str) -> bool:
    return (name[0].isalnum() or name[0] == "_") and f"_{name}".translate({45: "_", 46: "_"}).isidentifier()

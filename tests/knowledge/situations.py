"""Situations written in a test."""

from __future__ import annotations

from pathlib import Path

from prolepsis.knowledge import KnowledgeBase

PREFIX = """\
@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
"""


def load(folder: Path, text: str) -> KnowledgeBase:
    """Return the knowledge base of one situation."""
    path = folder / "situation.ttl"
    path.write_text(PREFIX + text)
    return KnowledgeBase.load(path)

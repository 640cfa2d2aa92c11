"""Knowledge: the ontology, the situation, and the values that both give."""

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.knowledge.values import Known

__all__ = ["KnowledgeBase", "Known"]

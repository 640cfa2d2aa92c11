"""When a fact is said to lie near its threshold."""

from __future__ import annotations

from prolepsis.log.timeline import Evidence

MARGIN = "margin"
"""Evidence: what decided a fact over its threshold, at the instant that decided [1]. Most facts hold above theirs; what
holds below a limit, as a grip in which little slips, has a margin below 1."""
NEAR = 0.2
"""Within this share of its threshold a fact might as well have been otherwise [1]."""
ROUNDING = 1.0e-9
"""By which a sum of shares may miss it [1]."""


def is_near(evidence: Evidence) -> bool:
    """Return whether what decided a fact lies within a fifth of its threshold."""
    margin = evidence.get(MARGIN)
    return isinstance(margin, int | float) and abs(margin - 1) <= NEAR + ROUNDING

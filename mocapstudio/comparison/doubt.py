"""How far an alignment can be trusted, said in words."""

from __future__ import annotations

from mocapstudio.similarity.alignment.costs import Costs
from mocapstudio.similarity.alignment.dtw import Alignment


def doubts(
    costs: Costs, alignment: Alignment, reference_seconds: float, source_seconds: float
) -> tuple[str, ...]:
    """Say what makes an alignment doubtful."""
    return ()

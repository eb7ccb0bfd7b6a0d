"""What a clean-up of contacts changed, as proposals that a sitting can take as edits."""

from __future__ import annotations

from collections.abc import Iterable

from mocapstudio.cleaning.model import Proposal
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION, ROOT_ROWS, carrier
from mocapstudio.motion.take import Take

METHOD = "contacts"
"""Method of proposals that hold contacts."""


def as_proposals(cleaned: Take, declared: Iterable[Declared]) -> tuple[Proposal, ...]:
    """Put the samples of a cleaned take into proposals, one for each different span.

    Parameters
    ----------
    cleaned
        The take after the clean-up.
    declared
        Rows × spans that it changed: joints, and the root's position.

    Returns
    -------
    tuple of Proposal
        In order of their start; nothing beyond what was declared.
    """
    rows: dict[tuple[int, int], list[str]] = {}
    for one in declared:
        rows.setdefault((one.start, one.end), []).append(one.row)
    found = []
    for (start, end), names in sorted(rows.items()):
        joints = tuple(name for name in names if name not in ROOT_ROWS)
        columns = [cleaned.skeleton.index[name] for name in joints]
        moved = cleaned.translations[start:end, carrier(cleaned)]
        found.append(
            Proposal(
                joints,
                start,
                end,
                cleaned.rotations[start:end, columns].copy(),
                moved.copy() if ROOT_POSITION in names else None,
                METHOD,
            )
        )
    return tuple(found)

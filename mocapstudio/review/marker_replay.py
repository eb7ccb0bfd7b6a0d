"""The edits of a marker take replayed over its immutable source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.marker_model import MarkerEdit, MarkerEditKind
from mocapstudio.review.rows import union

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def replay_markers(take: MarkerTake, edits: Iterable[MarkerEdit]) -> MarkerTake:
    """Do unmuted edits of a marker take in order.

    Parameters
    ----------
    take
        The source; never written to.
    edits
        Edits of this take's performer.

    Returns
    -------
    MarkerTake
        `take` itself where no edit is in force. Samples that no edit covers are bit for bit those
        of the source; what was filled is marked so, also where an exchange carried it elsewhere.
    """
    in_force = [edit for edit in edits if not edit.muted]
    if not in_force:
        return take
    positions = take.positions.copy()
    filled = np.zeros(positions.shape[:2], dtype=bool)
    if take.filled is not None:
        filled[:] = take.filled
    for edit in in_force:
        at = np.array([take.index[label] for label in edit.markers])
        _DO[edit.kind](edit, positions[edit.start : edit.end], filled[edit.start : edit.end], at)
    positions.setflags(write=False)
    filled.setflags(write=False)
    known = take.filled is not None or filled.any()
    return replace(take, positions=positions, filled=filled if known else None)


def marker_declared(edits: Iterable[MarkerEdit]) -> tuple[Declared, ...]:
    """Markers × spans that unmuted edits may change, joined where they touch."""
    return union(
        Declared(marker, edit.start, edit.end)
        for edit in edits
        if not edit.muted
        for marker in edit.markers
    )


def _fill(edit: MarkerEdit, positions: Array, filled: Mask, at: NDArray[np.intp]) -> None:
    assert edit.positions is not None
    missing: Mask = np.asarray(np.isnan(positions[:, at]).any(axis=2))
    positions[:, at] = np.where(missing[..., None], edit.positions, positions[:, at])
    filled[:, at] |= missing & ~np.isnan(edit.positions).any(axis=2)


def _exchange(edit: MarkerEdit, positions: Array, filled: Mask, at: NDArray[np.intp]) -> None:
    positions[:, at] = positions[:, np.flip(at)]
    filled[:, at] = filled[:, np.flip(at)]


def _clear(edit: MarkerEdit, positions: Array, filled: Mask, at: NDArray[np.intp]) -> None:
    positions[:, at] = np.nan
    filled[:, at] = False


_DO = {
    MarkerEditKind.FILL: _fill,
    MarkerEditKind.EXCHANGE: _exchange,
    MarkerEditKind.CLEAR: _clear,
}

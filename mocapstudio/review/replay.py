"""The edit list replayed over the immutable source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import carrier
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Edit
from mocapstudio.review.remembered import Remembered
from mocapstudio.review.rows import union


def replay(take: Take, edits: Iterable[Edit]) -> Take:
    """Put the samples of unmuted edits over a take, in order: later ones win where they overlap.

    Parameters
    ----------
    take
        The source; never written to.
    edits
        Edits of this take's performer.

    Returns
    -------
    Take
        `take` itself where no edit is in force. Samples that no edit covers are bit for bit those
        of the source.
    """
    in_force = [edit for edit in edits if not edit.muted]
    if not in_force:
        return take
    rotations = take.rotations.copy()
    moves = any(edit.translations is not None for edit in in_force)
    translations = take.translations.copy() if moves else take.translations
    for edit in in_force:
        span = slice(edit.start, edit.end)
        joints = [take.skeleton.index[name] for name in edit.joints]
        rotations[span, joints] = edit.rotations
        if edit.translations is not None:
            translations[span, carrier(take)] = edit.translations
    rotations.setflags(write=False)
    if moves:
        translations.setflags(write=False)
    return take.with_motion(rotations, translations)


def declared(edits: Iterable[Edit]) -> tuple[Declared, ...]:
    """Rows × spans that unmuted edits may change, joined where they touch."""
    return union(
        Declared(row, edit.start, edit.end) for edit in edits if not edit.muted for row in edit.rows
    )


class Results:
    """Results of replay with their trims, one remembered for each performer."""

    def __init__(self) -> None:
        self._replayed: Remembered[Take, Edit] = Remembered(replay)
        self._trimmed: dict[str, tuple[Take, Take]] = {}

    def of(
        self, performer: str, take: Take, edits: Iterable[Edit], trim: tuple[int, int] | None
    ) -> Take:
        """Return the replayed take with its trim; the same object while nothing changes."""
        whole = self._replayed.of(performer, take, edits)
        known, result = self._trimmed.get(performer, (None, whole))
        if known is not whole or result.trim != trim:
            result = whole if whole.trim == trim else replace(whole, trim=trim)
            self._trimmed[performer] = whole, result
        return result

    def forget(self, performer: str) -> None:
        """Let go of one performer's result."""
        self._replayed.forget(performer)
        self._trimmed.pop(performer, None)

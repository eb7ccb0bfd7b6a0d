"""A performance as it arrives: frames with times, some repeated, late or missing (paper 3).

What the desk's live mode and `mocapstudio align` show: where in the reference the performer is,
how early or late, and in which segment.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mocapstudio.comparison.online import AlignmentStep, OnlineAligner
from mocapstudio.comparison.online_begin import ActionFollower, FollowerState, Following
from mocapstudio.comparison.online_features import F32, Recording, unit_rows

BRIDGED_SECONDS = 0.5
"""Longest time without frames over which poses are interpolated."""

_NEW_CLOCK_SECONDS = 1.0
_SAME_TIME = 1e-6
_GAP = 1.5


class Note(StrEnum):
    """What was odd about a frame."""

    REPEATED = "repeated"
    """Its time is that of the frame before: it changes nothing."""
    LATE = "late"
    """Its time lies before that of the frame before: it changes nothing."""
    UNSEEN = "unseen"
    """Too few of its joints were there: it changes nothing."""
    BRIDGED = "bridged"
    """Frames were missing before it, and were interpolated."""
    GAP = "gap"
    """So many frames were missing before it that none were made up; she may have gone on."""
    RESTARTED = "restarted"
    """The stream's clock was set back: the alignment begins anew with this frame."""


@dataclass(frozen=True)
class LiveState:
    """What is shown after a frame.

    Parameters
    ----------
    frame
        Of the stream, counted from 0, every one that arrived.
    step
        Where in the reference the performer is; None before an action has begun, and where the
        frame could not be used.
    following
        Whether an action is under way.
    action
        How many have begun.
    began
        Frame of the stream at which the latest began, or None.
    note
        What was odd about the frame, or None.
    """

    frame: int
    step: AlignmentStep | None
    following: Following
    action: int
    began: int | None
    note: Note | None = None


class LiveAlignment:
    """Aligns a stream whose frames come with times, or without.

    Parameters
    ----------
    aligner
        Fed here.
    wait
        Whether to wait for the action to begin, and for the next after its end; otherwise the
        first frame is the action's first.
    """

    def __init__(self, aligner: OnlineAligner, *, wait: bool = False) -> None:
        self.aligner = aligner
        self._follower = ActionFollower(aligner) if wait else None
        self._frame = -1
        self.restart()

    def restart(self) -> None:
        """Forget the action: the next frame is the first of another, or is waited for."""
        self._time: float | None = None
        self._pose: F32 | None = None
        self._known = FollowerState(Following.WAITING, 0, None, None)
        self.aligner.restart()
        if self._follower is not None:
            self._follower.restart()

    def feed(self, pose: F32, time: float | None = None) -> LiveState:
        """Take the next frame.

        Parameters
        ----------
        pose
            (D, 4) as `Features.of` gives it; NaN where a row is missing.
        time
            Seconds; frames that do not advance it change nothing.
        """
        self._frame += 1
        note = self._out_of_order(time)
        if note is Note.RESTARTED:
            self.restart()
        elif note is not None:
            return self._state(self._known.step, note)
        if np.isnan(pose).any(axis=1).all():
            return self._state(None, Note.UNSEEN)
        note = note or self._bridge(pose, time)
        self._known = self._passed_on(pose, time)
        self._time, self._pose = time, pose
        unseen = self._known.step is None and self._known.following is Following.FOLLOWING
        return self._state(self._known.step, Note.UNSEEN if unseen else note)

    def _state(self, step: AlignmentStep | None, note: Note | None) -> LiveState:
        known = self._known
        return LiveState(self._frame, step, known.following, known.action, known.began, note)

    def _passed_on(self, pose: F32, time: float | None) -> FollowerState:
        if self._follower is not None:
            return self._follower.feed(pose, time, self._frame)
        step = self.aligner.feed(pose, time)
        before = self._known
        began = self._frame if before.began is None else before.began
        return FollowerState(Following.FOLLOWING, 1, began, step)

    def _out_of_order(self, time: float | None) -> Note | None:
        if time is None or self._time is None:
            return None
        if abs(time - self._time) <= _SAME_TIME:
            return Note.REPEATED
        if time > self._time:
            return None
        return Note.LATE if self._time - time < _NEW_CLOCK_SECONDS else Note.RESTARTED

    def _bridge(self, pose: F32, time: float | None) -> Note | None:
        """Pass on what lies between the frame before and this one, where frames are missing."""
        if time is None or self._time is None or self._pose is None:
            return None
        step = 1.0 / self.aligner.reference.rate
        gap = time - self._time
        if gap <= _GAP * step:
            return None
        missing = round(gap / step) - 1
        if gap > BRIDGED_SECONDS:
            self.aligner.pass_over(missing)
            return Note.GAP
        before = self._pose
        flipped = np.sum(before * pose, axis=-1, keepdims=True) < 0
        after = (
            pose if self.aligner.reference.features.directions else np.where(flipped, -pose, pose)
        )
        for i in range(1, missing + 1):
            part = np.float32(i / (missing + 1))
            self._passed_on(unit_rows(before * (1 - part) + after * part), self._time + i * step)
        return Note.BRIDGED if missing else None


def played(live: LiveAlignment, take: Recording, every: int = 1) -> Iterator[LiveState]:
    """Feed a take's trimmed span as if it arrived now, a state for every n-th frame.

    Raises
    ------
    SkeletonMismatchError
        If the take lacks what is compared.
    """
    poses = live.aligner.reference.features.of(take)
    for i in range(0, len(poses), every):
        yield live.feed(poses[i], take.seconds(i))

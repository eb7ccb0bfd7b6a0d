"""One live alignment under way: takes frames in as they are due, and keeps what came of them.

No Qt.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator
from typing import Any

from mocapstudio.comparison.live import LiveAlignment, LiveState, Note
from mocapstudio.comparison.live_history import LiveHistory
from mocapstudio.comparison.live_setup import live_alignment
from mocapstudio.comparison.online_features import JointRotations
from mocapstudio.comparison.weights import JointWeights
from mocapstudio.motion.errors import FileError, SkeletonMismatchError
from mocapstudio.motion.progress import Progress
from mocapstudio.review.comparing import Recording
from mocapstudio.review.live_feeds import Arrived, Feed, StreamFeed, TakeFeed

PATH_FRAMES = 4096
"""Over how many frames the path can be drawn; of a longer action, the latest."""

_LONGEST_STEP = 0.1


class Intake:
    """Feeds one alignment from one feed.

    Parameters
    ----------
    live
        The alignment.
    feed
        Where frames come from.
    """

    def __init__(self, live: LiveAlignment, feed: Feed) -> None:
        self.live, self.feed = live, feed
        self.history = LiveHistory(len(live.aligner.reference))
        self._played = 0.0
        self._begin()

    def _begin(self) -> None:
        self._notes: Counter[Note] = Counter()
        self._frames = self._faults = self._action = 0
        self.frame: int | None = None

    def restart(self) -> None:
        """Forget the action; a take is played from its beginning."""
        self.live.restart()
        self.history.clear()
        if isinstance(self.feed, TakeFeed):
            self.feed.rewind()
            self._played = 0.0
        self._begin()

    def pass_time(self, seconds: float, speed: float) -> None:
        """Let time pass; a take may be played slower, and waits where the desk could not look."""
        if self.feed.slips:
            self._played += min(seconds, _LONGEST_STEP) * speed
        else:
            self._played += seconds

    def take_in(self, enough: Callable[[], bool]) -> tuple[dict[str, Any], Arrived | None]:
        """Align frames until none is due, or it is enough for now.

        Returns
        -------
        What has changed, by the fields of `LiveShown`, and the latest frame.

        Raises
        ------
        MocapError
            If what arrives cannot be aligned.
        """
        changes: dict[str, Any] = {}
        latest: Arrived | None = None
        while (one := self.feed.due(self._played)) is not None:
            if isinstance(one, FileError):
                self._faults += 1
                changes |= {"faults": self._faults, "fault": f"line {one.line}: {one.cause}"}
            else:
                self._frames += 1
                latest = one
                changes |= self._aligned(self.live.feed(one.pose, one.time))
            if enough():
                if self.feed.slips and latest is not None and latest.time is not None:
                    self._played = min(self._played, latest.time + 1e-6)
                break
        if latest is not None:
            self.frame = latest.frame
            changes |= {"frames": self._frames, "notes": self._noted()}
            if latest.time is not None:
                changes["seconds"] = latest.time
        return changes, latest

    def frames_at(self, seconds: float, now: LiveState) -> tuple[int, int, float] | None:
        """Reference and source frame so many seconds into the action, and those seconds, kept.

        None where no take is played, or no action has begun.
        """
        if self.frame is None or now.began is None or not self.history.frames:
            return None
        reference = self.live.aligner.reference
        at = min(max(round(seconds * reference.rate), 0), self.history.frames - 1)
        matched = int(self.history.course.at[at // self.history.stride])
        begin = self.frame - (now.frame - now.began)
        return reference.own_frame(matched), begin + at, at / reference.rate

    def _aligned(self, state: LiveState) -> dict[str, Any]:
        if state.note is not None:
            self._notes[state.note] += 1
        anew = state.note is Note.RESTARTED or state.action != self._action
        self._action = state.action
        if anew:
            self.history.clear()
        changes: dict[str, Any] = {"now": state}
        if state.step is not None:
            self.history.add(state.step, self.live.aligner.pose_costs)
            changes["step"] = state.step
        elif anew:
            changes["step"] = None
        return changes

    def _noted(self) -> tuple[tuple[Note, int], ...]:
        return tuple((note, self._notes[note]) for note in Note if self._notes[note])


def preparing(
    reference: Recording,
    source: Recording | StreamFeed,
    weights: JointWeights | None,
    *,
    rate: float | None,
    wait: bool,
) -> Generator[Progress, None, Intake]:
    """Make the alignment, and run it once so that nothing is compiled while frames arrive."""
    yield Progress(0.0, "preparing the live alignment")
    takes = () if isinstance(source, StreamFeed) else (source,)
    live = live_alignment(reference, takes, rate, weights, wait=wait, path_frames=PATH_FRAMES)
    aligner = live.aligner
    features = aligner.reference.features
    feed: Feed
    if isinstance(source, StreamFeed):
        if not isinstance(features, JointRotations):
            raise SkeletonMismatchError("the stream sends joints, the reference holds markers")
        source.settle(features)
        feed = source
    else:
        feed = TakeFeed(source, features)
    yield Progress(0.7, "preparing the live alignment")
    aligner.feed(features.of(reference)[0], 0.0)
    aligner.path()
    live.restart()
    return Intake(live, feed)
